// SPDX-License-Identifier: MIT
#include "sim/physics/airframe.hpp"

#include "sim/physics/fixed_wing.hpp"
#include "sim/physics/multicopter/multicopter.hpp"
#include "sim/physics/rover.hpp"

namespace mavloom::sim {

void Airframe::integrate_step(const Vector3& acceleration, const Vector3& rates) {
    motion_.acceleration = acceleration;
    motion_.velocity += acceleration * step_s;
    motion_.position += motion_.velocity * step_s;
    motion_.rates = rates;
    motion_.attitude = integrate(motion_.attitude, rates, step_s);
}

std::unique_ptr<Airframe> make_airframe(Kind kind) {
    if (kind == Kind::plane) return std::make_unique<FixedWing>();
    if (kind == Kind::rover) return std::make_unique<Rover>();
    return std::make_unique<Multicopter>();
}

}  // namespace mavloom::sim
