// SPDX-License-Identifier: MIT
// Divides a service's places for clients among the links. A client can invent any number of ids. If it takes all
// places, it keeps out only the clients of its own link. Private to module sim.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "mavloom/base/ids.hpp"

namespace mavloom::sim {

// Returns true if there is a place for one more client of `link`. `taken` holds at most `most`, the oldest first. If it
// is full, the link that has most of them loses its oldest one, unless `link` would get as many as that link has now.
template <class Taken>
[[nodiscard]] bool make_room(std::vector<Taken>& taken, LinkId link, std::size_t most) {
    if (taken.size() < most) return true;
    const auto link_of = [](const Taken& one) { return one.client.link; };
    const auto count = [&](LinkId of) { return std::ranges::count(taken, of, link_of); };
    const auto first = std::ranges::max_element(taken, {}, [&](const Taken& one) { return count(link_of(one)); });
    if (first == taken.end() || count(link) + 1 >= count(link_of(*first))) return false;
    taken.erase(first);
    return true;
}

}  // namespace mavloom::sim
