// SPDX-License-Identifier: MIT
#include "flight/plant/plant.hpp"

#include "flight/plant/fixed_wing.hpp"
#include "flight/plant/multicopter.hpp"
#include "flight/plant/rover.hpp"

namespace mavloom::flight {

void Plant::integrate_step(const Vector3& acceleration, const Vector3& rates, double dt) {
    motion_.acceleration = acceleration;
    motion_.velocity += acceleration * dt;
    motion_.position += motion_.velocity * dt;
    motion_.rates = rates;
    motion_.attitude = integrate(motion_.attitude, rates, dt);
}

bool Plant::is_finite() const {
    constexpr double max_metres = 1e8, fastest = 1e6;  // as 32-bit numbers, also their squares are finite
    const auto is_within = [](const Vector3& value, double most) { return (value.array().abs() < most).all(); };
    return is_within(motion_.position, max_metres) && is_within(motion_.velocity, fastest) &&
           is_within(motion_.acceleration, fastest) && is_within(motion_.rates, fastest) &&
           motion_.attitude.coeffs().allFinite();
}

void Plant::rest_at(const Vector3& position, double heading) {
    motion_ = {.position = position, .attitude = to_quaternion({0, 0, heading})};
    air_velocity_ = Vector3::Zero();
    touches_ground_ = true;
    thrust_ = load_ = 0;
}

std::unique_ptr<Plant> make_plant(Kind kind, const Body& body) {
    if (kind == Kind::plane) return std::make_unique<FixedWing>(body.plane);
    if (kind == Kind::rover) return std::make_unique<Rover>(body.rover);
    return std::make_unique<Multicopter>(body.copter);
}

}  // namespace mavloom::flight
