// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <utility>

#include "mavloom/message/cdr.hpp"
#include "mavloom/message/visit.hpp"
#include "message/cdr/names.hpp"

namespace mavloom::message {
namespace {

// Readers differ about the sign of ROS 2's `char`, so a single character is a uint8.
std::string_view ros2_type_name(dialect::FieldType type) noexcept {
    constexpr std::string_view names[] = {"uint8", "uint8",  "int8",  "uint16",  "int16",  "uint32",
                                          "int32", "uint64", "int64", "float32", "float64"};
    return names[static_cast<std::size_t>(type)];
}

// False for types that are no integers: constants of floats name no values.
bool fits(std::uint64_t value, dialect::FieldType type) noexcept {
    return visit_type(type, [&](auto tag) {
        using T = decltype(tag);
        return std::is_integral_v<T> && value <= static_cast<std::uint64_t>(std::numeric_limits<T>::max());
    });
}

// ROS 2 takes text in square brackets for the unit.
std::string without_brackets(std::string_view text) {
    std::string result(text);
    std::ranges::replace(result, '[', '(');
    std::ranges::replace(result, ']', ')');
    return result;
}

class Schema {
public:
    explicit Schema(const dialect::Message& definition)
        : text_(fmt::format("# MAVLink {} ({})\n", definition.name, definition.id().value)) {
        for (const auto* field : in_wire_order(definition)) add(*field);
    }
    [[nodiscard]] std::string take() && { return std::move(text_); }

private:
    void add(const dialect::Field& field) {
        const std::string name = new_field_name(field.name);
        if (field.enumeration != nullptr) add_constants(field, name);
        if (field.is_text()) {
            put("string {}", name);
        } else if (field.is_array()) {
            put("{}[{}] {}", ros2_type_name(field.type), field.array_length, name);
        } else {
            put("{} {}", ros2_type_name(field.type), name);
        }
        if (!field.units.empty() || !field.invalid.empty()) put("  #");
        if (!field.units.empty()) put(" [{}]", field.units);
        if (!field.invalid.empty()) put(" invalid: {}", without_brackets(field.invalid));
        text_ += '\n';
    }

    // Viewers show a constant's name for its value in the field that follows, if the types are the same.
    void add_constants(const dialect::Field& field, std::string_view field_name) {
        for (const auto& entry : field.enumeration->entries) {
            if (!fits(entry.value, field.type)) continue;
            std::string name = ros2_constant_name(entry.name);
            // Names are unique in a message, so the second field of an enum puts its own name before them.
            if (!constants_.insert(name).second) {
                name = ros2_constant_name(fmt::format("{}_{}", field_name, name));
                if (!constants_.insert(name).second) continue;
            }
            put("{} {}={}\n", ros2_type_name(field.type), name, entry.value);
        }
    }

    // Two fields of a user's own definition may differ only in case.
    std::string new_field_name(std::string_view mavlink_name) {
        std::string name = ros2_field_name(mavlink_name);
        while (!fields_.insert(name).second) name += '2';
        return name;
    }

    template <class... Args>
    void put(fmt::format_string<Args...> format, Args&&... args) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    }

    std::string text_;
    std::set<std::string> fields_, constants_;
};

}  // namespace

std::string ros2_type(const dialect::Message& definition) {
    return "mavlink/msg/" + ros2_message_name(definition.name);
}

std::string ros2msg(const dialect::Message& definition) { return Schema(definition).take(); }

}  // namespace mavloom::message
