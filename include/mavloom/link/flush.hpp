// SPDX-License-Identifier: MIT
// Sends the frames that are still queued before a program closes its links.
#pragma once

#include <algorithm>

#include "mavloom/base/clock.hpp"
#include "mavloom/link/links.hpp"

namespace mavloom::link {

// Runs turns until nothing is queued, for at most `longest`. One more turn then collects the errors of the last
// datagrams. Frames that arrive meanwhile go to `handler` as usual.
inline void flush(Links& links, LinkHandler& handler, Nanoseconds longest) {
    constexpr Nanoseconds look_again = std::chrono::milliseconds{5};
    const MonoTime end = mono_now() + longest;
    while (links.pending() && mono_now() < end) links.turn(handler, std::min(end, mono_now() + look_again));
    links.turn(handler, MonoTime{});
}

}  // namespace mavloom::link
