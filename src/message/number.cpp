// SPDX-License-Identifier: MIT
#include "message/number.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>

namespace mavloom::message {
namespace {

constexpr auto digit_pairs = [] {
    std::array<char, 200> pairs{};
    for (std::size_t i = 0; i < 100; ++i) {
        pairs[2 * i] = static_cast<char>('0' + i / 10);
        pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
    }
    return pairs;
}();

void write_pair(char* at, std::uint32_t below_100) noexcept { std::memcpy(at, &digit_pairs[below_100 * 2], 2); }

unsigned digit_count(std::uint32_t v) noexcept {
    if (v < 10) return 1;
    if (v < 100) return 2;
    if (v < 1000) return 3;
    if (v < 10000) return 4;
    if (v < 100000) return 5;
    if (v < 1000000) return 6;
    if (v < 10000000) return 7;
    if (v < 100000000) return 8;
    return v < 1000000000 ? 9 : 10;
}

char* write_u32(char* at, std::uint32_t v) noexcept {
    const auto count = digit_count(v);
    char* end = at + count;
    char* p = end;
    while (v >= 100) {
        p -= 2;
        write_pair(p, v % 100);
        v /= 100;
    }
    if (v >= 10) {
        write_pair(p - 2, v);
    } else {
        *(p - 1) = static_cast<char>('0' + v);
    }
    return end;
}

void write_eight(char* at, std::uint32_t v) noexcept {
    const auto high = v / 10000, low = v % 10000;
    write_pair(at, high / 100);
    write_pair(at + 2, high % 100);
    write_pair(at + 4, low / 100);
    write_pair(at + 6, low % 100);
}

// The exponent of scientific notation, at least two digits as C and Python print it.
char* write_exponent(char* at, int exponent) noexcept {
    *at++ = 'e';
    *at++ = exponent < 0 ? '-' : '+';
    const auto magnitude = static_cast<std::uint32_t>(std::abs(exponent));
    if (magnitude < 10) *at++ = '0';
    return write_u32(at, magnitude);
}

constexpr int digits_room = 24;  // at most 17 digits; copied as a whole, which is faster than copying a variable count

// `digits` * 10^exponent. The point stands after `point` digits; limits of plain notation as Python's repr.
char* write_decimal(char* at, std::uint64_t significand, int exponent) noexcept {
    std::array<char, 2 * digits_room> digits;  // NOLINT: what is not written is overwritten or cut off
    const auto count = static_cast<int>(write_unsigned(digits.data(), significand) - digits.data());
    const int point = count + exponent;
    if (point > 0 && point < count) {
        std::memcpy(at, digits.data(), digits_room);
        at[point] = '.';
        std::memcpy(at + point + 1, digits.data() + point, digits_room);
        return at + count + 1;
    }
    if (point <= 0 && point > -4) {
        std::memcpy(at, "0.000", 5);
        std::memcpy(at + 2 - point, digits.data(), digits_room);
        return at + 2 - point + count;
    }
    if (point >= count && point <= 16) {
        std::memcpy(at, digits.data(), digits_room);
        std::memset(at + count, '0', static_cast<std::size_t>(point - count));
        std::memcpy(at + point, ".0", 2);
        return at + point + 2;
    }
    *at++ = digits[0];
    if (count > 1) {
        *at++ = '.';
        std::memcpy(at, digits.data() + 1, digits_room);
        at += count - 1;
    }
    return write_exponent(at, point - 1);
}

template <class Float>
char* write_shortest(char* at, Float value) noexcept {
    if (std::signbit(value)) *at++ = '-';
    const Float magnitude = std::abs(value);
    if (magnitude < Float{1000000}) {
        // Whole numbers are common (0, 1, counts) and need no search for the shortest digits.
        const auto whole = static_cast<std::uint32_t>(magnitude);
        if (static_cast<Float>(whole) == magnitude) {
            at = write_u32(at, whole);
            std::memcpy(at, ".0", 2);
            return at + 2;
        }
    }
    // fmt's own digit search without its formatting of the result: 23 instead of 44 ns a float (GCC 12, -O3, 2.5 GHz).
    const auto decimal = fmt::detail::dragonbox::to_decimal(magnitude);
    return write_decimal(at, decimal.significand, decimal.exponent);
}

}  // namespace

char* write_unsigned(char* at, std::uint64_t value) noexcept {
    constexpr std::uint64_t eight_digits = 100000000;
    if (value < eight_digits) [[likely]]
        return write_u32(at, static_cast<std::uint32_t>(value));
    const auto high = value / eight_digits;
    at = high < eight_digits ? write_u32(at, static_cast<std::uint32_t>(high)) : write_unsigned(at, high);
    write_eight(at, static_cast<std::uint32_t>(value % eight_digits));
    return at + 8;
}

char* write_integer(char* at, std::int64_t value) noexcept {
    const auto bits = static_cast<std::uint64_t>(value);
    if (value >= 0) return write_unsigned(at, bits);
    *at++ = '-';
    return write_unsigned(at, 0 - bits);
}

char* write_float(char* at, float value) noexcept { return write_shortest(at, value); }
char* write_float(char* at, double value) noexcept { return write_shortest(at, value); }

char* write_scaled(char* at, bool negative, std::uint64_t magnitude, unsigned decimals) noexcept {
    while (decimals > 0 && magnitude % 10 == 0) {
        magnitude /= 10;
        --decimals;
    }
    if (negative) *at++ = '-';
    std::array<char, 24> digits;  // NOLINT: written before it is read
    const auto count = static_cast<unsigned>(write_unsigned(digits.data(), magnitude) - digits.data());
    const auto whole = count > decimals ? count - decimals : 0;
    if (whole == 0) *at++ = '0';
    std::memcpy(at, digits.data(), whole);
    at += whole;
    if (decimals == 0) return at;
    *at++ = '.';
    for (unsigned zeros = decimals - (count - whole); zeros > 0; --zeros) *at++ = '0';
    std::memcpy(at, digits.data() + whole, count - whole);
    return at + (count - whole);
}

}  // namespace mavloom::message
