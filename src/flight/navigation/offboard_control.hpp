// SPDX-License-Identifier: MIT
// Follows the set-points of an external controller: PX4's Offboard, ArduPilot's Guided. Private to flight; single
// owner; nothing allocates.
#pragma once

#include "flight/inputs.hpp"
#include "flight/navigation/guidance.hpp"

namespace mavloom::flight {

class OffboardControl {
public:
    OffboardControl(FlightContext& context, const Inputs& inputs, Guidance& guidance) noexcept
        : context_(context), inputs_(inputs), guidance_(guidance) {}

    void begin();
    // Call it 50 times a second.
    void update();

private:
    [[nodiscard]] Setpoint followed(const OffboardSetpoint& given) const;

    FlightContext& context_;
    const Inputs& inputs_;
    Guidance& guidance_;
    bool follows_ = false;
};

}  // namespace mavloom::flight
