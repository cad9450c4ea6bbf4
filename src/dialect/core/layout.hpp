// SPDX-License-Identifier: MIT
// The wire layout of a message, computed from its fields: order, offsets, lengths, CRC_EXTRA and where the target lies. Pure functions.
// Source: MAVLink guide, "Packet Serialization": "Field Reordering" and "CRC_EXTRA Calculation".
#pragma once

#include <span>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

// As the XML spells it: "uint8_t".
[[nodiscard]] std::string_view type_name(FieldType type) noexcept;

// Bytes of all fields together; may exceed what a frame can carry.
[[nodiscard]] std::size_t payload_size(std::span<const Field> fields) noexcept;

// Sets each field's offset and gives the message's wire facts. The caller has checked that the payload fits in 255 bytes.
[[nodiscard]] wire::MessageInfo lay_out(MessageId id, std::string_view message_name, std::span<Field> fields);

}  // namespace mavloom::dialect
