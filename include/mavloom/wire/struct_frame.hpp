// SPDX-License-Identifier: MIT
// Frames of the generated message structs (mavloom/msg/*.hpp).
#pragma once

#include <array>
#include <cstdint>

#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::wire {

// The entry of a message table. It has no offsets of targets and clocks, because structs do not state them.
template <class Message>
inline constexpr MessageInfo info_of{.id = Message::id,
                                     .crc_extra = Message::crc_extra,
                                     .min_length = Message::min_length,
                                     .max_length = Message::max_length};

// As the other write_frame.
template <class Message>
[[nodiscard]] FrameView write_frame(FrameBuffer& out, const FrameHeader& header, const Message& message) noexcept {
    std::array<std::uint8_t, Message::max_length> payload;
    (void)message.encode(payload);
    return write_frame(out, header, info_of<Message>, payload);
}

}  // namespace mavloom::wire
