// SPDX-License-Identifier: MIT
// Chooses which peer to evict when max_peers is reached, all peers talk, and another sender waits. Without this, an
// attacker that comes first with many addresses keeps all others out.
//
// The older half never leaves, so peers that were there before a crowd keep their places. Of the younger half, a random
// peer leaves. So a late vehicle among hundreds of others soon has a place, and mostly keeps it for minutes. With few
// peers nobody leaves. Private to module link; single owner thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <random>
#include <vector>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

class Displacement {
public:
    static constexpr std::size_t fewest_peers = 16;
    static constexpr std::chrono::seconds one_each{2};
    static constexpr int at_once = 4;

    explicit Displacement(std::uint32_t seed = std::random_device{}()) : random_(seed) {}

    // Returns null if no peer has to leave now. The link ids give the order in which the peers came. Times do not,
    // because all peers that come in one turn have the same time. Allocates.
    template <class Peer>
    [[nodiscard]] Peer* choose(std::vector<Peer*> peers, MonoTime now) {
        if (peers.size() < fewest_peers || !take_turn(now)) return nullptr;
        const auto middle = peers.begin() + static_cast<std::ptrdiff_t>(peers.size() / 2);
        std::ranges::nth_element(peers, middle, {}, &Peer::id);
        const auto younger = static_cast<std::size_t>(peers.end() - middle);
        return middle[static_cast<std::ptrdiff_t>(random_() % younger)];
    }

private:
    // One each 2 s, and up to four at once after a rest.
    [[nodiscard]] bool take_turn(MonoTime now) noexcept {
        next_ = std::max(next_, now - (at_once - 1) * one_each);
        if (now < next_) return false;
        next_ += one_each;
        return true;
    }

    std::minstd_rand random_;
    MonoTime next_{};
};

}  // namespace mavloom::link::detail
