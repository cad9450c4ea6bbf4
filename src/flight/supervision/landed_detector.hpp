// SPDX-License-Identifier: MIT
// Detects take-off and landing, and keeps FlightContext::landed. Private to flight; single owner.
#pragma once

#include "flight/context.hpp"

namespace mavloom::flight {

class LandedDetector {
public:
    explicit LandedDetector(FlightContext& context) noexcept : context_(context) {}

    // The navigator's current manoeuvre.
    struct Phase {
        bool climbs = false, lands = false;
        bool is_home = false;  // a rover has arrived
    };
    // Call it 50 times a second.
    void update(const Phase& phase);
    void reset() noexcept;

    [[nodiscard]] FlightTime took_off_at() const noexcept { return took_off_at_; }
    // Seconds on the ground since the last landing, or since boot.
    [[nodiscard]] double seconds_landed() const noexcept { return context_.seconds_since(landed_at_); }

private:
    [[nodiscard]] bool is_airborne(const Phase& phase);
    void take_off();
    void touch_down();

    FlightContext& context_;
    FlightTime took_off_at_{}, landed_at_{}, resting_since_{};
};

}  // namespace mavloom::flight
