// SPDX-License-Identifier: MIT
// Chooses which peer to evict when max_peers is reached, all peers are active, and another sender waits. Without this,
// an attacker that first takes all places with invented addresses would keep every other sender out.
//
// The older half of the peers is never evicted, so peers that were there before a crowd keep their places. Of the
// younger half, a random peer is evicted. A vehicle that arrives late among hundreds of other senders therefore soon
// gets a place, and usually keeps it for minutes. If there are few peers, none is evicted. Private to module link;
// single owner thread.
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
    static constexpr std::chrono::seconds interval{2};  // on average, between two evictions
    static constexpr int burst = 4;

    explicit Displacement(std::uint32_t seed = std::random_device{}()) : random_(seed) {}

    // Returns null if no peer should be evicted now. Orders the peers by link id, and not by the time of their arrival,
    // because all peers that arrive in one turn have the same time. Allocates.
    template <class Peer>
    [[nodiscard]] Peer* choose(std::vector<Peer*> peers, MonoTime now) {
        if (peers.size() < many_peers || !pace_.take(now)) return nullptr;
        const LinkId middle = middle_id(peers);
        std::erase_if(peers, [&](const Peer* peer) { return peer->id < middle; });
        return peers[random_() % peers.size()];
    }

private:
    std::minstd_rand random_;
    Pace pace_{interval, burst};
};

}  // namespace mavloom::link::detail
