// SPDX-License-Identifier: MIT
// Of signed frames that come by several links of a group: which are late, and which are replays. A late one is taken if its time is newer than the
// newest that any link had brought `least` to `oldest` ago; so it was not taken before that, and a copy of it is still known by its bytes
// (the router sees to that: Links::longest_late; as far as a flood of other frames leaves room there, which the router's `recent_evicted` tells). Judged by arrival: the clocks
// of signers need not run with ours. Private to module link; one owner thread; allocates for a new sender only.
#pragma once

#include <chrono>
#include <cstdint>
#include <unordered_map>

#include "mavloom/base/clock.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::link::detail {

class LateFrames {
public:
    static constexpr Nanoseconds least = std::chrono::milliseconds{600}, most = 2 * least, oldest = most + least;
    static_assert(oldest <= link::Links::longest_late);

    // Whether a sender's frame of `time` is too late at `now`, when its newest before this frame was of `newest`. To be asked of every frame.
    [[nodiscard]] bool is_too_late(std::uint32_t sender, wire::SigningTime time, wire::SigningTime newest, MonoTime now) {
        auto [at, is_new] = marks_.try_emplace(sender, Marks{newest, newest, now});
        Marks& marks = at->second;
        if (now - marks.since >= most) marks = {newest, newest, now};
        else if (now - marks.since >= least) marks = {marks.recent, newest, now};
        return time <= marks.old;
    }

private:
    // The newest time at two moments, `recent` at `since` and `old` `least` to `most` before.
    struct Marks {
        wire::SigningTime old, recent;
        MonoTime since;
    };
    std::unordered_map<std::uint32_t, Marks> marks_;
};

}  // namespace mavloom::link::detail
