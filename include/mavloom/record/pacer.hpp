// SPDX-License-Identifier: MIT
// When each record of a replay is due: absolute deadlines from one common start, so that delays never add up. Takes instants and gives
// instants; never waits and never asks for the time. One owner thread; allocates nothing.
#pragma once

#include <cstdint>
#include <limits>

#include "mavloom/base/clock.hpp"

namespace mavloom::record {

class Pacer {
public:
    static constexpr double max_speed = std::numeric_limits<double>::infinity();  // no waiting at all

    struct Limits {
        // A longer silence in the recording is a jump of its clock, or an outage nobody wants to sit through.
        Nanoseconds longest_gap = std::chrono::seconds{60};
        // A smaller step back is only records out of order.
        Nanoseconds longest_step_back = std::chrono::seconds{1};
    };

    // The first record is due at `start`. `speed` is above 0: 2 is twice as fast as recorded.
    Pacer(double speed, MonoTime start) noexcept : Pacer(speed, start, Limits{}) {}
    Pacer(double speed, MonoTime start, Limits limits) noexcept;

    // When the record with this time is due: never before the one asked for last. Behind a jump (see Limits) the next record is due at once, and
    // the pace goes on from there.
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
