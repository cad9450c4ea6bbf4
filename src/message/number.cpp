// SPDX-License-Identifier: MIT
#include "message/number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace mavloom::message {
namespace {

// Decimal digits, preceded by zeros so that "0.00" can be copied together with them.
struct Digits {
    // `room` holds at most 17 digits. It is always copied as a whole, which is faster than a variable count.
    static constexpr std::size_t zeros_before = 8, room = 24;
    std::array<char, zeros_before + 2 * room> chars;  // NOLINT: uninitialised bytes are overwritten or cut off
    const char* first;
    int count;
};

void set_digits(Digits& digits, std::uint64_t significand) noexcept {
    auto* at = digits.chars.data() + Digits::zeros_before;
    store_le(at - 8, detail::ascii_zeros);
    digits.first = at;
    digits.count = static_cast<int>(write_unsigned(at, significand) - at);
}

// Writes the exponent of scientific notation, with at least two digits as in C and Python.
char* write_exponent(char* at, int exponent) noexcept {
    *at++ = 'e';
    *at++ = exponent < 0 ? '-' : '+';
    const auto magnitude = static_cast<std::uint32_t>(std::abs(exponent));
    if (magnitude < 10) *at++ = '0';
    return write_unsigned(at, magnitude);
}

char* write_scientific(char* at, const Digits& digits, int exponent) noexcept {
    *at++ = *digits.first;
    if (digits.count > 1) {
        *at++ = '.';
        std::memcpy(at, digits.first + 1, Digits::room);
        at += digits.count - 1;
    }
    return write_exponent(at, exponent);
}

char* write_point_zero(char* at) noexcept {
    *at++ = '.';
    *at++ = '0';
    return at;
}

char* write_with_zeros_behind(char* at, const Digits& digits, int point) noexcept {
    std::memcpy(at, digits.first, Digits::room);
    std::memset(at + digits.count, '0', static_cast<std::size_t>(point - digits.count));
    return write_point_zero(at + point);
}

// Writes significand * 10^exponent. `point` is the number of digits before the decimal point.
// The limits of plain notation are those of Python's repr.
char* write_decimal(char* at, std::uint64_t significand, int exponent) noexcept {
    Digits digits;  // NOLINT: filled by set_digits
    set_digits(digits, significand);
    const int point = digits.count + exponent;
    if (point > -4 && point < digits.count) [[likely]] {
        const int zeros = point < 1 ? 1 - point : 0;
        const char* from = digits.first - zeros;
        std::memcpy(at, from, Digits::room);
        at[point + zeros] = '.';
        std::memcpy(at + point + zeros + 1, from + point + zeros, Digits::room);
        return at + digits.count + zeros + 1;
    }
    if (point >= digits.count && point <= 16) return write_with_zeros_behind(at, digits, point);
    return write_scientific(at, digits, point - 1);
}

// ---- float32 in plain notation

constexpr int fraction_bits = 23;                // stored bits; the leading 1 is implicit
constexpr std::uint32_t min_plain = 0x38d1b717;  // 1e-4f; Python writes smaller floats with an exponent
constexpr std::uint32_t end_plain = 0x4b000000;  // 2^23; all larger floats are integers

// True for floats in the range of plain notation.
// Excludes powers of two, because their two neighbours are at different distances.
bool is_plain(std::uint32_t bits) noexcept {
    return bits - min_plain < end_plain - min_plain && bits << (32 - fraction_bits) != 0;
}

// Scale factors for one exponent. After multiplication by 10^decimals, neighbouring floats are 0.1 to 1 apart.
// Half of that gap is exactly half_gap / 2^unit.
struct PlainScale {
    std::uint32_t half_gap;
    std::uint8_t unit, decimals;
};

consteval auto make_plain_scales() {
    std::array<PlainScale, (end_plain >> fraction_bits) - (min_plain >> fraction_bits)> scales{};
    for (std::size_t i = 0; i < scales.size(); ++i) {
        const auto exponent = static_cast<int>((min_plain >> fraction_bits) + i) - 127 - fraction_bits;  // -37 to -1
        const int decimals = -exponent * 1233 >> 12;                                                     // log10(2)
        std::uint32_t power_of_5 = 1;
        for (int n = 0; n < decimals; ++n) power_of_5 *= 5;
        scales[i] = {power_of_5, static_cast<std::uint8_t>(1 - exponent - decimals),
                     static_cast<std::uint8_t>(decimals)};
    }
    return scales;
}
constexpr auto plain_scales = make_plain_scales();

// The value (whole + tenths / 10) / 10^decimals.
struct Decimal {
    std::uint32_t whole;  // six to eight digits
    std::uint32_t tenths;
    std::uint32_t decimals;
};

// Returns the whole number that reads back as the same float, or else the nearest tenth.
// This is Schubfach's method (Giulietti, 2020) without its table of powers, because in this range all products are
// exact.
Decimal shortest_of(std::uint32_t bits) noexcept {
    const auto& scale = plain_scales[(bits >> fraction_bits) - (min_plain >> fraction_bits)];
    const auto fraction = (bits & ((1u << fraction_bits) - 1)) | 1u << fraction_bits;
    const std::uint64_t one = std::uint64_t{1} << scale.unit;
    const std::uint64_t value = std::uint64_t{fraction} * 2 * scale.half_gap;
    const std::uint64_t rest = value & (one - 1);
    const std::uint64_t reach = scale.half_gap - (bits & 1);  // an exact midpoint reads as the even neighbour
    const bool up = rest + reach >= one;
    const bool between = rest > reach && !up;
    const std::uint64_t tenths = 10 * rest;
    const std::uint64_t half = (one >> 1) - 1 + (tenths >> scale.unit & 1);  // ties round to even
    return {static_cast<std::uint32_t>(value >> scale.unit) + up,
            static_cast<std::uint32_t>((tenths + half) >> scale.unit) & (0u - between), scale.decimals};
}

// Writes a float in plain notation. Avoids branches, which would be unpredictable.
// Works in registers and never reads back a byte that it wrote.
char* write_plain(char* at, std::uint32_t bits) noexcept {
    constexpr std::uint64_t zero_point_zeros = detail::ascii_zeros - (std::uint64_t{'0' - '.'} << 8);
    const auto [whole, tenths, decimals] = shortest_of(bits);
    const auto digits = detail::eight_digits(whole);
    const auto leading = static_cast<int>(detail::leading_zeros(digits));
    const auto ninth = std::uint64_t{'0' + tenths};
    const auto first_eight = (digits + detail::ascii_zeros) >> (8 * leading) | ninth << 8 << (56 - 8 * leading);
    const auto behind_first = digits >> 8 | std::uint64_t{tenths} << 56;
    const int used = (static_cast<int>(std::bit_width(behind_first << 4 | 1)) + 3) / 8 + 1 - leading;
    const int point = 8 - leading - static_cast<int>(decimals);
    if (point > 0) {
        store_le(at, first_eight);
        at[point] = '.';
        at += point + 1;
        store_le(at, first_eight >> (8 * point));
        at[8 - point] = static_cast<char>(ninth);  // ignored if there is no ninth digit
        return at + std::max(used - point, 1);
    }
    store_le(at, zero_point_zeros);
    at += 2 - point;
    store_le(at, first_eight);
    at[8] = static_cast<char>(ninth);
    return at + used;
}

template <class Float>
char* write_shortest(char* at, Float value) noexcept {
    *at = '-';
    at += std::signbit(value);
    const Float magnitude = std::abs(value);
    if constexpr (std::is_same_v<Float, float>)
        if (const auto bits = std::bit_cast<std::uint32_t>(magnitude); is_plain(bits)) [[likely]]
            return write_plain(at, bits);
    if (magnitude < Float{1000000}) {
        // Whole numbers are common (0, 1, counts) and need no search for the shortest digits.
        const auto whole = static_cast<std::uint32_t>(magnitude);
        if (static_cast<Float>(whole) == magnitude) {
            at = detail::write_below_limit(at, whole);
            return write_point_zero(at);
        }
    }
    // Uses fmt's digit search but not its formatting: 23 instead of 44 ns per float (GCC 12, -O3, 2.5 GHz).
    const auto decimal = fmt::detail::dragonbox::to_decimal(magnitude);
    return write_decimal(at, decimal.significand, decimal.exponent);
}

}  // namespace

namespace detail {

char* write_above_limit(char* at, std::uint64_t value) noexcept {
    at = write_unsigned(at, value / eight_digit_limit);
    store_le(at, eight_digits(static_cast<std::uint32_t>(value % eight_digit_limit)) + ascii_zeros);
    return at + 8;
}

}  // namespace detail

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
