// SPDX-License-Identifier: MIT
#include "dialect_print.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <vector>

#include "mavloom/base/counted.hpp"

namespace mavloom::app {
namespace {

using dialect::CommandParam;
using dialect::Deprecation;
using dialect::Enum;
using dialect::EnumEntry;
using dialect::Field;
using dialect::Message;

constexpr std::uint64_t largest_exact_integer = std::uint64_t{1} << 53;  // beyond it, JSON numbers lose digits

template <class... Arguments>
void add(fmt::memory_buffer& out, fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Arguments>(arguments)...);
}

std::string_view scalar_type(dialect::FieldType type) {
    constexpr std::array<std::string_view, 11> names = {"char",    "uint8_t",  "int8_t",  "uint16_t",
                                                        "int16_t", "uint32_t", "int32_t", "uint64_t",
                                                        "int64_t", "float",    "double"};
    return names[static_cast<std::size_t>(type)];
}

std::string type_text(const Field& field) {
    if (!field.is_array()) return std::string(scalar_type(field.type));
    return fmt::format("{}[{}]", scalar_type(field.type), field.array_length);
}

std::string length_text(const Message& message) {
    if (message.wire.min_length == message.wire.max_length) return fmt::format("{}", message.wire.max_length);
    return fmt::format("{}..{}", message.wire.min_length, message.wire.max_length);
}

void add_deprecation(fmt::memory_buffer& out, const Deprecation& deprecated) {
    if (deprecated.since.empty()) return;
    add(out, "deprecated since {}", deprecated.since);
    if (!deprecated.replaced_by.empty()) add(out, ", replaced by {}", deprecated.replaced_by);
    add(out, "\n");
}

std::string notes(const Field& field) {
    std::vector<std::string> notes;
    if (field.extension) notes.emplace_back("extension");
    if (field.instance) notes.emplace_back("instance");
    if (field.enumeration != nullptr)
        notes.push_back(fmt::format("{}{}", field.bitmask ? "flags of " : "", field.enumeration->name));
    else if (field.bitmask) notes.emplace_back("flags");
    if (field.multiplier != 0) notes.push_back(fmt::format("times {}", field.multiplier));
    if (!field.invalid.empty()) notes.push_back(fmt::format("none: {}", field.invalid));
    return fmt::format("{}", fmt::join(notes, ", "));
}

template <class Range, class Width>
std::size_t widest(const Range& range, Width width) {
    std::size_t most = 0;
    for (const auto& item : range) most = std::max(most, width(item).size());
    return most;
}

std::string range_text(const CommandParam& param) {
    std::string text;
    if (param.minimum) text += fmt::format(", at least {}", *param.minimum);
    if (param.maximum) text += fmt::format(", at most {}", *param.maximum);
    if (param.increment) text += fmt::format(", in steps of {}", *param.increment);
    if (!param.default_value.empty()) text += fmt::format(", default {}", param.default_value);
    return text;
}

void add_param(fmt::memory_buffer& out, const CommandParam& param) {
    const auto name = param.reserved ? "(reserved)" : param.label.empty() ? "-" : param.label;
    add(out, "  param{}  {}", param.index, name);
    if (!param.units.empty()) add(out, " [{}]", param.units);
    if (!param.enum_name.empty()) add(out, ", {}", param.enum_name);
    add(out, "{}\n", range_text(param));
}

// Writes the members of one JSON object, separated by commas.
class JsonObject {
public:
    explicit JsonObject(fmt::memory_buffer& out) : out_(out) { add(out_, "{{"); }
    void close() { add(out_, "}}"); }

    fmt::memory_buffer& key(std::string_view name) {
        add(out_, "{}\"{}\":", is_first_ ? "" : ",", name);
        is_first_ = false;
        return out_;
    }
    void text(std::string_view name, std::string_view value) { add(key(name), "{}", json_quoted(value)); }
    void boolean(std::string_view name, bool value) { add(key(name), "{}", value); }
    void number(std::string_view name, double value) { add(key(name), "{}", value); }
    void integer(std::string_view name, std::uint64_t value) {
        if (value > largest_exact_integer) return text(name, fmt::format("{}", value));
        add(key(name), "{}", value);
    }
    void text_if_any(std::string_view name, std::string_view value) {
        if (!value.empty()) text(name, value);
    }
    void number_if_any(std::string_view name, const std::optional<double>& value) {
        if (value) number(name, *value);
    }
    void deprecation(const Deprecation& deprecated) {
        if (deprecated.since.empty()) return;
        text("deprecated_since", deprecated.since);
        text_if_any("replaced_by", deprecated.replaced_by);
    }

private:
    fmt::memory_buffer& out_;
    bool is_first_ = true;
};

template <class Range, class Write>
void json_array(fmt::memory_buffer& out, const Range& range, Write write) {
    add(out, "[");
    bool is_first = true;
    for (const auto& item : range) {
        if (!is_first) add(out, ",");
        is_first = false;
        write(item);
    }
    add(out, "]");
}

void add_message_head(JsonObject& object, const Message& message) {
    object.integer("id", message.id().value);
    object.text("name", message.name);
    object.integer("min_length", message.wire.min_length);
    object.integer("max_length", message.wire.max_length);
    object.text("origin", message.origin);
    object.deprecation(message.deprecated);
}

void json_field(fmt::memory_buffer& out, const Field& field) {
    JsonObject object(out);
    object.text("name", field.name);
    object.text("type", scalar_type(field.type));
    object.integer("array_length", field.array_length);
    object.integer("offset", field.offset);
    object.boolean("extension", field.extension);
    object.boolean("instance", field.instance);
    object.boolean("bitmask", field.bitmask);
    object.text_if_any("units", field.units);
    object.text_if_any("enum", field.enumeration == nullptr ? "" : field.enumeration->name);
    object.text_if_any("invalid", field.invalid);
    if (field.multiplier != 0) object.number("multiplier", field.multiplier);
    object.close();
}

void json_param(fmt::memory_buffer& out, const CommandParam& param) {
    JsonObject object(out);
    object.integer("index", param.index);
    object.text_if_any("label", param.label);
    object.text_if_any("units", param.units);
    object.text_if_any("enum", param.enum_name);
    object.text_if_any("default", param.default_value);
    object.number_if_any("minimum", param.minimum);
    object.number_if_any("maximum", param.maximum);
    object.number_if_any("increment", param.increment);
    object.boolean("reserved", param.reserved);
    object.close();
}

void add_entry_members(JsonObject& object, const EnumEntry& entry) {
    object.text("name", entry.name);
    object.integer("value", entry.value);
    object.deprecation(entry.deprecated);
    if (entry.params.empty()) return;
    auto& out = object.key("params");
    json_array(out, entry.params, [&](const auto& param) { json_param(out, param); });
}

}  // namespace

void print_list(fmt::memory_buffer& out, const dialect::Dialect& dialect) {
    const auto width = widest(dialect.messages(), [](const auto& m) { return m.name; });
    for (const auto& message : dialect.messages())
        add(out, "{:>8}  {:<{}}  {:>8}  {}\n", message.id().value, message.name, width, length_text(message),
            message.origin);
}

void print_message(fmt::memory_buffer& out, const Message& message) {
    add(out, "{} ({}), {}, {} {}, CRC_EXTRA {}\n", message.name, message.id().value, message.origin,
        length_text(message), plural(message.wire.max_length, "byte"), message.wire.crc_extra);
    add_deprecation(out, message.deprecated);
    const auto type_width = widest(message.fields, type_text);
    const auto name_width = widest(message.fields, [](const auto& f) { return f.name; });
    const auto units_width = widest(message.fields, [](const auto& f) { return f.units; });
    for (const auto& field : message.fields) {
        auto line = fmt::format("{:>4}  {:<{}}  {:<{}}  {:<{}}  {}", field.offset, type_text(field), type_width,
                                field.name, name_width, field.units, units_width, notes(field));
        line.erase(line.find_last_not_of(' ') + 1);
        add(out, "{}\n", line);
    }
}

void print_enum(fmt::memory_buffer& out, const Enum& e) {
    add(out, "{}, {}{}\n", e.name, counted(e.entries.size(), "entry", "entries"), e.bitmask ? ", flags" : "");
    add_deprecation(out, e.deprecated);
    for (const auto& entry : e.entries) add(out, "{:>10}  {}\n", entry.value, entry.name);
}

void print_entry(fmt::memory_buffer& out, const Enum& owner, const EnumEntry& entry) {
    add(out, "{} = {} in {}\n", entry.name, entry.value, owner.name);
    add_deprecation(out, entry.deprecated);
    for (const auto& param : entry.params) add_param(out, param);
}

void json_list(fmt::memory_buffer& out, const dialect::Dialect& dialect) {
    for (const auto& message : dialect.messages()) {
        JsonObject object(out);
        add_message_head(object, message);
        object.close();
        add(out, "\n");
    }
}

void json_message(fmt::memory_buffer& out, const Message& message) {
    JsonObject object(out);
    object.text("kind", "message");
    add_message_head(object, message);
    object.integer("crc_extra", message.wire.crc_extra);
    object.key("fields");
    json_array(out, message.fields, [&](const auto& field) { json_field(out, field); });
    object.close();
    add(out, "\n");
}

void json_enum(fmt::memory_buffer& out, const Enum& e) {
    JsonObject object(out);
    object.text("kind", "enum");
    object.text("name", e.name);
    object.boolean("bitmask", e.bitmask);
    object.deprecation(e.deprecated);
    object.key("entries");
    json_array(out, e.entries, [&](const auto& entry) {
        JsonObject inner(out);
        add_entry_members(inner, entry);
        inner.close();
    });
    object.close();
    add(out, "\n");
}

void json_entry(fmt::memory_buffer& out, const Enum& owner, const EnumEntry& entry) {
    JsonObject object(out);
    object.text("kind", "entry");
    object.text("enum", owner.name);
    add_entry_members(object, entry);
    object.close();
    add(out, "\n");
}

std::string json_quoted(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        if (static_cast<unsigned char>(c) < 0x20) {
            out += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
        } else {
            out += c;
        }
    }
    return out + '"';
}

}  // namespace mavloom::app
