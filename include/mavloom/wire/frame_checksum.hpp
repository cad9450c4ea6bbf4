// SPDX-License-Identifier: MIT
// What a frame's checksum says of its CRC_EXTRA. Pure functions; allocate nothing.
// Source: MAVLink guide, "Packet Serialization": the checksum covers all between start byte and checksum, then the CRC_EXTRA byte.
#pragma once

#include "mavloom/wire/crc.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::wire {

// Over header and payload, without the CRC_EXTRA byte.
[[nodiscard]] inline std::uint16_t checksum_before_extra(const FrameView& frame) noexcept {
    return crc_update(crc_seed, frame.bytes().subspan(1, frame.header_length() - 1 + frame.payload_length()));
}

// The CRC_EXTRA with which the frame's checksum is right, or -1 where there is none.
[[nodiscard]] inline int crc_extra_of(const FrameView& frame) noexcept {
    return crc_extra_between(checksum_before_extra(frame), frame.checksum());
}

}  // namespace mavloom::wire
