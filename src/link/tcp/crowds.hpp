// SPDX-License-Identifier: MIT
// Counts the clients of a tcpin that have sent no good frame yet, by their addresses. When the endpoint is full, it
// closes a client of the address with the most of them. A program that connects again and again therefore keeps out
// only clients that share its address. An address cannot be forged, because a TCP connection needs answers. Private to
// module link; single owner thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::link::detail {

// `Peer` has a `host` (Address::host_part), `is_silent` and `silent_since`.
template <class Peer>
class Crowds {
public:
    struct Crowd {
        std::size_t size = 0;
        Peer* longest_silent = nullptr;
    };

    // The peers must outlive the object. Allocates.
    explicit Crowds(const std::vector<Peer*>& peers) {
        for (Peer* const peer : peers)
            if (peer->is_silent()) add(*peer);
    }

    // Returns the largest crowd; of several such, the one with the longest silent peer. Its size is 0 if no peer is
    // silent.
    [[nodiscard]] Crowd largest() const {
        Crowd found;
        for (const auto& [host, crowd] : crowds_)
            if (crowd.size > found.size || (crowd.size == found.size && is_longer_silent(crowd, found))) found = crowd;
        return found;
    }
    // Whether one more peer from `host` would still be in a smaller crowd than the largest.
    [[nodiscard]] bool has_room_for(const net::Address& host) const {
        const auto own = crowds_.find(host);
        return (own == crowds_.end() ? 0 : own->second.size) + 1 < largest().size;
    }

private:
    struct Hash {
        std::size_t operator()(const net::Address& address) const noexcept { return address.hash(); }
    };

    void add(Peer& peer) {
        Crowd& crowd = crowds_[peer.host];
        const Crowd alone{1, &peer};
        if (crowd.size++ == 0 || is_longer_silent(alone, crowd)) crowd.longest_silent = &peer;
    }
    [[nodiscard]] static bool is_longer_silent(const Crowd& one, const Crowd& other) {
        return one.longest_silent->silent_since() < other.longest_silent->silent_since();
    }

    std::unordered_map<net::Address, Crowd, Hash> crowds_;
};

}  // namespace mavloom::link::detail
