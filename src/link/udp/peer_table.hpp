// SPDX-License-Identifier: MIT
// Finds a socket's peer by its address: a hash table with open addressing. It also remembers the last peer found,
// because datagrams arrive in runs. Look-ups do not allocate. Private to module link; single owner thread.
#pragma once

#include <cassert>
#include <cstddef>
#include <vector>

#include "mavloom/net/address.hpp"

namespace mavloom::link::detail {

template <class Peer>
class PeerTable {
public:
    PeerTable() : slots_(16) {}

    [[nodiscard]] Peer* find(const net::Address& address) noexcept {
        if (last_.peer != nullptr && last_.address == address) [[likely]]
            return last_.peer;
        const Slot& slot = slots_[place_of(address)];
        if (slot.peer != nullptr) last_ = slot;
        return slot.peer;
    }

    // The address must not be in the table yet.
    void add(const net::Address& address, Peer& peer) {
        if ((size_ + 1) * 2 > slots_.size()) grow();
        Slot& slot = slots_[place_of(address)];
        assert(slot.peer == nullptr);
        slot = {address, &peer};
        ++size_;
    }

    // Closes the gap, so that probing from an address's home slot still finds the address.
    void remove(const net::Address& address) noexcept {
        std::size_t gap = place_of(address);
        if (slots_[gap].peer == nullptr) return;
        assert(size_ > 0);
        last_ = {};
        --size_;
        slots_[gap].peer = nullptr;
        for (std::size_t i = next(gap); slots_[i].peer != nullptr; i = next(i)) {
            const std::size_t home = slots_[i].address.hash() & (slots_.size() - 1);
            const bool home_in_between = gap <= i ? gap < home && home <= i : gap < home || home <= i;
            if (home_in_between) continue;
            slots_[gap] = slots_[i];
            slots_[i].peer = nullptr;
            gap = i;
        }
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }

private:
    struct Slot {
        net::Address address;
        Peer* peer = nullptr;
    };

    [[nodiscard]] std::size_t next(std::size_t i) const noexcept { return (i + 1) & (slots_.size() - 1); }

    // The slot that holds the address, or that it would go to.
    [[nodiscard]] std::size_t place_of(const net::Address& address) const noexcept {
        std::size_t i = address.hash() & (slots_.size() - 1);
        while (slots_[i].peer != nullptr && !(slots_[i].address == address)) i = next(i);
        return i;
    }

    void grow() {
        std::vector<Slot> old(slots_.size() * 2);
        old.swap(slots_);
        for (const Slot& slot : old)
            if (slot.peer != nullptr) slots_[place_of(slot.address)] = slot;
    }

    std::vector<Slot> slots_;  // size: a power of two; at most half used
    std::size_t size_ = 0;
    Slot last_;
};

}  // namespace mavloom::link::detail
