// SPDX-License-Identifier: MIT
// The functions of <cmath> that are not exact, computed from +, -, *, / and sqrt, which IEEE 754 defines to the last
// bit. Private to flight, sim and hil, which call no others: so a flight has the same bytes on each
// x86-64 processor.
//
// The C library's own depend on its version, and on whether the processor has FMA. The results here are within 4 units
// in the last place for angles within 1e5 rad; sines and cosines are within 2 for those within 1000 rad. NaN gives NaN.
// Pure functions.
#pragma once

#include <cmath>

namespace mavloom::flight::math {

[[nodiscard]] double sin(double angle) noexcept;
[[nodiscard]] double cos(double angle) noexcept;
[[nodiscard]] inline double tan(double angle) noexcept { return sin(angle) / cos(angle); }
[[nodiscard]] double atan2(double y, double x) noexcept;
[[nodiscard]] inline double atan(double tangent) noexcept { return atan2(tangent, 1); }
[[nodiscard]] inline double asin(double sine) noexcept { return atan2(sine, std::sqrt((1 - sine) * (1 + sine))); }
[[nodiscard]] inline double acos(double cosine) noexcept {
    return atan2(std::sqrt((1 - cosine) * (1 + cosine)), cosine);
}

[[nodiscard]] double exp(double exponent) noexcept;
// exp(exponent) - 1, exact for small exponents too.
[[nodiscard]] double expm1(double exponent) noexcept;
// Of normal numbers above 0.
[[nodiscard]] double log(double number) noexcept;
// `base` is a normal number above 0. The error grows with the logarithm of the result.
[[nodiscard]] inline double pow(double base, double exponent) noexcept { return exp(exponent * log(base)); }

// Squares must not overflow.
[[nodiscard]] inline double hypot(double x, double y) noexcept { return std::sqrt(x * x + y * y); }

}  // namespace mavloom::flight::math
