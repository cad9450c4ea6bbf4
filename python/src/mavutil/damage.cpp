// SPDX-License-Identifier: MIT
#include "mavutil/damage.hpp"

#include <fmt/format.h>

#include "mavloom/wire/frame_checksum.hpp"

namespace mavloom::python {

std::string crc_reason(const wire::FrameView& frame, const dialect::Message* definition) {
    const auto before = wire::checksum_before_extra(frame);
    const auto expected = definition == nullptr ? before : wire::crc_update(before, definition->wire.crc_extra);
    return fmt::format("invalid MAVLink CRC in msgID {} 0x{:04x} should be 0x{:04x}", frame.id().value,
                       frame.checksum(), expected);
}

}  // namespace mavloom::python
