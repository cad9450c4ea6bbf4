// SPDX-License-Identifier: MIT
#include "flight/physics/airframe.hpp"

#include "flight/physics/fixed_wing.hpp"
#include "flight/physics/multicopter/multicopter.hpp"
#include "flight/physics/rover.hpp"

namespace mavloom::flight {

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

}  // namespace mavloom::flight
