// SPDX-License-Identifier: MIT
// Computes when each record of a replay is due. Deadlines are absolute, from one common start, so delays do not
// accumulate. A Pacer never waits, reads no clock and does not allocate. One owner thread.
#pragma once

#include <cstdint>
#include <limits>

#include "mavloom/base/clock.hpp"

namespace mavloom::record {

class Pacer {
public:
    static constexpr double max_speed = std::numeric_limits<double>::infinity();  // no waiting

    struct Limits {
        // A longer gap between records counts as a jump: the clock was changed, or the outage is not worth replaying.
        Nanoseconds longest_gap = std::chrono::seconds{60};
        // A longer step back in time counts as a jump; a shorter one means that records are out of order.
        Nanoseconds longest_step_back = std::chrono::seconds{1};
    };

    // The first record is due at `start`. `speed` must be above 0; 2 replays twice as fast as recorded.
    Pacer(double speed, MonoTime start) noexcept : Pacer(speed, start, Limits{}) {}
    Pacer(double speed, MonoTime start, Limits limits) noexcept;

    // Returns when the record with this time is due, which is never before the previous result. After a jump (see
    // Limits) the record is due together with the previous one, and later records are paced from there.
    [[nodiscard]] MonoTime due(WallTime recorded) noexcept;

    [[nodiscard]] bool waits() const noexcept { return speed_ != max_speed; }
    [[nodiscard]] std::uint64_t jumps() const noexcept { return jumps_; }

private:
    double speed_;
    Limits limits_;
    MonoTime anchor_due_, last_due_;
    WallTime anchor_recorded_{}, last_recorded_{};
    bool started_ = false;
    std::uint64_t jumps_ = 0;
};

}  // namespace mavloom::record
