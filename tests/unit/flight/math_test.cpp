// SPDX-License-Identifier: MIT
// flight/physics/math.hpp against the C library's functions of long double, which have 11 bits more.
#include "flight/physics/math.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "flight/physics/random.hpp"

namespace mavloom::flight {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = HUGE_VAL;

// In units of the last place of `exact`.
double error_of(double value, long double exact) {
    const double nearest = static_cast<double>(exact);
    const double unit = std::nextafter(std::abs(nearest), infinite) - std::abs(nearest);
    return static_cast<double>(std::abs(static_cast<long double>(value) - exact) / static_cast<long double>(unit));
}

// Calls `check` with numbers of all magnitudes from 1e-12 to `most`, of both signs.
template <typename Check>
void for_numbers_to(double most, Check check) {
    Random random(1);
    for (int i = 0; i < 20'000; ++i) {
        const double size = random.unit() < 0.5 ? random.unit() : std::pow(10, random.uniform(-12, 0));
        check(random.unit() < 0.5 ? most * size : -most * size);
    }
}

TEST(MathTest, SineCosineAndTangent) {
    for_numbers_to(1000, [](double x) {
        const long double exact = x;
        ASSERT_LE(error_of(math::sin(x), std::sin(exact)), 2) << x;
        ASSERT_LE(error_of(math::cos(x), std::cos(exact)), 2) << x;
        ASSERT_LE(error_of(math::tan(x), std::tan(exact)), 4) << x;
    });
    for_numbers_to(1e5, [](double x) {
        const long double exact = x;
        ASSERT_LE(error_of(math::sin(x), std::sin(exact)), 4) << x;
        ASSERT_LE(error_of(math::cos(x), std::cos(exact)), 4) << x;
        ASSERT_LE(error_of(math::tan(x), std::tan(exact)), 4) << x;
    });
}

TEST(MathTest, Arcs) {
    for_numbers_to(
        100, [](double x) { ASSERT_LE(error_of(math::atan(x), std::atan(static_cast<long double>(x))), 4) << x; });
    for_numbers_to(1, [](double x) {
        ASSERT_LE(error_of(math::asin(x), std::asin(static_cast<long double>(x))), 4) << x;
        ASSERT_LE(error_of(math::acos(x), std::acos(static_cast<long double>(x))), 4) << x;
    });
}

TEST(MathTest, ArcsOfTwoNumbers) {
    Random random(2);
    for (int i = 0; i < 20'000; ++i) {
        const double y = random.uniform(-1, 1), x = random.uniform(-1, 1) * std::pow(10, random.uniform(-5, 5));
        const long double exact = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
        ASSERT_LE(error_of(math::atan2(y, x), exact), 4) << y << ", " << x;
    }
}

TEST(MathTest, ExponentialsAndLogarithms) {
    for_numbers_to(700, [](double x) {
        const long double exact = x;
        ASSERT_LE(error_of(math::exp(x), std::exp(exact)), 4) << x;
        ASSERT_LE(error_of(math::expm1(x), std::expm1(exact)), 4) << x;
        ASSERT_LE(error_of(math::log(std::abs(x)), std::log(std::abs(exact))), 4) << x;
    });
    EXPECT_NEAR(math::pow(0.8, 5.255876), std::pow(0.8, 5.255876), 1e-15);
}

// The C standard's annex F.
TEST(MathTest, CornersAreThoseOfTheStandard) {
    EXPECT_TRUE(std::signbit(math::atan2(-0.0, 1)));
    EXPECT_EQ(math::atan2(0, 0), 0);
    EXPECT_EQ(math::atan2(0, -0.0), std::numbers::pi);
    EXPECT_EQ(math::atan2(-2, 0), -std::numbers::pi / 2);
    EXPECT_EQ(math::atan2(3, -infinite), std::numbers::pi);
    EXPECT_EQ(math::atan2(infinite, infinite), std::numbers::pi / 4);
    EXPECT_EQ(math::exp(-infinite), 0);
    EXPECT_EQ(math::exp(infinite), infinite);
    EXPECT_EQ(math::expm1(0), 0);
    EXPECT_EQ(math::log(1), 0);
    EXPECT_EQ(math::log(0), -infinite);
    EXPECT_EQ(math::pow(0.3, 0), 1);
    for (const double wrong : {math::sin(nan), math::cos(infinite), math::tan(nan), math::atan2(nan, 1), math::asin(1.1),
                               math::acos(-2), math::exp(nan), math::expm1(nan), math::log(-1), math::log(nan)})
        EXPECT_TRUE(std::isnan(wrong));
}

}  // namespace
}  // namespace mavloom::flight
