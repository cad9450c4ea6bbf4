// SPDX-License-Identifier: MIT
#include "file_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>

#include "mavloom/base/suggest.hpp"
#include "mavloom/base/text.hpp"
#include "mavloom/wire/frame.hpp"
#include "values.hpp"

namespace mavloom::dialect {
namespace {

constexpr std::size_t max_fields = 64;  // MAVLink's limit for one message
constexpr std::uint64_t highest_id = 0xff'ffff;

// Makes text from the file safe to print in an error message.
std::string_view shown(std::string_view text) {
    constexpr std::size_t longest = 100;
    if (!is_printable(text)) return "(unprintable)";
    return text.size() > longest ? "(too long)" : text;
}

// Every read_… function returns false after it has stored the first error.
class FileReader {
public:
    FileReader(const SourceFile& file, Records& records)
        : file_(file),
          records_(records),
          path_(records.intern(file.shown())),
          origin_(records.intern(std::filesystem::path(file.shown()).filename().string())) {}

    SetupResult<FileDefinitions> read() {
        if (!read_root(file_.root())) return tl::unexpected(std::move(error_));
        return std::move(out_);
    }

private:
    using Node = pugi::xml_node;

    SourceLocation location_of(Node node) const { return {path_, file_.line_of(node)}; }

    bool fail(Node node, std::string_view what) {
        error_ = {SetupCode::bad_input, 0, fmt::format("{}:{}: {}", path_, file_.line_of(node), what)};
        return false;
    }

    bool fail_unknown(Node node, Node parent, std::initializer_list<std::string_view> known) {
        return fail(node, fmt::format("unknown element <{}> in <{}>{}; expected one of {}", shown(node.name()),
                                      parent.name(), did_you_mean(node.name(), known), fmt::join(known, ", ")));
    }

    bool read_root(Node root);
    bool read_include(Node node);
    bool read_enum(Node node);
    bool read_entry(Node node, EnumDefinition& owner);
    bool read_entry_value(Node node, EnumDefinition& owner, EntryDefinition& entry);
    bool read_param(Node node, EntryDefinition& owner);
    bool read_message(Node node);
    bool read_field(Node node, bool extension, MessageDefinition& owner);
    bool read_field_type(Node node, Field& field);
    bool check_message(Node node, const MessageDefinition& message);
    bool read_deprecation(Node node, Deprecation& out);

    bool required_word(Node node, const char* attribute, std::string_view& out);
    bool text(Node node, const char* attribute, std::string_view& out);
    bool flag(Node node, const char* attribute, bool& out);
    bool number(Node node, const char* attribute, std::optional<double>& out);

    const SourceFile& file_;
    Records& records_;
    std::string_view path_, origin_;
    FileDefinitions out_;
    SetupError error_;
};

bool is_ignored(pugi::xml_node node) {
    if (node.type() != pugi::node_element) return true;
    const std::string_view name = node.name();
    return name == "description" || name == "wip";
}

bool is_deprecation(pugi::xml_node node) {
    const std::string_view name = node.name();
    return name == "deprecated" || name == "superseded";
}

bool FileReader::read_root(Node root) {
    if (std::strcmp(root.name(), "mavlink") != 0) {
        return fail(root, fmt::format("the outermost element is <{}>; expected <mavlink>", shown(root.name())));
    }
    for (const auto node : root.children()) {
        const std::string_view name = node.name();
        if (is_ignored(node) || name == "version" || name == "dialect") continue;
        if (name == "include") {
            if (!read_include(node)) return false;
            continue;
        }
        if (name != "enums" && name != "messages") {
            return fail_unknown(node, root, {"include", "version", "dialect", "enums", "messages"});
        }
        const std::string_view wanted = name == "enums" ? "enum" : "message";
        for (const auto child : node.children()) {
            if (is_ignored(child)) continue;
            if (child.name() != wanted) return fail_unknown(child, node, {wanted});
            if (!(name == "enums" ? read_enum(child) : read_message(child))) return false;
        }
    }
    return true;
}

bool FileReader::read_include(Node node) {
    const auto path = trimmed(node.text().get());
    if (path.empty() || !is_printable(path)) return fail(node, "empty <include>; expected the name of an XML file");
    out_.includes.push_back({records_.intern(path), location_of(node)});
    return true;
}

bool FileReader::read_enum(Node node) {
    EnumDefinition definition;
    definition.location = location_of(node);
    if (!required_word(node, "name", definition.name) || !flag(node, "bitmask", definition.bitmask)) return false;
    for (const auto child : node.children()) {
        if (is_ignored(child)) continue;
        if (is_deprecation(child)) {
            if (!read_deprecation(child, definition.deprecated)) return false;
        } else if (std::strcmp(child.name(), "entry") == 0) {
            if (!read_entry(child, definition)) return false;
        } else {
            return fail_unknown(child, node, {"description", "deprecated", "superseded", "wip", "entry"});
        }
    }
    out_.enums.push_back(std::move(definition));
    return true;
}

bool FileReader::read_entry(Node node, EnumDefinition& owner) {
    EntryDefinition entry;
    entry.location = location_of(node);
    if (!required_word(node, "name", entry.name) || !read_entry_value(node, owner, entry)) return false;
    for (const auto child : node.children()) {
        if (is_ignored(child)) continue;
        if (is_deprecation(child)) {
            if (!read_deprecation(child, entry.deprecated)) return false;
        } else if (std::strcmp(child.name(), "param") == 0) {
            if (!read_param(child, entry)) return false;
        } else {
            return fail_unknown(child, node, {"description", "deprecated", "superseded", "wip", "param"});
        }
    }
    std::ranges::sort(entry.params, {}, &CommandParam::index);
    owner.entries.push_back(std::move(entry));
    return true;
}

// The value for an entry without one: the highest value so far plus 1, so at least 1. Empty if there is none left.
std::optional<std::uint64_t> next_value(const EnumDefinition& owner) {
    if (owner.highest == UINT64_MAX) return std::nullopt;
    return owner.highest + 1;
}

bool FileReader::read_entry_value(Node node, EnumDefinition& owner, EntryDefinition& entry) {
    const auto given = node.attribute("value");
    entry.value_is_given = !given.empty();
    const auto value = given.empty() ? next_value(owner) : parse_unsigned(given.value());
    if (!value) {
        return fail(node,
                    fmt::format("value \"{}\" of {}; expected a number from 0 to 2**64-1: decimal, 0x…, 0b… or 2**n",
                                shown(given.value()), entry.name));
    }
    entry.value = *value;
    owner.lowest = owner.entries.empty() ? entry.value : std::min(owner.lowest, entry.value);
    owner.highest = std::max(owner.highest, entry.value);
    return true;
}

bool FileReader::read_param(Node node, EntryDefinition& owner) {
    CommandParam param;
    const auto index = parse_unsigned(node.attribute("index").value());
    if (!index || *index < 1 || *index > 7) {
        return fail(node,
                    fmt::format("index \"{}\" of a <param>; expected 1 to 7", shown(node.attribute("index").value())));
    }
    param.index = static_cast<std::uint8_t>(*index);
    if (std::ranges::find(owner.params, param.index, &CommandParam::index) != owner.params.end()) {
        return fail(node, fmt::format("a second <param> with index {} in {}", param.index, owner.name));
    }
    const bool good = text(node, "label", param.label) && text(node, "units", param.units) &&
                      text(node, "enum", param.enum_name) && text(node, "default", param.default_value) &&
                      number(node, "minValue", param.minimum) && number(node, "maxValue", param.maximum) &&
                      number(node, "increment", param.increment) && flag(node, "reserved", param.reserved);
    if (good) owner.params.push_back(param);
    return good;
}

bool FileReader::read_message(Node node) {
    MessageDefinition message;
    message.location = location_of(node);
    message.origin = origin_;
    if (!required_word(node, "name", message.name)) return false;
    const auto id = parse_unsigned(node.attribute("id").value());
    if (!id || *id > highest_id) {
        return fail(node, fmt::format("id \"{}\" of message {}; expected 0 to {}", shown(node.attribute("id").value()),
                                      message.name, highest_id));
    }
    message.id = static_cast<std::uint32_t>(*id);
    bool extension = false;
    for (const auto child : node.children()) {
        const std::string_view name = child.name();
        if (is_ignored(child)) continue;
        if (is_deprecation(child)) {
            if (!read_deprecation(child, message.deprecated)) return false;
        } else if (name == "field") {
            if (!read_field(child, extension, message)) return false;
        } else if (name == "extensions") {
            if (extension) return fail(child, fmt::format("a second <extensions/> in message {}", message.name));
            extension = true;
        } else {
            return fail_unknown(child, node, {"description", "deprecated", "superseded", "wip", "field", "extensions"});
        }
    }
    if (!check_message(node, message)) return false;
    out_.messages.push_back(std::move(message));
    return true;
}

bool FileReader::read_field(Node node, bool extension, MessageDefinition& owner) {
    FieldDefinition definition;
    auto& field = definition.field;
    definition.location = location_of(node);
    field.extension = extension;
    std::string_view display;
    std::optional<double> multiplier;
    const bool good = required_word(node, "name", field.name) && read_field_type(node, field) &&
                      text(node, "units", field.units) && text(node, "invalid", field.invalid) &&
                      text(node, "enum", definition.enum_name) && text(node, "display", display) &&
                      flag(node, "instance", field.instance) && number(node, "multiplier", multiplier);
    if (!good) return false;
    field.bitmask = display == "bitmask";
    field.multiplier = multiplier.value_or(0);
    const auto same = std::ranges::find(owner.fields, field.name, [](const auto& f) { return f.field.name; });
    if (same != owner.fields.end()) {
        return fail(node, fmt::format("message {} has a field '{}' already, at line {}", owner.name, field.name,
                                      same->location.line));
    }
    owner.fields.push_back(definition);
    return true;
}

bool FileReader::read_field_type(Node node, Field& field) {
    const auto given = node.attribute("type");
    const auto type = parse_type(given.value());
    if (!type) {
        return fail(node,
                    fmt::format("type \"{}\" of field '{}'; expected char, int8_t to int64_t, uint8_t to uint64_t, "
                                "float or double, an array as type[n]",
                                shown(given.value()), field.name));
    }
    if (type->array_length > wire::max_payload_length) {
        return fail(node, fmt::format("field '{}' has {} elements; expected at most {}", field.name, type->array_length,
                                      wire::max_payload_length));
    }
    field.type = type->type;
    field.array_length = static_cast<std::uint8_t>(type->array_length);
    return true;
}

bool FileReader::check_message(Node node, const MessageDefinition& message) {
    if (message.fields.empty()) {
        return fail(node, fmt::format("message {} has no field; expected at least one", message.name));
    }
    if (message.fields.size() > max_fields) {
        return fail(node, fmt::format("message {} has {} fields; expected at most {}", message.name,
                                      message.fields.size(), max_fields));
    }
    std::size_t bytes = 0;
    for (const auto& definition : message.fields) bytes += definition.field.size();
    if (bytes > wire::max_payload_length) {
        return fail(node, fmt::format("message {} has a payload of {} bytes; expected at most {}", message.name, bytes,
                                      wire::max_payload_length));
    }
    return true;
}

bool FileReader::read_deprecation(Node node, Deprecation& out) {
    if (!text(node, "since", out.since) || !text(node, "replaced_by", out.replaced_by)) return false;
    if (!out.since.empty()) return true;
    return fail(node, fmt::format("<{}> without a date; expected since=\"YYYY-MM\"", node.name()));
}

bool FileReader::required_word(Node node, const char* attribute, std::string_view& out) {
    const auto given = node.attribute(attribute);
    if (given.empty())
        return fail(node, fmt::format("<{}> without {}; expected {}=\"…\"", node.name(), attribute, attribute));
    if (!is_word(given.value())) {
        return fail(node, fmt::format("{} \"{}\" of a <{}>; expected letters, digits and underscores, at most 100",
                                      attribute, shown(given.value()), node.name()));
    }
    out = records_.intern(given.value());
    return true;
}

bool FileReader::text(Node node, const char* attribute, std::string_view& out) {
    const std::string_view given = node.attribute(attribute).value();
    if (!is_printable(given)) {
        return fail(node, fmt::format("{} of a <{}> holds control characters or is not UTF-8; expected plain text",
                                      attribute, node.name()));
    }
    out = records_.intern(given);
    return true;
}

bool FileReader::flag(Node node, const char* attribute, bool& out) {
    const auto given = node.attribute(attribute);
    if (given.empty()) return true;
    const auto value = parse_bool(given.value());
    if (!value) return fail(node, fmt::format("{}=\"{}\"; expected true or false", attribute, shown(given.value())));
    out = *value;
    return true;
}

bool FileReader::number(Node node, const char* attribute, std::optional<double>& out) {
    const auto given = node.attribute(attribute);
    if (given.empty()) return true;
    out = parse_number(given.value());
    return out.has_value() || fail(node, fmt::format("{}=\"{}\"; expected a number", attribute, shown(given.value())));
}

}  // namespace

SetupResult<FileDefinitions> read_definitions(const SourceFile& file, Records& records) {
    return FileReader(file, records).read();
}

}  // namespace mavloom::dialect
