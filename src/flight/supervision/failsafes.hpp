// SPDX-License-Identifier: MIT
// Watches battery, links, position and fence. If one of them fails, makes the Commander act. Private to flight; single
// owner. Source: PX4 user guide, "Safety Configuration (Failsafes)".
#pragma once

#include "flight/supervision/commander.hpp"
#include "flight/supervision/fence.hpp"

namespace mavloom::flight {

class Failsafes {
public:
    Failsafes(const FlightContext& context, const Inputs& inputs, const Fence& fence, Commander& commander) noexcept
        : context_(context), inputs_(inputs), fence_(fence), commander_(commander) {}

    // Call it 50 times a second.
    void update();
    void reset() noexcept { state_ = {}; }

private:
    enum class BatteryLevel : std::uint8_t { good, low, critical, emergency };
    // The findings of the last update.
    struct State {
        BatteryLevel battery = BatteryLevel::good;
        bool lacks_ground_station = false, lacks_setpoints = false, lacks_sticks = false, lacks_position = false;
        unsigned breaches = 0, updates = 0;
    };

    [[nodiscard]] BatteryLevel battery_level() const noexcept;
    void watch_battery();
    void announce(BatteryLevel level) const;
    void watch_ground_station();
    void watch_setpoints();
    void watch_sticks();
    void watch_position();
    void watch_fence();
    // Acts when the reason appears, and lets the vehicle continue when the reason is gone.
    void judge(bool& was_present, bool is_present, FailsafeAction action, std::string_view text);
    [[nodiscard]] bool is_px4() const noexcept { return context_.firmware.is_px4(); }

    const FlightContext& context_;
    const Inputs& inputs_;
    const Fence& fence_;
    Commander& commander_;
    State state_;
};

}  // namespace mavloom::flight
