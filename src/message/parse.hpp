// SPDX-License-Identifier: MIT
// Numbers as people and definitions write them: 42, -1, +3, 0x1F, 0b101; and for floats also 1.5, 1e-3, nan, inf (any case). No spaces, no
// rest behind the number. Pure; allocates nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace mavloom::message {

// Sign and magnitude, so that -2^63 to 2^64-1 all fit.
struct ParsedInteger {
    bool negative = false;
    std::uint64_t magnitude = 0;
    [[nodiscard]] constexpr std::uint64_t bits() const noexcept { return negative ? 0 - magnitude : magnitude; }
};

[[nodiscard]] std::optional<ParsedInteger> parse_integer(std::string_view text) noexcept;
[[nodiscard]] std::optional<double> parse_number(std::string_view text) noexcept;

}  // namespace mavloom::message
