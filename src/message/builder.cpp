// SPDX-License-Identifier: MIT
#include "mavloom/message/builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>
#include <vector>

#include "mavloom/base/suggest.hpp"
#include "mavloom/base/text.hpp"
#include "mavloom/message/visit.hpp"
#include "message/parse.hpp"

namespace mavloom::message {
namespace {

using dialect::Field;

tl::unexpected<SetupError> refuse(const dialect::Message& message, const Field& field, std::string_view why) {
    return setup_error(SetupCode::usage, fmt::format("{}.{}: {}", message.name, field.name, why));
}

template <class Integer>
std::string range_text() {
    return fmt::format("{} to {}", +std::numeric_limits<Integer>::min(), +std::numeric_limits<Integer>::max());
}

// Converts to `Integer`, or returns empty if the value is out of range.
template <class Integer>
std::optional<Integer> narrow(ParsedInteger value) noexcept {
    constexpr auto maximum = static_cast<std::uint64_t>(std::numeric_limits<Integer>::max());
    if (!value.negative || value.magnitude == 0) {
        return value.magnitude <= maximum ? std::optional(static_cast<Integer>(value.magnitude)) : std::nullopt;
    }
    if (std::is_unsigned_v<Integer> || value.magnitude > maximum + 1) return std::nullopt;
    return static_cast<Integer>(value.bits());
}

template <class Float>
double to_double(ParsedInteger value) noexcept {
    const auto magnitude = static_cast<double>(static_cast<Float>(value.magnitude));
    return value.negative ? -magnitude : magnitude;
}

// Returns empty for a fraction, NaN, an infinity, or a magnitude of 2^64 or more.
std::optional<ParsedInteger> whole(double value) noexcept {
    constexpr double beyond = 18446744073709551616.0;  // 2^64
    if (!(std::abs(value) < beyond) || value != std::trunc(value)) return std::nullopt;
    return ParsedInteger{value < 0, static_cast<std::uint64_t>(std::abs(value))};
}

// Calls `each` for every part between separators. Stops at the first error.
template <class F>
SetupResult<void> for_each_part(std::string_view list, char separator, F each) {
    for (;;) {
        const auto end = list.find(separator);
        if (auto done = each(trimmed(list.substr(0, end))); !done) return done;
        if (end == std::string_view::npos) return {};
        list.remove_prefix(end + 1);
    }
}

std::string unknown_name(const dialect::Enum& enumeration, std::string_view typed) {
    std::vector<std::string_view> names;
    names.reserve(enumeration.entries.size());
    for (const auto& entry : enumeration.entries) names.push_back(entry.name);
    return fmt::format("'{}' is neither a number nor an entry of {}{}", typed, enumeration.name,
                       did_you_mean(typed, names));
}

// Parses NAME or A|B. A part may also be a number.
SetupResult<std::uint64_t> parse_enum(const dialect::Enum& enumeration, std::string_view text) {
    std::uint64_t bits = 0;
    const auto done = for_each_part(text, '|', [&](std::string_view part) -> SetupResult<void> {
        if (const auto* entry = enumeration.find(part)) {
            bits |= entry->value;
        } else if (const auto number = parse_integer(part); number && !number->negative) {
            bits |= number->magnitude;
        } else {
            return setup_error(SetupCode::usage, unknown_name(enumeration, part));
        }
        return {};
    });
    if (!done) return tl::unexpected(done.error());
    return bits;
}

SetupResult<void> set_parsed(MessageBuilder& builder, const Field& field, ParsedInteger value, std::size_t index) {
    return visit_type(field.type, [&](auto tag) -> SetupResult<void> {
        using T = decltype(tag);
        if constexpr (std::is_floating_point_v<T>) {
            builder.put(field, static_cast<T>(to_double<T>(value)), index);
        } else {
            const auto narrowed = narrow<T>(value);
            if (!narrowed)
                return refuse(builder.definition(), field,
                              fmt::format("{}{} is out of range, {}", value.negative ? "-" : "", value.magnitude,
                                          range_text<T>()));
            builder.put(field, *narrowed, index);
        }
        return {};
    });
}

SetupResult<void> set_one_from_text(MessageBuilder& builder, const Field& field, std::string_view text,
                                    std::size_t index) {
    if (const auto integer = parse_integer(text)) return set_parsed(builder, field, *integer, index);
    const bool real = field.type == dialect::FieldType::f32 || field.type == dialect::FieldType::f64;
    if (const auto number = parse_number(text); number && real) return builder.set_number(field, *number, index);
    if (field.enumeration == nullptr || real) {
        return refuse(builder.definition(), field,
                      fmt::format("'{}' is not {}", text, real ? "a number" : "a whole number"));
    }
    const auto bits = parse_enum(*field.enumeration, text);
    if (!bits) return refuse(builder.definition(), field, bits.error().text);
    return set_parsed(builder, field, {false, *bits}, index);
}

bool is_bracketed(std::string_view text) noexcept {
    return text.size() >= 2 && text.front() == '[' && text.back() == ']';
}

}  // namespace

MessageBuilder::MessageBuilder(const dialect::Message& definition, ByteView payload) noexcept
    : definition_(&definition) {
    const auto known = std::min<std::size_t>(payload.size(), definition.wire.max_length);
    std::copy_n(payload.begin(), known, bytes_.begin());
}

SetupResult<void> MessageBuilder::set_number(const Field& field, double value, std::size_t index) {
    return visit_type(field.type, [&](auto tag) -> SetupResult<void> {
        using T = decltype(tag);
        if constexpr (std::is_same_v<T, double>) {
            put(field, value, index);
        } else if constexpr (std::is_same_v<T, float>) {
            const bool too_large = std::isfinite(value) && std::abs(value) > double{std::numeric_limits<float>::max()};
            if (too_large)
                return refuse(*definition_, field, fmt::format("{} is out of range of a 32-bit float", value));
            put(field, static_cast<float>(value), index);
        } else {
            const auto integer = whole(value);
            if (!integer)
                return refuse(*definition_, field,
                              fmt::format("{} is not a whole number in {}", value, range_text<T>()));
            return set_parsed(*this, field, *integer, index);
        }
        return {};
    });
}

SetupResult<void> MessageBuilder::set_integer(const Field& field, std::int64_t value, std::size_t index) {
    const auto bits = static_cast<std::uint64_t>(value);
    return set_parsed(*this, field, {value < 0, value < 0 ? 0 - bits : bits}, index);
}

SetupResult<void> MessageBuilder::set_unsigned(const Field& field, std::uint64_t value, std::size_t index) {
    return set_parsed(*this, field, {false, value}, index);
}

SetupResult<void> MessageBuilder::set_text(const Field& field, std::string_view utf8) {
    if (field.type != dialect::FieldType::char8) return refuse(*definition_, field, "is not a text field");
    if (utf8.size() > field.size())
        return refuse(*definition_, field,
                      fmt::format("a text of {} bytes is too long; at most {} fit", utf8.size(), field.size()));
    auto* to = bytes_.data() + field.offset;
    std::fill(std::copy(utf8.begin(), utf8.end(), to), to + field.size(), std::uint8_t{0});
    return {};
}

SetupResult<void> MessageBuilder::set_from_text(const Field& field, std::string_view value) {
    if (field.type == dialect::FieldType::char8) return set_text(field, value);
    value = trimmed(value);
    if (!field.is_array()) return set_one_from_text(*this, field, value, 0);
    const auto expected = fmt::format("expected [a,b,...] with {} elements", field.count());
    if (!is_bracketed(value)) return refuse(*definition_, field, expected);
    const auto list = value.substr(1, value.size() - 2);
    const auto given = static_cast<std::size_t>(std::count(list.begin(), list.end(), ',')) + 1;
    if (given != field.count()) return refuse(*definition_, field, fmt::format("{}, not {}", expected, given));
    std::size_t index = 0;
    return for_each_part(list, ',',
                         [&](std::string_view part) { return set_one_from_text(*this, field, part, index++); });
}

SetupResult<void> MessageBuilder::set_element_from_text(const Field& field, std::string_view value, std::size_t index) {
    return set_one_from_text(*this, field, trimmed(value), index);
}

}  // namespace mavloom::message
