// SPDX-License-Identifier: MIT
#include "layout.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "mavloom/wire/crc.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::dialect {
namespace {

// Orders base fields by descending type size, keeping definition order among equal sizes. Extension fields follow in
// definition order.
std::vector<Field*> wire_order(std::span<Field> fields) {
    std::vector<Field*> order;
    order.reserve(fields.size());
    for (auto& field : fields) order.push_back(&field);
    const auto first_extension = std::ranges::find_if(order, [](const Field* f) { return f->extension; });
    std::stable_sort(order.begin(), first_extension,
                     [](const Field* a, const Field* b) { return size_of(a->type) > size_of(b->type); });
    return order;
}

std::uint16_t add_text(std::uint16_t crc, std::string_view text) noexcept {
    for (const char c : text) crc = wire::crc_update(crc, static_cast<std::uint8_t>(c));
    return wire::crc_update(crc, std::uint8_t{' '});
}

std::uint8_t crc_extra(std::string_view message_name, std::span<Field* const> order) noexcept {
    auto crc = add_text(wire::crc_seed, message_name);
    for (const Field* field : order) {
        if (field->extension) break;
        crc = add_text(crc, type_name(field->type));
        crc = add_text(crc, field->name);
        if (field->is_array()) crc = wire::crc_update(crc, field->array_length);
    }
    return static_cast<std::uint8_t>((crc & 0xff) ^ (crc >> 8));
}

struct TargetName {
    std::string_view message;  // empty: any
    std::string_view field;
    std::uint8_t wire::MessageInfo::*offset;
};

constexpr TargetName target_names[] = {
    {"", "target_system", &wire::MessageInfo::target_system_offset},
    {"", "target_component", &wire::MessageInfo::target_component_offset},
    {"MANUAL_CONTROL", "target", &wire::MessageInfo::target_system_offset},
};

void note_target(wire::MessageInfo& info, std::string_view message_name, const Field& field) noexcept {
    if (field.type != FieldType::u8 || field.is_array()) return;
    for (const auto& target : target_names)
        if (field.name == target.field && (target.message.empty() || target.message == message_name))
            info.*target.offset = field.offset;
}

// Skips messages with a target: other systems send them, so their time is not the vehicle's clock.
void note_boot_time(wire::MessageInfo& info, std::span<const Field> fields) noexcept {
    if (info.target_system_offset != wire::MessageInfo::no_target) return;
    const auto found = std::ranges::find(fields, std::string_view("time_boot_ms"), &Field::name);
    if (found != fields.end() && found->type == FieldType::u32 && !found->is_array())
        info.boot_time_offset = found->offset;
}

}  // namespace

std::string_view type_name(FieldType type) noexcept {
    constexpr std::string_view names[] = {"char",    "uint8_t",  "int8_t",  "uint16_t", "int16_t", "uint32_t",
                                          "int32_t", "uint64_t", "int64_t", "float",    "double"};
    return names[static_cast<std::size_t>(type)];
}

std::size_t payload_size(std::span<const Field> fields) noexcept {
    std::size_t size = 0;
    for (const auto& field : fields) size += field.size();
    return size;
}

wire::MessageInfo lay_out(MessageId id, std::string_view message_name, std::span<Field> fields) {
    assert(payload_size(fields) <= wire::max_payload_length);
    wire::MessageInfo info;
    info.id = id;
    const auto order = wire_order(fields);
    std::size_t offset = 0;
    for (Field* field : order) {
        field->offset = static_cast<std::uint8_t>(offset);
        offset += field->size();
        if (!field->extension) info.min_length = static_cast<std::uint8_t>(offset);
        note_target(info, message_name, *field);
    }
    info.max_length = static_cast<std::uint8_t>(offset);
    note_boot_time(info, fields);
    info.crc_extra = crc_extra(message_name, order);
    return info;
}

}  // namespace mavloom::dialect
