// SPDX-License-Identifier: MIT
// Separates late frames from replays among signed frames that arrive over several links: those of a group, or all.
//
// For each sender, the class keeps a mark: the newest timestamp that these links had received at a moment between
// `least` and `oldest` ago. A frame with a newer timestamp than the mark is accepted. If such a frame is a replay, the
// original arrived after that moment. The router still remembers the original and so detects the replay by its bytes:
// it remembers frames for longer than Links::longest_late. Under a flood of other frames the router may forget frames
// early; its counter `recent_evicted` shows that.
//
// Only arrival times count, because signers' clocks need not match ours. Private to module link; single owner thread;
// allocates only for a new sender.
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

    // True if a frame with timestamp `time` is too late. `newest`: the sender's newest timestamp before this frame.
    // Call it for every frame.
    [[nodiscard]] bool is_too_late(std::uint32_t sender, wire::SigningTime time, wire::SigningTime newest, MonoTime now) {
        auto [at, is_new] = marks_.try_emplace(sender, Marks{newest, newest, now});
        Marks& marks = at->second;
        if (now - marks.since >= most) marks = {newest, newest, now};
        else if (now - marks.since >= least) marks = {marks.recent, newest, now};
        return time <= marks.old;
    }

private:
    // The newest timestamp at two moments: `recent` at the time `since`, and `old` at a time `least` to `most` before
    // it.
    struct Marks {
        wire::SigningTime old, recent;
        MonoTime since;
    };
    std::unordered_map<std::uint32_t, Marks> marks_;
};

}  // namespace mavloom::link::detail
