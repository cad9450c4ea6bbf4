// SPDX-License-Identifier: MIT
// Message definitions: what MAVLink's XML says, as immutable records with the computed wire layout. There is no global dialect: a process may
// hold several, and hands each parser and decoder the one it means. The built-in one lives in read-only tables of the binary; one loaded
// from XML owns its records. All members are const and safe from any thread; look-ups allocate nothing.
// Source: MAVLink guide, "MAVLink XML Schema" and "Packet Serialization".
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::dialect {

enum class FieldType : std::uint8_t { char8, u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };

[[nodiscard]] constexpr std::size_t size_of(FieldType type) noexcept {
    constexpr std::uint8_t sizes[] = {1, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return sizes[static_cast<std::size_t>(type)];
}

// Replaced or abandoned, as <deprecated> or <superseded> says. Empty `since` means: not deprecated.
struct Deprecation {
    std::string_view since;        // "2020-01"
    std::string_view replaced_by;  // a name, or empty
};

// A parameter of a MAV_CMD entry: what param1 to param7 of COMMAND_LONG, COMMAND_INT and MISSION_ITEM_INT mean for that command.
struct CommandParam {
    std::uint8_t index = 0;      // 1 to 7
    std::string_view label;      // "Radius"; empty where the definition gives none
    std::string_view units;      // "m"
    std::string_view enum_name;  // empty: a plain number
    std::string_view default_value;
    std::optional<double> minimum, maximum, increment;
    bool reserved = false;
};

struct EnumEntry {
    std::string_view name;  // "MAV_TYPE_QUADROTOR"
    std::uint64_t value = 0;
    std::span<const CommandParam> params;  // of MAV_CMD entries only, by rising index
    Deprecation deprecated;
};

struct Enum {
    std::string_view name;  // "MAV_TYPE"
    bool bitmask = false;
    std::span<const EnumEntry> entries;  // by rising value, merged over all files
    Deprecation deprecated;

    // Null where no entry has this value.
    [[nodiscard]] const EnumEntry* find(std::uint64_t value) const noexcept;
    [[nodiscard]] const EnumEntry* find(std::string_view entry_name) const noexcept;
};

struct Field {
    std::string_view name;
    FieldType type = FieldType::u8;
    std::uint8_t array_length = 0;  // 0: a scalar
    std::uint8_t offset = 0;        // bytes from the start of the full payload, in wire order
    bool extension = false;         // absent in MAVLink 1; not part of CRC_EXTRA
    bool instance = false;          // tells apart several sensors of one message
    bool bitmask = false;           // display="bitmask", or its enum is one
    std::string_view units;         // "rad/s"; empty for none
    std::string_view invalid;       // the XML's text for "no value": "UINT16_MAX", "NaN", "[0]"; empty for none
    double multiplier = 0;          // 0: none given
    const Enum* enumeration = nullptr;

    [[nodiscard]] bool is_array() const noexcept { return array_length != 0; }
    [[nodiscard]] bool is_text() const noexcept { return type == FieldType::char8 && is_array(); }
    [[nodiscard]] std::size_t count() const noexcept { return is_array() ? array_length : 1; }
    [[nodiscard]] std::size_t size() const noexcept { return count() * size_of(type); }
};

struct Message {
    std::string_view name;          // "ATTITUDE"
    wire::MessageInfo wire;         // id, CRC_EXTRA, lengths, target offsets
    std::span<const Field> fields;  // in the order of the definition, extensions last; `offset` gives the wire order
    std::string_view origin;        // the file that defines it: "common.xml"
    Deprecation deprecated;

    [[nodiscard]] MessageId id() const noexcept { return wire.id; }
    // Null for a name the message does not have.
    [[nodiscard]] const Field* find(std::string_view field_name) const noexcept;
};

// A field that was looked up once: from here on access is by offset.
struct FieldHandle {
    const Message* message = nullptr;
    const Field* field = nullptr;
};

class Dialect {
public:
    // Reads the XML file and everything it includes. Errors name file, line, what is wrong and what was expected.
    [[nodiscard]] static SetupResult<Dialect> load(const std::filesystem::path& xml);

    // The records must outlive the dialect (the built-in tables do). `messages` by rising id, `enums` by name.
    Dialect(std::string_view name, std::span<const Message> messages, std::span<const Enum> enums);

    [[nodiscard]] std::string_view name() const noexcept { return name_; }  // "all"
    [[nodiscard]] std::span<const Message> messages() const noexcept { return messages_; }
    [[nodiscard]] std::span<const Enum> enums() const noexcept { return enums_; }

    [[nodiscard]] const Message* find(MessageId id) const noexcept;
    [[nodiscard]] const Message* find(std::string_view message_name) const noexcept;
    [[nodiscard]] const Enum* find_enum(std::string_view enum_name) const noexcept;

    // What the parsers need. Lives as long as the dialect or any copy of it.
    [[nodiscard]] const wire::MessageTable& wire_table() const noexcept;

    // The message, or an error (`usage`) with the nearest name.
    [[nodiscard]] SetupResult<const Message*> message(std::string_view message_name) const;
    // "ATTITUDE.roll"; the error names the nearest message or field.
    [[nodiscard]] SetupResult<FieldHandle> field(std::string_view message_dot_field) const;

    // This dialect with `other` added; a message or enum entry of `other` replaces one of the same id or value here (`--dialect FILE`).
    // Too many messages together are an error (`bad_input`).
    [[nodiscard]] SetupResult<Dialect> with(const Dialect& other) const;

private:
    struct Index;    // hash tables by id and by name, and the wire table
    struct Storage;  // owns records read from XML; null for the built-in tables

    Dialect(std::string_view name, std::shared_ptr<const Storage> storage);

    std::string_view name_;
    std::span<const Message> messages_;
    std::span<const Enum> enums_;
    std::shared_ptr<const Storage> storage_;
    std::shared_ptr<const Index> index_;
};

// The definitions compiled into the binary: `all` of dialects/, everything it includes. Immutable.
[[nodiscard]] const Dialect& default_dialect();

}  // namespace mavloom::dialect
