// SPDX-License-Identifier: MIT
// Parses numbers as users and definitions write them. Pure; allocates nothing.
// Integers: 42, -1, +3, 0x1F, 0b101. `parse_number` also accepts 1.5, 1e-3, nan and inf, in any case.
// Spaces and trailing text are errors: the result is empty.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mavloom::message {

// Sign and magnitude, to cover the whole range from -2^63 to 2^64-1. `bits` is the two's complement.
struct ParsedInteger {
    bool negative = false;
    std::uint64_t magnitude = 0;
    [[nodiscard]] constexpr std::uint64_t bits() const noexcept { return negative ? 0 - magnitude : magnitude; }
};

[[nodiscard]] std::optional<ParsedInteger> parse_integer(std::string_view text) noexcept;
[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;

}  // namespace mavloom::message
