// SPDX-License-Identifier: MIT
// Derives a message's CRC_EXTRA from the checksum of a received frame. Pure functions; allocate nothing.
// The checksum covers everything between the start byte and the checksum, then the CRC_EXTRA byte.
// Source: MAVLink guide, "Packet Serialization".
#pragma once

#include "mavloom/wire/crc.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::wire {

// Returns the checksum over header and payload, without the CRC_EXTRA byte.
[[nodiscard]] inline std::uint16_t checksum_before_extra(const FrameView& frame) noexcept {
    return crc_update(crc_seed, frame.bytes().subspan(1, frame.header_length() - 1 + frame.payload_length()));
}

// Returns the CRC_EXTRA that makes the frame's checksum correct, or -1 if none does.
[[nodiscard]] inline int crc_extra_of(const FrameView& frame) noexcept {
    return crc_extra_between(checksum_before_extra(frame), frame.checksum());
}

}  // namespace mavloom::wire
