// SPDX-License-Identifier: MIT
// Converts a pilot's sticks to set-points. Private to flight; single owner; nothing allocates. The limits are PX4's
// defaults (MPC_MAN_TILT_MAX, MPC_VEL_MANUAL, MC_ACRO_R_MAX and related parameters).
#pragma once

#include "flight/context.hpp"
#include "flight/mode.hpp"

namespace mavloom::flight {

class ManualControl {
public:
    explicit ManualControl(const FlightContext& context) noexcept : context_(context) {}

    // Call it when the pilot takes over.
    void begin() noexcept { yaw_ = context_.craft.estimate().euler.yaw; }
    // Call it 50 times a second.
    [[nodiscard]] Setpoint steer(Behaviour behaviour, const Sticks& sticks);

private:
    [[nodiscard]] Setpoint steer_quad(Behaviour behaviour, const Sticks& sticks);
    [[nodiscard]] Setpoint steer_plane(Behaviour behaviour, const Sticks& sticks) const;
    [[nodiscard]] Setpoint steer_rover(Behaviour behaviour, const Sticks& sticks) const;
    [[nodiscard]] SpeedLimits limits() const noexcept;

    const FlightContext& context_;
    double yaw_ = 0;
};

}  // namespace mavloom::flight
