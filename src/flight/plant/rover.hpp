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
    explicit Rover(const RoverBody& body);

    void step(const Outputs& outputs, const Surroundings& around, double dt) override;
    void place(const Vector3& position, double heading) override;
    void set_mass(double kg) override { body_.mass_kg = kg; }

private:
    void drive(double output, double dt);
    void steer(double output, double dt);

    RoverBody body_;
    double heading_ = 0, speed_ = 0, curvature_ = 0;
};

}  // namespace mavloom::flight
