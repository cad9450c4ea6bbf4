// SPDX-License-Identifier: MIT
// Smooth motion: functions that bring a value to its goal while its derivatives stay within limits. Private to flight;
// pure functions.
#pragma once

#include <algorithm>
#include <cmath>

namespace mavloom::flight {

// Returns the rate at which to close an error, such that `deceleration` can always bring the rate to zero in time. It
// is proportional to a small error (`gain`, 1/s), and follows the square-root law of braking for a large one.
[[nodiscard]] inline double closing_speed(double error, double gain, double deceleration) noexcept {
    const double knee = deceleration / (gain * gain);
    const double size = std::abs(error);
    if (size <= knee) return gain * error;
    return std::copysign(std::sqrt(2 * deceleration * (size - knee / 2)), error);
}

// Returns `from`, moved towards `to` by at most `most`.
[[nodiscard]] inline double moved_towards(double from, double to, double most) noexcept {
    return from + std::clamp(to - from, -most, most);
}

// The vector with at most this length.
template <class Vector>
[[nodiscard]] Vector limited(const Vector& vector, double longest) {
    const double length = vector.norm();
    return length > longest ? Vector(vector * (longest / length)) : vector;
}

}  // namespace mavloom::flight
