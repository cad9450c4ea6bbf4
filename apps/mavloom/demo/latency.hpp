// SPDX-License-Identifier: MIT
// The time that frames take from one place to another, where two threads hear the same frames. Any thread may call all
// functions. Times are those at which the kernel received the frames.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <unordered_map>

#include "mavloom/base/clock.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::app::demo_parts {

struct LatencyFigures {
    Nanoseconds median{}, p99{}, most{};
};

class Latency {
public:
    // The frame was at the first place, or at the second, at this time.
    void note_first(const wire::FrameView& frame, WallTime time) { note(frame, time, true); }
    void note_second(const wire::FrameView& frame, WallTime time) { note(frame, time, false); }

    // Of the last 1,000 frames that were at both places.
    [[nodiscard]] std::optional<LatencyFigures> figures() const;

private:
    static constexpr std::size_t kept = 1000, max_open = 4096;

    void note(const wire::FrameView& frame, WallTime time, bool is_first);

    struct Heard {
        WallTime time;
        bool is_first;
    };
    mutable std::mutex mutex_;
    std::unordered_map<std::size_t, Heard> open_;  // by the hash of the bytes: frames that were at one place so far
    std::deque<Nanoseconds> times_;
};

}  // namespace mavloom::app::demo_parts
