// SPDX-License-Identifier: MIT
// Expected texts are those of Python 3.11 (doubles) and numpy (float32), `repr` without the type.
#include "message/number.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace mavloom::message {
namespace {

template <class Write>
std::string number_text(Write write) {
    std::array<char, number_room> room{};
    return {room.data(), write(room.data())};
}
std::string f32(float v) {
    return number_text([&](char* at) { return write_float(at, v); });
}
std::string f64(double v) {
    return number_text([&](char* at) { return write_float(at, v); });
}
std::string u64(std::uint64_t v) {
    return number_text([&](char* at) { return write_unsigned(at, v); });
}
std::string i64(std::int64_t v) {
    return number_text([&](char* at) { return write_integer(at, v); });
}
std::string scaled(bool negative, std::uint64_t v, unsigned decimals) {
    return number_text([&](char* at) { return write_scaled(at, negative, v, decimals); });
}

TEST(Number, PrintsFloatsWithTheShortestDigitsOfTheirWidth) {
    EXPECT_EQ(f32(0.01f), "0.01");
    EXPECT_EQ(f32(0.1f), "0.1");
    EXPECT_EQ(f32(3.14159274f), "3.1415927");
    EXPECT_EQ(f32(-0.0031415927f), "-0.0031415927");
    EXPECT_EQ(f32(123456.79f), "123456.79");
    EXPECT_EQ(f32(0.5f), "0.5");
    EXPECT_EQ(f32(-0.99999994f), "-0.99999994");
    EXPECT_EQ(f32(2097152.25f), "2097152.2");
    EXPECT_EQ(f32(2097152.75f), "2097152.8");
    EXPECT_EQ(f32(8388607.5f), "8388607.5");
    EXPECT_EQ(f64(0.1), "0.1");
    EXPECT_EQ(f64(0.30000000000000004), "0.30000000000000004");
    EXPECT_EQ(f64(47.3977418), "47.3977418");
}

TEST(Number, PrintsWholeFloatsWithOneDecimal) {
    EXPECT_EQ(f32(0.0f), "0.0");
    EXPECT_EQ(f32(-0.0f), "-0.0");
    EXPECT_EQ(f32(1.0f), "1.0");
    EXPECT_EQ(f32(-65535.0f), "-65535.0");
    EXPECT_EQ(f32(999999.0f), "999999.0");
    EXPECT_EQ(f32(1000000.0f), "1000000.0");
    EXPECT_EQ(f32(16777216.0f), "16777216.0");
    EXPECT_EQ(f64(-0.0), "-0.0");
    EXPECT_EQ(f64(9007199254740993.0), "9007199254740992.0");
}

TEST(Number, ChangesToScientificWherePythonDoes) {
    EXPECT_EQ(f64(0.0001), "0.0001");
    EXPECT_EQ(f64(0.00012345), "0.00012345");
    EXPECT_EQ(f64(0.00001), "1e-05");
    EXPECT_EQ(f64(0.000012345), "1.2345e-05");
    EXPECT_EQ(f64(1e15), "1000000000000000.0");
    EXPECT_EQ(f64(1e16), "1e+16");
    EXPECT_EQ(f64(1.5e16), "1.5e+16");
    EXPECT_EQ(f64(1e100), "1e+100");
    EXPECT_EQ(f32(0.0001f), "0.0001");
    EXPECT_EQ(f32(std::nextafter(0.0001f, 0.0f)), "9.999999e-05");
    EXPECT_EQ(f32(1e-5f), "1e-05");
    EXPECT_EQ(f32(1e16f), "1e+16");
}

TEST(Number, PrintsTheLimitsOfFloats) {
    EXPECT_EQ(f32(std::numeric_limits<float>::max()), "3.4028235e+38");
    EXPECT_EQ(f32(std::numeric_limits<float>::min()), "1.1754944e-38");
    EXPECT_EQ(f32(std::numeric_limits<float>::denorm_min()), "1e-45");
    EXPECT_EQ(f64(std::numeric_limits<double>::max()), "1.7976931348623157e+308");
    EXPECT_EQ(f64(-std::numeric_limits<double>::min()), "-2.2250738585072014e-308");
    EXPECT_EQ(f64(std::numeric_limits<double>::denorm_min()), "5e-324");
}

TEST(Number, FloatsReadBackAsThemselves) {
    std::mt19937_64 random(1);  // NOLINT: any bits will do; the same in every run
    for (int i = 0; i < 200'000; ++i) {
        const auto bits = random();
        const auto wide = std::bit_cast<double>(bits);
        const auto narrow = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        if (std::isfinite(wide)) {
            ASSERT_EQ(std::strtod(f64(wide).c_str(), nullptr), wide);
        }
        if (std::isfinite(narrow)) {
            ASSERT_EQ(std::strtof(f32(narrow).c_str(), nullptr), narrow);
        }
    }
}

TEST(Number, FloatsHaveTheDigitsOfTheStandardLibrary) {
    constexpr std::uint32_t first = 0x38d1b717, end = 0x4b000000;  // 1e-4 to 2^23: no exponent, not only whole numbers
    std::mt19937 random(2);                                        // NOLINT: as above
    std::uniform_int_distribution<std::uint32_t> any(first, end);
    for (int i = 0; i < 200'000; ++i) {
        const auto value = std::bit_cast<float>(any(random) & (i % 2 == 0 ? ~0u : ~0u << (i / 2 % 24)));  // or few bits
        std::array<char, 64> room{};
        const auto end_of_text = std::to_chars(room.data(), room.data() + room.size(), value, std::chars_format::fixed).ptr;
        std::string expected(room.data(), end_of_text);
        if (expected.find('.') == std::string::npos) expected += ".0";
        if (value >= 1e-4f) {
            ASSERT_EQ(f32(value), expected);
        }
    }
}

TEST(Number, PrintsIntegersOfEveryLength) {
    std::uint64_t value = 0;
    std::string expected;
    for (char digit = '1'; digit <= '9'; ++digit) {
        value = value * 10 + static_cast<std::uint64_t>(digit - '0');
        expected += digit;
        EXPECT_EQ(u64(value), expected);
    }
    EXPECT_EQ(u64(0), "0");
    EXPECT_EQ(u64(99999999), "99999999");
    EXPECT_EQ(u64(100000000), "100000000");
    EXPECT_EQ(u64(1700000000123456), "1700000000123456");
    EXPECT_EQ(u64(9999999999999999), "9999999999999999");
    EXPECT_EQ(u64(10000000000000000), "10000000000000000");
    EXPECT_EQ(u64(18446744073709551615u), "18446744073709551615");
    EXPECT_EQ(i64(-1), "-1");
    EXPECT_EQ(i64(std::numeric_limits<std::int64_t>::min()), "-9223372036854775808");
    EXPECT_EQ(i64(std::numeric_limits<std::int64_t>::max()), "9223372036854775807");
}

TEST(Number, PrintsEveryByte) {
    for (unsigned value = 0; value < 256; ++value)
        EXPECT_EQ(number_text([&](char* at) { return write_byte(at, static_cast<std::uint8_t>(value)); }),
                  std::to_string(value));
}

TEST(Number, ScalesExactly) {
    EXPECT_EQ(scaled(false, 473977418, 7), "47.3977418");
    EXPECT_EQ(scaled(true, 85455940, 7), "-8.545594");
    EXPECT_EQ(scaled(true, 1, 7), "-0.0000001");
    EXPECT_EQ(scaled(false, 0, 7), "0");
    EXPECT_EQ(scaled(false, 2500, 2), "25");
    EXPECT_EQ(scaled(false, 2150, 2), "21.5");
    EXPECT_EQ(scaled(false, 7, 0), "7");
    EXPECT_EQ(scaled(false, 18446744073709551615u, 19), "1.8446744073709551615");
}

}  // namespace
}  // namespace mavloom::message
