// SPDX-License-Identifier: MIT
// Set-points made of numbers that no pilot expects, because clients may send any.
#pragma once

#include <array>
#include <limits>

#include "flight/physics/random.hpp"
#include "flight/pilot/pilot.hpp"

namespace mavloom::flight::test {

inline Setpoint any_setpoint(Random& random) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    constexpr std::array values{0.0, 1.0, -1.0, 1e3, -1e9, 1e300, -1e308, nan, infinity, -infinity};
    const auto any = [&] { return values[random.bits() % values.size()]; };
    const auto any_vector = [&] { return Vector3{any(), any(), any()}; };
    return {.steering = static_cast<Steering>(random.bits() % 7),
            .position = any_vector(),
            .velocity = any_vector(),
            .acceleration = any_vector(),
            .yaw = any(),
            .yaw_rate = any(),
            .from = any_vector(),
            .radius = any(),
            .attitude = {any(), any(), any(), any()},
            .rates = any_vector(),
            .thrust = any(),
            .mixer = {any(), any(), any(), any()},
            .touch_down = random.bits() % 2 == 0,
            .limits = {any(), any(), any(), any(), any(), any(), any(), any(), any()}};
}

[[nodiscard]] inline bool is_finite(const Kinematics& motion) {
    return motion.position.allFinite() && motion.velocity.allFinite() && motion.acceleration.allFinite() &&
           motion.attitude.coeffs().allFinite() && motion.rates.allFinite();
}

}  // namespace mavloom::flight::test
