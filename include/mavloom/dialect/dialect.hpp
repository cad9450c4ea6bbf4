// SPDX-License-Identifier: MIT
// MAVLink message and enum definitions, as immutable records with the computed wire layout. There is no global dialect.
// A process can hold several dialects; it passes one to each parser and decoder. The records of the built-in dialect
// are read-only tables in the binary; a dialect loaded from XML owns its records. All members are const and safe from
// any thread. Look-ups allocate nothing; a failed `message` or `field` allocates its error text. Source: MAVLink guide,
// "MAVLink XML Schema" and "Packet Serialization".
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

// A <deprecated> or <superseded> element of the XML. An empty `since` means: not deprecated.
struct Deprecation {
    std::string_view since;        // "2020-01"
    std::string_view replaced_by;  // a name, or empty
};

// The meaning of one parameter of a MAV_CMD entry. COMMAND_LONG, COMMAND_INT, MISSION_ITEM and MISSION_ITEM_INT carry
// these parameters as param1 to param7.
struct CommandParam {
    std::uint8_t index = 0;      // 1 to 7
    std::string_view label;      // "Radius"; empty if the definition gives none
    std::string_view units;      // "m"
    std::string_view enum_name;  // empty: a plain number
    std::string_view default_value;
    std::optional<double> minimum, maximum, increment;
    bool reserved = false;
};

struct EnumEntry {
    std::string_view name;  // "MAV_TYPE_QUADROTOR"
    std::uint64_t value = 0;
    std::span<const CommandParam> params;  // only for entries of MAV_CMD, by ascending index
    Deprecation deprecated;
};

struct Enum {
    std::string_view name;  // "MAV_TYPE"
    bool bitmask = false;
    std::span<const EnumEntry> entries;  // by ascending value, merged from all files
    Deprecation deprecated;

    // Both return null if there is no such entry.
    [[nodiscard]] const EnumEntry* find(std::uint64_t value) const noexcept;
    [[nodiscard]] const EnumEntry* find(std::string_view entry_name) const noexcept;
};

struct Field {
    std::string_view name;
    FieldType type = FieldType::u8;
    std::uint8_t array_length = 0;  // 0: a scalar
    std::uint8_t offset = 0;        // in bytes from the start of the full payload
    bool extension = false;         // absent in MAVLink 1; not part of CRC_EXTRA
    bool instance = false;          // distinguishes several sensors that send the same message
    bool bitmask = false;           // display="bitmask", or its enum is a bitmask
    std::string_view units;         // "rad/s"; empty for none
    std::string_view invalid;       // the XML's text for "no value": "UINT16_MAX", "NaN", "[0]"; empty for none
    double multiplier = 0;          // 0 if the definition gives none
    const Enum* enumeration = nullptr;

    [[nodiscard]] bool is_array() const noexcept { return array_length != 0; }
    [[nodiscard]] bool is_text() const noexcept { return type == FieldType::char8 && is_array(); }
    [[nodiscard]] std::size_t count() const noexcept { return is_array() ? array_length : 1; }
    [[nodiscard]] std::size_t size() const noexcept { return count() * size_of(type); }
};

struct Message {
    std::string_view name;          // "ATTITUDE"
    wire::MessageInfo wire;         // id, CRC_EXTRA, lengths, target offsets
    std::span<const Field> fields;  // in definition order, extensions last; for wire order see Field::offset
    std::string_view origin;        // the file that defines it: "common.xml"
    Deprecation deprecated;

    [[nodiscard]] MessageId id() const noexcept { return wire.id; }
    // Returns null if the message has no such field.
    [[nodiscard]] const Field* find(std::string_view field_name) const noexcept;
};

// The result of looking up a field by name. Access through it needs no further look-up.
struct FieldHandle {
    const Message* message = nullptr;
    const Field* field = nullptr;
};

class Dialect {
public:
    // Reads an XML file and everything it includes. Errors give file, line, what is wrong and what was expected.
    [[nodiscard]] static SetupResult<Dialect> load(const std::filesystem::path& xml);

    // Does not copy the records. They must outlive the dialect, as the built-in tables do. `messages` must be sorted by
    // id, and `enums` by name.
    Dialect(std::string_view name, std::span<const Message> messages, std::span<const Enum> enums);

    [[nodiscard]] std::string_view name() const noexcept { return name_; }  // "all"
    [[nodiscard]] std::span<const Message> messages() const noexcept { return messages_; }
    [[nodiscard]] std::span<const Enum> enums() const noexcept { return enums_; }

    [[nodiscard]] const Message* find(MessageId id) const noexcept;
    [[nodiscard]] const Message* find(std::string_view message_name) const noexcept;
    [[nodiscard]] const Enum* find_enum(std::string_view enum_name) const noexcept;

    // The table for the parsers. Valid as long as this dialect or any copy of it exists.
    [[nodiscard]] const wire::MessageTable& wire_table() const noexcept;

    // Looks up a message by name. The error (`usage`) suggests the closest name.
    [[nodiscard]] SetupResult<const Message*> message(std::string_view message_name) const;
    // Looks up a field as "ATTITUDE.roll". The error (`usage`) suggests the closest message or field.
    [[nodiscard]] SetupResult<FieldHandle> field(std::string_view message_dot_field) const;

    // Returns this dialect extended by `other` (option `--dialect FILE`).
    // A message of `other` replaces one of the same id or name. An enum entry replaces one of the same value or name.
    // Too many messages in total are an error (`bad_input`).
    [[nodiscard]] SetupResult<Dialect> with(const Dialect& other) const;

private:
    struct Index;    // hash tables by id and by name, and the wire table
    struct Storage;  // owns records read from XML or merged; null for the built-in tables

    Dialect(std::string_view name, std::shared_ptr<const Storage> storage);

    std::string_view name_;
    std::span<const Message> messages_;
    std::span<const Enum> enums_;
    std::shared_ptr<const Storage> storage_;
    std::shared_ptr<const Index> index_;
};

// The definitions compiled into the binary: dialects/all.xml and everything that it includes.
[[nodiscard]] const Dialect& default_dialect();

}  // namespace mavloom::dialect
