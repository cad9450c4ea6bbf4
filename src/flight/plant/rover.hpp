// SPDX-License-Identifier: MIT
// A car-like rover on flat ground. Private to flight; single owner; nothing allocates.
//
//   dv/dt = a (u - v / v_max)      u: drive output; a motor whose pull falls with its speed
//   turn rate = v x curvature      kinematic bicycle: the front wheels set the curvature, and the wheels do not slide
#pragma once

#include "flight/plant/plant.hpp"

namespace mavloom::flight {

class Rover final : public Plant {
public:
    static constexpr double top_speed = 10;       // m/s at full drive output
    static constexpr double pull = 15;            // m/s^2, by full drive output at rest
    static constexpr double tightest_turn = 0.8;  // m, radius at full steering output
    static constexpr double tyre_grip = 4;        // m/s^2 that the tyres hold sideways

    Rover() { channels_.used = 2; }

    void step(const Outputs& outputs, const Surroundings& around, double dt) override;
    void place(const Vector3& position, double heading) override;

private:
    void drive(double output, double dt);
    void steer(double output, double dt);

    double heading_ = 0, speed_ = 0, curvature_ = 0;
};

}  // namespace mavloom::flight
