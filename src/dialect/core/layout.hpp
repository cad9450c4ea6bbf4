// SPDX-License-Identifier: MIT
// Computes the wire layout of a message from its fields: order, offsets, lengths, CRC_EXTRA, and target and clock
// offsets. Pure functions; `lay_out` allocates temporarily.
// Source: MAVLink guide, "Packet Serialization": "Field Reordering" and "CRC_EXTRA Calculation".
#pragma once

#include <span>
#include <string_view>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::dialect {

// The name of the type in XML: "uint8_t".
[[nodiscard]] std::string_view type_name(FieldType type) noexcept;

// The size of all fields together, in bytes. It may be more than a frame can carry.
[[nodiscard]] std::size_t payload_size(std::span<const Field> fields) noexcept;

// Sets each field's offset and returns the wire info of the message. The caller must have checked that the payload fits
// in 255 bytes.
[[nodiscard]] wire::MessageInfo lay_out(MessageId id, std::string_view message_name, std::span<Field> fields);

}  // namespace mavloom::dialect
