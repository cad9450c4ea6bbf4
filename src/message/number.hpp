// SPDX-License-Identifier: MIT
// Writes numbers as text, for the formatters: integers in decimal, floats in their shortest form. The shortest form has
// the fewest digits that read back as the same float32 or double. It looks as in Python and numpy: 0.01, 1.0, -0.0,
// 1e-05, 1e+16. Each function writes at `at`, which must have `number_room` bytes, and returns the end. Pure; allocates
// nothing.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "mavloom/base/bytes.hpp"

namespace mavloom::message {

// The room that every function below needs. A function may write beyond the end that it returns. The longest result is
// "-2.2250738585072014e-308".
inline constexpr std::size_t number_room = 48;

namespace detail {

// Returns the eight decimal digits of `value` < 10^8, one in each byte as 0 to 9, the first digit in the lowest byte.
// Splits the value into groups of four digits, then pairs, then digits, in all lanes of a word at once. It has no
// branches, because the lengths of telemetry numbers are unpredictable.
constexpr std::uint64_t eight_digits(std::uint32_t value) noexcept {
    // x * 10486 >> 20 is x / 100 for x below 10^4; x * 103 >> 10 is x / 10 for x below 100.
    constexpr std::uint64_t by_100 = 10486, by_10 = 103;
    const std::uint64_t fours = value / 10000 | std::uint64_t{value % 10000} << 32;
    const std::uint64_t hundreds = (fours * by_100 >> 20) & 0x0000007f0000007f;
    const std::uint64_t pairs = hundreds | (fours - hundreds * 100) << 16;
    const std::uint64_t tens = (pairs * by_10 >> 10) & 0x000f000f000f000f;
    return tens | (pairs - tens * 10) << 8;
}

inline constexpr std::uint64_t ascii_zeros = 0x3030303030303030;
inline constexpr std::uint32_t eight_digit_limit = 100000000;

// Counts the leading zeros of the eight digits; 7 for zero, which has one digit.
constexpr unsigned leading_zeros(std::uint64_t digits) noexcept {
    return static_cast<unsigned>(std::countr_zero(digits | std::uint64_t{1} << 56)) / 8;
}

inline char* write_below_limit(char* at, std::uint32_t value) noexcept {
    if (value < 10) {  // fast path: most ids, states and counts
        *at = static_cast<char>('0' + value);
        return at + 1;
    }
    const auto digits = eight_digits(value);
    const auto zeros = leading_zeros(digits);
    store_le(at, (digits + ascii_zeros) >> (8 * zeros));
    return at + (8 - zeros);
}

char* write_above_limit(char* at, std::uint64_t value) noexcept;

}  // namespace detail

inline char* write_unsigned(char* at, std::uint64_t value) noexcept {
    if (value < detail::eight_digit_limit) [[likely]]
        return detail::write_below_limit(at, static_cast<std::uint32_t>(value));
    return detail::write_above_limit(at, value);
}

namespace detail {

struct ByteText {
    std::array<char, 3> digits;
    std::uint8_t length;
};

consteval std::array<ByteText, 256> make_byte_texts() {
    std::array<ByteText, 256> texts{};
    for (unsigned v = 0; v < texts.size(); ++v) {
        auto& [digits, length] = texts[v];
        for (unsigned by = v < 10 ? 1 : v < 100 ? 10 : 100; by != 0; by /= 10)
            digits[length++] = static_cast<char>('0' + v / by % 10);
    }
    return texts;
}

inline constexpr auto byte_texts = make_byte_texts();

}  // namespace detail

inline char* write_byte(char* at, std::uint8_t value) noexcept {
    const auto& text = detail::byte_texts[value];
    std::memcpy(at, &text, sizeof text);
    return at + text.length;
}

inline char* write_integer(char* at, std::int64_t value) noexcept {
    const auto bits = static_cast<std::uint64_t>(value);
    *at = '-';
    return value < 0 ? write_unsigned(at + 1, 0 - bits) : write_unsigned(at, bits);
}

// `value` must be finite.
char* write_float(char* at, float value) noexcept;
char* write_float(char* at, double value) noexcept;

// Writes `magnitude` / 10^decimals exactly, without trailing zeros: 473977418 with 7 decimals is 47.3977418.
// `decimals` is at most 19.
char* write_scaled(char* at, bool negative, std::uint64_t magnitude, unsigned decimals) noexcept;

}  // namespace mavloom::message
