// SPDX-License-Identifier: MIT
#include "message/cdr/names.hpp"

#include <algorithm>

#include "mavloom/base/text.hpp"

namespace mavloom::message {
namespace {

constexpr bool is_lower(char c) noexcept { return c >= 'a' && c <= 'z'; }
constexpr bool is_upper(char c) noexcept { return c >= 'A' && c <= 'Z'; }
constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }
constexpr char upper(char c) noexcept { return is_lower(c) ? static_cast<char>(c - 'a' + 'A') : c; }

// Calls `add(character, starts_word)` for each letter and digit. Any other character separates words.
template <class F>
void for_each_character(std::string_view name, F&& add) {
    bool starts_word = true;
    for (const char c : name) {
        const bool belongs = is_lower(c) || is_upper(c) || is_digit(c);
        if (belongs) add(c, starts_word);
        starts_word = !belongs;
    }
}

// A name must begin with a letter.
std::string with_letter(std::string name, char letter) {
    return name.empty() || is_digit(name.front()) ? letter + name : name;
}

}  // namespace

std::string ros2_message_name(std::string_view name) {
    std::string out;
    for_each_character(name, [&](char c, bool starts_word) { out += starts_word ? upper(c) : lower(c); });
    return with_letter(std::move(out), 'M');
}

std::string ros2_field_name(std::string_view name) {
    std::string out;
    for_each_character(name, [&](char c, bool starts_word) {
        if (starts_word && !out.empty()) out += '_';
        out += lower(c);
    });
    return with_letter(std::move(out), 'f');
}

std::string ros2_constant_name(std::string_view name) {
    std::string out = ros2_field_name(name);
    std::ranges::transform(out, out.begin(), upper);
    return out;
}

std::vector<const dialect::Field*> in_wire_order(const dialect::Message& definition) {
    std::vector<const dialect::Field*> order;
    order.reserve(definition.fields.size());
    for (const auto& field : definition.fields) order.push_back(&field);
    std::ranges::sort(order, {}, &dialect::Field::offset);
    return order;
}

}  // namespace mavloom::message
