// SPDX-License-Identifier: MIT
// Attitudes. Private to flight, sim and hil. A quaternion rotates from the body frame (forward, right, down) into
// north, east, down. Euler angles are in radians in the order yaw, pitch, roll.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

using Vector3 = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

inline constexpr double pi = std::numbers::pi;
inline constexpr double gravity = 9.80665;  // m/s^2

[[nodiscard]] constexpr double to_radians(double degrees) noexcept { return degrees * (pi / 180); }
[[nodiscard]] constexpr double to_degrees(double radians) noexcept { return radians * (180 / pi); }
// Wraps an angle into [-pi, pi].
[[nodiscard]] inline double wrap_pi(double angle) noexcept { return std::remainder(angle, 2 * pi); }
// Wraps an angle into [0, 2 pi).
[[nodiscard]] inline double wrap_2pi(double angle) noexcept {
    const double wrapped = angle - 2 * pi * std::floor(angle / (2 * pi));
    return wrapped < 2 * pi ? wrapped : 0;
}

struct Euler {
    double roll = 0, pitch = 0, yaw = 0;
};

[[nodiscard]] inline Euler to_euler(const Quaternion& q) noexcept {
    const double sine = std::clamp(2 * (q.w() * q.y() - q.z() * q.x()), -1.0, 1.0);
    return {math::atan2(2 * (q.w() * q.x() + q.y() * q.z()), 1 - 2 * (q.x() * q.x() + q.y() * q.y())), math::asin(sine),
            math::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()))};
}
// A turn around a unit vector. (Eigen's AngleAxis calls the C library.)
[[nodiscard]] inline Quaternion turn_around(const Vector3& axis, double angle) noexcept {
    const double sine = math::sin(angle / 2);
    return {math::cos(angle / 2), sine * axis.x(), sine * axis.y(), sine * axis.z()};
}
[[nodiscard]] inline Quaternion to_quaternion(const Euler& e) {
    return turn_around(Vector3::UnitZ(), e.yaw) * turn_around(Vector3::UnitY(), e.pitch) *
           turn_around(Vector3::UnitX(), e.roll);
}
[[nodiscard]] inline double yaw_of(const Quaternion& q) noexcept {
    return math::atan2(2 * (q.w() * q.z() + q.x() * q.y()), 1 - 2 * (q.y() * q.y() + q.z() * q.z()));
}
// The attitude after turning with constant body rates (rad/s) for `dt` seconds. Exact; the result is normalised.
[[nodiscard]] inline Quaternion integrate(const Quaternion& q, const Vector3& rates, double dt) {
    const double angle = rates.norm() * dt;
    if (angle < 1e-12) return q;
    return (q * turn_around(rates.normalized(), angle)).normalized();
}

}  // namespace mavloom::flight
