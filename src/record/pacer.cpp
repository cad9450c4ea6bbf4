// SPDX-License-Identifier: MIT
#include "mavloom/record/pacer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace mavloom::record {

Pacer::Pacer(double speed, MonoTime start, Limits limits) noexcept
    : speed_(speed), limits_(limits), anchor_due_(start), last_due_(start) {
    assert(speed > 0);
}

MonoTime Pacer::due(WallTime recorded) noexcept {
    const auto step = recorded - last_recorded_;
    const bool jump = started_ && (step > limits_.longest_gap || step < -limits_.longest_step_back);
    if (!started_ || jump) {
        anchor_due_ = last_due_;
        anchor_recorded_ = recorded;
        jumps_ += jump ? 1 : 0;
        started_ = true;
    }
    last_recorded_ = recorded;
    const auto elapsed = static_cast<double>((recorded - anchor_recorded_).count());
    // At a very low speed, the due time could exceed the range of the clock.
    constexpr double ten_years_ns = 3653 * 86400e9;
    const auto wait = std::min(elapsed / speed_, ten_years_ns);
    last_due_ = std::max(last_due_, anchor_due_ + Nanoseconds{std::llround(std::max(wait, 0.0))});
    return last_due_;
}

}  // namespace mavloom::record
