// SPDX-License-Identifier: MIT
// Limits how often something may happen: a burst after a rest, then a steady rate. Plain value; time is a parameter.
#pragma once

#include <algorithm>

#include "mavloom/base/clock.hpp"

namespace mavloom {

class Pace {
public:
    // Allows one event per `interval`, and up to `burst` events at once after a rest.
    constexpr Pace(Nanoseconds interval, int burst) noexcept : interval_(interval), lead_((burst - 1) * interval) {}

    [[nodiscard]] constexpr bool allows(MonoTime now) const noexcept { return next_ <= now; }
    // Returns whether the event may happen now. If so, counts it.
    [[nodiscard]] constexpr bool take(MonoTime now) noexcept {
        if (!allows(now)) return false;
        next_ = std::max(next_, now - lead_) + interval_;
        return true;
    }

private:
    Nanoseconds interval_, lead_;
    MonoTime next_{};
};

}  // namespace mavloom
