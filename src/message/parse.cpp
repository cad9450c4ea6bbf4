// SPDX-License-Identifier: MIT
#include "message/parse.hpp"

#include <charconv>
#include <system_error>

namespace mavloom::message {
namespace {

bool take_sign(std::string_view& text) noexcept {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) text.remove_prefix(1);
    return negative;
}

int take_base(std::string_view& text) noexcept {
    if (text.size() < 3 || text[0] != '0') return 10;
    const int base = text[1] == 'x' || text[1] == 'X' ? 16 : text[1] == 'b' || text[1] == 'B' ? 2 : 10;
    if (base != 10) text.remove_prefix(2);
    return base;
}

}  // namespace

std::optional<ParsedInteger> parse_integer(std::string_view text) noexcept {
    ParsedInteger number{take_sign(text), 0};
    const int base = take_base(text);
    const auto* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, number.magnitude, base);
    if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
    constexpr std::uint64_t lowest = std::uint64_t{1} << 63;
    if (number.negative && number.magnitude > lowest) return std::nullopt;
    return number;
}

std::optional<double> parse_number(std::string_view text) noexcept {
    if (const auto whole = parse_integer(text)) {
        const auto magnitude = static_cast<double>(whole->magnitude);
        return whole->negative ? -magnitude : magnitude;
    }
    const bool negative = take_sign(text);
    // from_chars also accepts a minus sign and "nan(...)". Reject both here: the sign is already consumed.
    if (text.empty() || text.front() == '-' || text.back() == ')') return std::nullopt;
    double value = 0;
    const auto* end = text.data() + text.size();
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc{} || result.ptr != end) return std::nullopt;
    return negative ? -value : value;
}

}  // namespace mavloom::message
