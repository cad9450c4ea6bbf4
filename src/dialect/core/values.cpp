// SPDX-License-Identifier: MIT
#include "values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "layout.hpp"
#include "mavloom/base/text.hpp"

namespace mavloom::dialect {
namespace {

constexpr std::size_t max_word_length = 100;

template <class T, class... Form>
std::optional<T> whole(std::string_view text, Form... form) noexcept {
    T value{};
    const auto* end = text.data() + text.size();
    const auto [stop, failure] = std::from_chars(text.data(), end, value, form...);
    if (failure != std::errc{} || stop != end) return std::nullopt;
    return value;
}

std::optional<FieldType> parse_scalar(std::string_view text) noexcept {
    if (text == "uint8_t_mavlink_version") return FieldType::u8;
    for (auto type = FieldType::char8; type <= FieldType::f64; type = static_cast<FieldType>(static_cast<int>(type) + 1))
        if (text == type_name(type)) return type;
    return std::nullopt;
}

// The length of the UTF-8 sequence that starts with `lead`; 0 if none does (RFC 3629).
std::size_t sequence_length(unsigned char lead) noexcept {
    if (lead < 0x80) return 1;
    if (lead >= 0xc2 && lead < 0xe0) return 2;
    if (lead >= 0xe0 && lead < 0xf0) return 3;
    return lead >= 0xf0 && lead < 0xf5 ? 4 : 0;
}

bool is_control(unsigned char c) noexcept { return c < 0x20 || c == 0x7f; }

// Rejects overlong forms, surrogates, code points beyond U+10FFFF (RFC 3629) and C1 control characters.
bool is_allowed_pair(unsigned char lead, unsigned char second) noexcept {
    switch (lead) {
        case 0xc2: return second >= 0xa0;
        case 0xe0: return second >= 0xa0;
        case 0xed: return second < 0xa0;
        case 0xf0: return second >= 0x90;
        case 0xf4: return second < 0x90;
        default: return true;
    }
}

}  // namespace

bool is_word(std::string_view text) noexcept {
    return !text.empty() && text.size() <= max_word_length && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
}

bool is_printable(std::string_view text) noexcept {
    const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    for (std::size_t at = 0; at < text.size();) {
        const auto length = sequence_length(byte(at));
        if (length == 0 || length > text.size() - at || is_control(byte(at))) return false;
        for (std::size_t i = 1; i < length; ++i)
            if ((byte(at + i) & 0xc0) != 0x80) return false;
        if (length > 1 && !is_allowed_pair(byte(at), byte(at + 1))) return false;
        at += length;
    }
    return true;
}

std::optional<std::uint64_t> parse_unsigned(std::string_view text) noexcept {
    text = trimmed(text);
    if (text.starts_with("2**")) {
        const auto power = whole<unsigned>(text.substr(3));
        if (!power || *power > 63) return std::nullopt;
        return std::uint64_t{1} << *power;
    }
    if (text.starts_with("0x") || text.starts_with("0X")) return whole<std::uint64_t>(text.substr(2), 16);
    if (text.starts_with("0b") || text.starts_with("0B")) return whole<std::uint64_t>(text.substr(2), 2);
    return whole<std::uint64_t>(text);
}

std::optional<double> parse_number(std::string_view text) noexcept {
    text = trimmed(text);
    const auto slash = text.find('/');
    auto value = whole<double>(text.substr(0, slash));
    if (value && slash != std::string_view::npos) {
        const auto divisor = whole<double>(text.substr(slash + 1));
        if (!divisor) return std::nullopt;
        *value /= *divisor;
    }
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<TypeText> parse_type(std::string_view text) noexcept {
    const auto bracket = text.find('[');
    const auto type = parse_scalar(text.substr(0, bracket));
    if (!type) return std::nullopt;
    if (bracket == std::string_view::npos) return TypeText{*type, 0};
    if (!text.ends_with(']')) return std::nullopt;
    const auto length = whole<std::size_t>(text.substr(bracket + 1, text.size() - bracket - 2));
    if (!length || *length == 0) return std::nullopt;
    return TypeText{*type, *length};
}

std::optional<bool> parse_bool(std::string_view text) noexcept {
    if (text == "true" || text == "1") return true;
    if (text == "false" || text == "0") return false;
    return std::nullopt;
}

}  // namespace mavloom::dialect
