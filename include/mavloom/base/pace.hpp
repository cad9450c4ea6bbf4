// SPDX-License-Identifier: MIT
// Limits how often something happens: some times at once after a rest, then at a steady rate. Plain value; time is a
// parameter.
#pragma once

#include <algorithm>

#include "mavloom/base/clock.hpp"

namespace mavloom {

class Pace {
public:
    constexpr Pace(Nanoseconds one_each, int at_once) noexcept : one_each_(one_each), lead_((at_once - 1) * one_each) {}

    // Returns whether it may happen now. If so, counts it.
    [[nodiscard]] constexpr bool take(MonoTime now) noexcept {
        next_ = std::max(next_, now - lead_);
        if (now < next_) return false;
        next_ += one_each_;
        return true;
    }

private:
    Nanoseconds one_each_, lead_;
    MonoTime next_{};
};

}  // namespace mavloom
