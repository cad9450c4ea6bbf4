// SPDX-License-Identifier: MIT
#include "flight/inputs.hpp"

#include <algorithm>
#include <cmath>

namespace mavloom::flight {

namespace {

constexpr double max_distance = 1e6, max_rate = 1e3;  // m; m/s, m/s^2 and rad/s

Vector3 each_bounded(const Vector3& vector, double most) noexcept {
    return {bounded(vector.x(), most), bounded(vector.y(), most), bounded(vector.z(), most)};
}
// North and east come together.
Vector3 paired(Vector3 vector) noexcept {
    if (std::isnan(vector.x()) || std::isnan(vector.y())) vector.x() = vector.y() = nan;
    return vector;
}
double share(double value, double low, double fallback) noexcept {
    return std::isfinite(value) ? std::clamp(value, low, 1.0) : fallback;
}

}  // namespace

double bounded(double value, double most) noexcept {
    return std::isfinite(value) ? std::clamp(value, -most, most) : nan;
}

Sticks bounded(const Sticks& sticks) noexcept {
    return {.pitch = share(sticks.pitch, -1, 0),
            .roll = share(sticks.roll, -1, 0),
            .yaw = share(sticks.yaw, -1, 0),
            .throttle = share(sticks.throttle, 0, 0.5)};
}

std::optional<OffboardSetpoint> bounded(const OffboardSetpoint& given) noexcept {
    OffboardSetpoint setpoint = given;
    setpoint.position = paired(each_bounded(given.position, max_distance));
    setpoint.velocity = paired(each_bounded(given.velocity, max_rate));
    setpoint.acceleration = paired(each_bounded(given.acceleration, max_rate));
    setpoint.yaw = bounded(given.yaw, 1e3);
    setpoint.yaw_rate = bounded(given.yaw_rate, max_rate);
    setpoint.rates = each_bounded(given.rates, 20);
    setpoint.thrust = share(given.thrust, -1, 0);
    for (double& input : setpoint.mixer) input = share(input, -1, 0);
    const double length = given.attitude.norm();
    const bool is_turn = std::isfinite(length) && length > 0.1;
    if (is_turn) setpoint.attitude.coeffs() /= length;
    switch (setpoint.steering) {
        case Steering::trajectory:
            if (has_any(setpoint.position) || has_any(setpoint.velocity) || has_any(setpoint.acceleration))
                return setpoint;
            return std::nullopt;
        case Steering::attitude: return is_turn ? std::optional(setpoint) : std::nullopt;
        case Steering::rates:
            if (!has_any(setpoint.rates)) return std::nullopt;
            setpoint.rates = setpoint.rates.array().isNaN().select(0, setpoint.rates);
            return setpoint;
        case Steering::actuators: return setpoint;
        default: return std::nullopt;
    }
}

}  // namespace mavloom::flight
