// SPDX-License-Identifier: MIT
// Chooses which silent peer makes room for a newcomer when max_peers is reached. Private to module link.
//
// A peer that has talked (see its has_talked) and was heard within the last 2 s stays. So a flood of unknown senders
// does not evict peers that send heartbeats (1 Hz). If there are many peers, those of the older half may be silent for
// 10 s. A crowd that arrives later then does not evict a program that loses some heartbeats.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"

namespace mavloom::link::detail {

constexpr std::chrono::seconds peer_stays_for{2}, older_peer_stays_for{10};
constexpr std::size_t many_peers = 16;

// The older half of the peers has smaller ids than this. With few peers, none has.
template <class Peer>
[[nodiscard]] LinkId middle_id(std::vector<Peer*> peers) {
    if (peers.size() < many_peers) return {};
    const auto middle = peers.begin() + static_cast<std::ptrdiff_t>(peers.size() / 2);
    std::ranges::nth_element(peers, middle, {}, &Peer::id);
    return (*middle)->id;
}

// Returns the longest silent of the peers that have not talked yet. If all have talked, returns the longest silent of
// those that may be evicted; null if there is none. Requires a `Peer` with `id`, `has_talked` and `silent_since`.
// Allocates.
template <class Peer>
[[nodiscard]] Peer* to_evict(const std::vector<Peer*>& peers, MonoTime now) {
    const auto rank = [](const Peer* peer) { return std::pair(peer->has_talked(), peer->silent_since()); };
    const LinkId middle = middle_id(peers);
    Peer* found = nullptr;
    for (Peer* const peer : peers) {
        const auto stays_for = peer->id < middle ? older_peer_stays_for : peer_stays_for;
        if (peer->has_talked() && now - peer->silent_since() < stays_for) continue;
        if (found == nullptr || rank(peer) < rank(found)) found = peer;
    }
    return found;
}

}  // namespace mavloom::link::detail
