// SPDX-License-Identifier: MIT
#include "flight/pilot/copter/plain_setpoint.hpp"

#include "flight/pilot/path.hpp"

namespace mavloom::flight {

namespace {

constexpr double too_much = 1e7;  // m and its derivatives

bool is_modest(double value) noexcept { return !(std::abs(value) >= too_much); }
bool is_modest(const Vector3& vector) noexcept { return !(vector.array().abs() >= too_much).any(); }
bool is_limit(double value) noexcept { return value > 0.01 && value < 1000; }
bool is_share(double value) noexcept { return std::abs(value) <= 1; }

Vector3 made_modest(const Vector3& vector) {
    return vector.unaryExpr([](double value) { return is_modest(value) ? value : nan; });
}
Vector3 given_or_zero(const Vector3& vector) {
    return vector.unaryExpr([](double value) { return finite_or(value, 0, -20, 20); });
}

bool has_plain_limits(const SpeedLimits& limits) noexcept {
    return is_limit(limits.horizontal) && is_limit(limits.up) && is_limit(limits.down) &&
           is_limit(limits.acceleration) && is_limit(limits.tilt) && limits.tilt < 1.5 && is_limit(limits.yaw_rate) &&
           limits.jerk >= 0 && limits.jerk < 1000;
}

// The controls of the steerings below the path.
bool has_plain_controls(const Setpoint& setpoint) noexcept {
    switch (setpoint.steering) {
        case Steering::attitude: return std::abs(setpoint.attitude.squaredNorm() - 1) < 0.01;
        case Steering::rates: return !setpoint.rates.array().isNaN().any() && is_modest(setpoint.rates);
        case Steering::actuators:
            return std::ranges::all_of(setpoint.mixer, [](double input) { return is_share(input); });
        default: return true;
    }
}

}  // namespace

bool is_plain(const Setpoint& setpoint) noexcept {
    return is_modest(setpoint.position) && is_modest(setpoint.velocity) && is_modest(setpoint.acceleration) &&
           is_modest(setpoint.yaw) && is_modest(setpoint.yaw_rate) && is_modest(setpoint.radius) &&
           has_plain_limits(setpoint.limits) && has_plain_controls(setpoint);
}

Setpoint made_plain(const Setpoint& given) {
    Setpoint setpoint{.steering = given.steering,
                      .position = made_modest(given.position),
                      .velocity = made_modest(given.velocity),
                      .acceleration = made_modest(given.acceleration),
                      .yaw = is_modest(given.yaw) ? given.yaw : nan,
                      .yaw_rate = is_modest(given.yaw_rate) ? given.yaw_rate : nan,
                      .radius = finite_or(given.radius, 0, -too_much, too_much),
                      .rates = given_or_zero(given.rates),
                      .thrust = finite_or(given.thrust, 0, 0, 1),
                      .touch_down = given.touch_down};
    const double length = given.attitude.norm();
    if (length > 0.1 && length < too_much) setpoint.attitude = Quaternion(given.attitude.coeffs() / length);
    for (std::size_t i = 0; i < setpoint.mixer.size(); ++i) setpoint.mixer[i] = finite_or(given.mixer[i], 0, -1, 1);
    if (has_plain_limits(given.limits)) setpoint.limits = given.limits;
    return setpoint;
}

}  // namespace mavloom::flight
