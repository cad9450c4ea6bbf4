// SPDX-License-Identifier: MIT
// What one XML file says, before includes are merged: with the place of each statement, so that conflicts can name both.
// The strings live in the Records that the reader was given.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

struct Place {
    std::string_view file;
    std::size_t line = 0;
    [[nodiscard]] std::string text() const { return std::string(file) + ":" + std::to_string(line); }
};

struct FieldDefinition {
    Field field;  // offset and enumeration not yet known
    std::string_view enum_name;
    Place place;
};

struct MessageDefinition {
    std::string_view name;
    std::uint32_t id = 0;
    std::string_view origin;
    std::vector<FieldDefinition> fields;
    Deprecation deprecated;
    Place place;
};

struct EntryDefinition {
    std::string_view name;
    std::uint64_t value = 0;
    bool value_is_given = true;  // false: the next free one, and it may move when files are merged
    std::vector<CommandParam> params;
    Deprecation deprecated;
    Place place;
};

struct EnumDefinition {
    std::string_view name;
    bool bitmask = false;
    std::vector<EntryDefinition> entries;
    Deprecation deprecated;
    Place place;
    std::uint64_t lowest = 0, highest = 0;  // of the values in this file
};

struct IncludeDefinition {
    std::string_view path;  // relative to the file that includes
    Place place;
};

struct FileDefinitions {
    std::vector<IncludeDefinition> includes;
    std::vector<EnumDefinition> enums;
    std::vector<MessageDefinition> messages;
};

}  // namespace mavloom::dialect
