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
#include <random>
#include <vector>

#include "link/eviction.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/pace.hpp"

namespace mavloom::link::detail {

class Displacement {
public:
    static constexpr std::chrono::seconds one_each{2};
    static constexpr int at_once = 4;

    explicit Displacement(std::uint32_t seed = std::random_device{}()) : random_(seed) {}

    // Returns null if no peer has to leave now. The link ids give the order in which the peers came. Times do not,
    // because all peers that come in one turn have the same time. Allocates.
    template <class Peer>
    [[nodiscard]] Peer* choose(std::vector<Peer*> peers, MonoTime now) {
        if (peers.size() < many_peers || !pace_.take(now)) return nullptr;
        const LinkId middle = middle_id(peers);
        std::erase_if(peers, [&](const Peer* peer) { return peer->id < middle; });
        return peers[random_() % peers.size()];
    }

private:
    std::minstd_rand random_;
    Pace pace_{one_each, at_once};
};

}  // namespace mavloom::link::detail
