// SPDX-License-Identifier: MIT
// Converts values to the units of messages. Private to flight, sim and hil. No value overflows: integers saturate, and
// NaN becomes 0.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "flight/physics/rotation.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

// The nearest integer that the field can hold.
template <class Int>
[[nodiscard]] Int saturated(double value) noexcept {
    using Range = std::numeric_limits<Int>;
    if (!(value > double{Range::min()})) return std::isnan(value) ? Int{0} : Range::min();
    if (value >= double{Range::max()}) return Range::max();
    return static_cast<Int>(std::lrint(value));
}

[[nodiscard]] inline float as_float(double value) noexcept { return static_cast<float>(value); }
[[nodiscard]] inline std::int32_t to_mm(double metres) noexcept { return saturated<std::int32_t>(metres * 1e3); }
[[nodiscard]] inline std::int16_t to_cm_s(double metres_s) noexcept { return saturated<std::int16_t>(metres_s * 1e2); }
// An angle in 0 to 2 pi as 0 to 35999.
[[nodiscard]] inline std::uint16_t to_centidegrees(double radians) noexcept {
    return static_cast<std::uint16_t>(std::lrint(to_degrees(radians) * 100) % 36000);
}
// An angle in 0 to 2 pi as whole degrees, 0 to 359, truncated as in PX4.
[[nodiscard]] inline std::uint16_t to_whole_degrees(double radians) noexcept {
    return static_cast<std::uint16_t>(static_cast<int>(to_degrees(radians)) % 360);
}

inline constexpr float float_nan = std::numeric_limits<float>::quiet_NaN();

}  // namespace mavloom::flight
