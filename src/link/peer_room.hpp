// SPDX-License-Identifier: MIT
// Which peer gives way where there are as many as there may be. Private to module link.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

// A peer that was heard more than once and was heard this lately does not give way to a newcomer: a flood of strangers cannot push out
// those who send heartbeats (1 Hz).
inline constexpr std::chrono::seconds protected_for{2};

// The longest idle goes first: of those heard once, else of all that are not protected. The end: nobody.
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
