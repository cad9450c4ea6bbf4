// SPDX-License-Identifier: MIT
// The definitions of one XML file before includes are merged. Each has its file and line, so that errors can show both
// sides of a conflict. The Records passed to the reader own the strings.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

struct SourceLocation {
    std::string_view file;
    std::size_t line = 0;
    [[nodiscard]] std::string text() const { return std::string(file) + ":" + std::to_string(line); }
};

struct FieldDefinition {
    Field field;  // offset and enumeration are not set yet
    std::string_view enum_name;
    SourceLocation location;
};

struct MessageDefinition {
    std::string_view name;
    std::uint32_t id = 0;
    std::string_view origin;
    std::vector<FieldDefinition> fields;
    Deprecation deprecated;
    SourceLocation location;
};

struct EntryDefinition {
    std::string_view name;
    std::uint64_t value = 0;
    bool value_is_given = true;  // false: assigned the next free value, which may change when files are merged
    std::vector<CommandParam> params;
    Deprecation deprecated;
    SourceLocation location;
};

struct EnumDefinition {
    std::string_view name;
    bool bitmask = false;
    std::vector<EntryDefinition> entries;
    Deprecation deprecated;
    SourceLocation location;
    std::uint64_t lowest = 0, highest = 0;  // of the values in this file
};

struct IncludeDefinition {
    std::string_view path;  // relative to the including file
    SourceLocation location;
};

struct FileDefinitions {
    std::vector<IncludeDefinition> includes;
    std::vector<EnumDefinition> enums;
    std::vector<MessageDefinition> messages;
};

}  // namespace mavloom::dialect
