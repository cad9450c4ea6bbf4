// SPDX-License-Identifier: MIT
#include "message/invalid.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>

#include "mavloom/message/visit.hpp"
#include "message/parse.hpp"

namespace mavloom::message {
namespace {

// The value of an integer limit that definitions refer to by name, as two's complement.
std::optional<std::uint64_t> named_bound(std::string_view text) noexcept {
    struct Bound {
        std::string_view name;
        std::uint64_t bits;
    };
    constexpr auto low = [](auto minimum) { return static_cast<std::uint64_t>(std::int64_t{minimum}); };
    static constexpr std::array bounds{Bound{"UINT8_MAX", 0xff},
                                       Bound{"UINT16_MAX", 0xffff},
                                       Bound{"UINT32_MAX", 0xffffffff},
                                       Bound{"UINT64_MAX", ~std::uint64_t{0}},
                                       Bound{"INT8_MAX", 0x7f},
                                       Bound{"INT16_MAX", 0x7fff},
                                       Bound{"INT32_MAX", 0x7fffffff},
                                       Bound{"INT64_MAX", ~std::uint64_t{0} >> 1},
                                       Bound{"INT8_MIN", low(std::numeric_limits<std::int8_t>::min())},
                                       Bound{"INT16_MIN", low(std::numeric_limits<std::int16_t>::min())},
                                       Bound{"INT32_MIN", low(std::numeric_limits<std::int32_t>::min())},
                                       Bound{"INT64_MIN", low(std::numeric_limits<std::int64_t>::min())},
                                       Bound{"UINT8_MIN", 0},
                                       Bound{"UINT16_MIN", 0},
                                       Bound{"UINT32_MIN", 0},
                                       Bound{"UINT64_MIN", 0}};
    for (const auto& bound : bounds)
        if (bound.name == text) return bound.bits;
    return std::nullopt;
}

std::optional<std::uint64_t> integer_named(std::string_view text, const dialect::Enum* enumeration) noexcept {
    if (const auto bound = named_bound(text)) return bound;
    if (const auto number = parse_integer(text)) return number->bits();
    if (enumeration == nullptr) return std::nullopt;
    const auto* entry = enumeration->find(text);
    return entry == nullptr ? std::nullopt : std::optional(entry->value);
}

bool equals(const MessageView& view, const dialect::Field& field, std::size_t index, std::string_view text) noexcept {
    return visit_type(field.type, [&](auto tag) {
        const auto value = view.get<decltype(tag)>(field, index);
        if constexpr (std::is_floating_point_v<decltype(tag)>) {
            const auto wanted = parse_number(text);
            return wanted && (std::isnan(*wanted) ? std::isnan(value) : static_cast<double>(value) == *wanted);
        } else {
            const auto wanted = integer_named(text, field.enumeration);
            return wanted && static_cast<std::uint64_t>(value) == *wanted;
        }
    });
}

std::string_view element_of_list(std::string_view list, std::size_t index) noexcept {
    for (; index > 0; --index) {
        const auto comma = list.find(',');
        if (comma == std::string_view::npos) return {};
        list.remove_prefix(comma + 1);
    }
    return list.substr(0, list.find(','));
}

}  // namespace

bool is_invalid(const MessageView& view, const dialect::Field& field, std::size_t index) noexcept {
    auto rule = field.invalid;
    if (rule.empty()) return false;
    if (rule.front() != '[' || rule.back() != ']') return equals(view, field, index, rule);
    rule = rule.substr(1, rule.size() - 2);
    if (rule.ends_with(':')) return equals(view, field, 0, rule.substr(0, rule.size() - 1));
    if (rule.find(',') != std::string_view::npos) rule = element_of_list(rule, index);
    return !rule.empty() && equals(view, field, index, rule);
}

}  // namespace mavloom::message
