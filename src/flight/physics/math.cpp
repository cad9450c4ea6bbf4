// SPDX-License-Identifier: MIT
#include "flight/physics/math.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace mavloom::flight::math {

namespace {

using std::numbers::pi;

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(), infinite = HUGE_VAL;

// The sum of factors[i] * x^i.
template <std::size_t count>
constexpr double polynomial(const std::array<double, count>& factors, double x) noexcept {
    double sum = 0;
    for (std::size_t i = count; i-- > 0;) sum = sum * x + factors[i];
    return sum;
}

// 1 / first!, 1 / (first + step)!, ..., with the signs of Taylor's series.
template <std::size_t count>
constexpr std::array<double, count> reciprocal_factorials(int first, int step, double sign) noexcept {
    std::array<double, count> factors{};
    double factorial = 1;
    int n = 1;
    for (std::size_t i = 0; i < count; ++i) {
        for (const int end = first + step * static_cast<int>(i); n <= end; ++n) factorial *= n;
        factors[i] = (i % 2 == 0 ? 1 : sign) / factorial;
    }
    return factors;
}

// An angle as `quarters` * pi / 2 + `rest`; `rest` is within pi / 4 of 0.
struct Reduced {
    int quarters;
    double rest;
};

// Cody and Waite: pi / 2 in three parts, of which the first two have 33 bits each, so that their products are exact.
Reduced reduced(double angle) noexcept {
    constexpr double part1 = 0x1.921fb544p+0, part2 = 0x1.0b4611a6p-34, part3 = 0x1.3198a2e037073p-69;
    if (!(std::abs(angle) < 1e5)) angle = std::remainder(angle, 2 * pi);
    if (std::isnan(angle)) return {0, angle};
    const double quarters = std::round(angle * (2 / pi));
    return {static_cast<int>(quarters), ((angle - quarters * part1) - quarters * part2) - quarters * part3};
}

// |x| is up to pi / 4.
double sine_series(double x) noexcept {
    constexpr auto factors = reciprocal_factorials<8>(3, 2, -1);
    const double square = x * x;
    return x - x * square * polynomial(factors, square);
}
double cosine_series(double x) noexcept {
    constexpr auto factors = reciprocal_factorials<8>(4, 2, -1);
    const double square = x * x;
    return 1 - (square / 2 - square * square * polynomial(factors, square));
}

// The sine of `quarters` right angles and `rest`.
double sine_of(const Reduced& angle) noexcept {
    const double value = (angle.quarters & 1) != 0 ? cosine_series(angle.rest) : sine_series(angle.rest);
    return (angle.quarters & 2) != 0 ? -value : value;
}

// The arc tangent of a / b; 0 <= a <= b, b is above 0. With t = (a / b - c) / (1 + c * a / b) it is atan(c) + atan(t),
// and c, a multiple of 1/8, is chosen so that t is at most 1/16.
double arc_of(double a, double b) noexcept {
    constexpr std::array arcs{0.0,  // atan(0 / 8), atan(1 / 8), ...
                              0.12435499454676144,
                              0.24497866312686414,
                              0.3587706702705722,
                              0.4636476090008061,
                              0.5585993153435624,
                              0.6435011087932844,
                              0.7188299996216245,
                              pi / 4};
    constexpr std::array factors{1 / 3.0, -1 / 5.0, 1 / 7.0, -1 / 9.0, 1 / 11.0, -1 / 13.0};
    const auto nearest = static_cast<std::size_t>(8 * (a / b) + 0.5);
    const double c = static_cast<double>(nearest) / 8;
    const double t = (a - c * b) / (b + c * a), square = t * t;
    return arcs[nearest] + (t - t * square * polynomial(factors, square));
}

// The arc tangent of y / x, both at least 0.
double first_quadrant(double y, double x) noexcept {
    const double a = std::min(x, y), b = std::max(x, y);
    if (b == 0) return 0;
    const double arc = std::isinf(b) ? (std::isinf(a) ? pi / 4 : 0) : arc_of(a, b);
    return y > x ? pi / 2 - arc : arc;
}

constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;  // the first has 32 bits

// exp(x) - 1; |x| is up to ln(2) / 2.
double exponential_series(double x) noexcept {
    constexpr auto factors = reciprocal_factorials<12>(2, 1, 1);
    return x + x * x * polynomial(factors, x);
}

}  // namespace

double sin(double angle) noexcept { return sine_of(reduced(angle)); }

double cos(double angle) noexcept {
    Reduced turned = reduced(angle);
    ++turned.quarters;
    return sine_of(turned);
}

double atan2(double y, double x) noexcept {
    if (std::isnan(x) || std::isnan(y)) return not_a_number;
    const double arc = first_quadrant(std::abs(y), std::abs(x));
    return std::copysign(std::signbit(x) ? pi - arc : arc, y);
}

double exp(double exponent) noexcept {
    if (std::isnan(exponent)) return exponent;
    if (exponent > 709.7) return infinite;
    if (exponent < -708) return 0;  // less than all normal numbers
    const double twos = std::round(exponent / std::numbers::ln2);
    const double rest = (exponent - twos * ln2_high) - twos * ln2_low;
    return std::ldexp(1 + exponential_series(rest), static_cast<int>(twos));
}

double expm1(double exponent) noexcept {
    return std::abs(exponent) < 0.34 ? exponential_series(exponent) : exp(exponent) - 1;
}

double log(double number) noexcept {
    if (!(number > 0) || std::isinf(number)) return number == 0 ? -infinite : number < 0 ? not_a_number : number;
    int twos = 0;
    double mantissa = std::frexp(number, &twos);
    if (mantissa < std::numbers::sqrt2 / 2) mantissa *= 2, --twos;
    // log(m) = 2 artanh(s) = 2 (s + s^3 / 3 + ...); |s| is at most 0.172.
    constexpr std::array factors{1 / 3.0,  1 / 5.0,  1 / 7.0,  1 / 9.0,  1 / 11.0,
                                 1 / 13.0, 1 / 15.0, 1 / 17.0, 1 / 19.0, 1 / 21.0};
    const double s = (mantissa - 1) / (mantissa + 1), square = s * s;
    return twos * ln2_high + (2 * (s + s * square * polynomial(factors, square)) + twos * ln2_low);
}

}  // namespace mavloom::flight::math
