// SPDX-License-Identifier: MIT
// Chooses the peer to evict when an endpoint has as many as it may. Private to module link.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

// A peer that was heard at least twice, the last time within this period, is not evicted. A flood of unknown senders
// thus cannot displace peers that send heartbeats (1 Hz).
inline constexpr std::chrono::seconds protected_for{2};

// The peer to evict: the longest idle of those heard once, else the longest idle of the rest. Returns the end
// iterator if that peer is protected.
template <class Peer>
[[nodiscard]] auto gives_way(const std::vector<std::unique_ptr<Peer>>& peers, MonoTime now) {
    const auto rank = [](const std::unique_ptr<Peer>& peer) { return std::pair(peer->datagrams > 1, peer->last_heard); };
    const auto first = std::min_element(peers.begin(), peers.end(),
                                        [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    const bool is_protected = first != peers.end() && (*first)->datagrams > 1 &&
                              now - (*first)->last_heard < protected_for;
    return is_protected ? peers.end() : first;
}

}  // namespace mavloom::link::detail
