// SPDX-License-Identifier: MIT
// Detects that a vehicle hit the ground so fast, or so tilted, that it breaks. Private to flight; single owner.
#pragma once

#include "flight/plant/plant.hpp"

namespace mavloom::flight {

class CrashDetector {
public:
    // PX4's parameters let a vehicle descend at up to 4 m/s and ArduPilot's at up to 5, and its controller commands up
    // to 1.2 times as much.
    static constexpr double hardest_landing = 8;  // m/s downwards
    static constexpr double least_upright = 0.5;  // tilted by 60 degrees, as PX4's FD_FAIL_R and FD_FAIL_P

    // Call it 50 times a second. Returns true if the vehicle crashed since the last call.
    [[nodiscard]] bool update(const Plant& plant) {
        const bool hits = plant.touches_ground() && !touched_;
        const bool has_crashed = hits && (sinking_ > hardest_landing || upright_ < least_upright);
        touched_ = plant.touches_ground();
        sinking_ = plant.motion().velocity.z();
        upright_ = (plant.motion().attitude * Vector3::UnitZ()).z();
        return has_crashed;
    }

private:
    double sinking_ = 0, upright_ = 1;  // before it touched the ground: m/s; the cosine of the tilt
    bool touched_ = true;
};

}  // namespace mavloom::flight
