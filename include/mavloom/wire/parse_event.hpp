// SPDX-License-Identifier: MIT
// What the parsers report. Bad bytes are events and counters, never errors (DESIGN.md rule 5). Every byte that goes in is counted once:
// bytes in = frame_bytes + flagged_bytes + junk_bytes + what is still pending.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mavloom/base/counter.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::wire {

struct ParseEvent {
    enum class Kind : std::uint8_t {
        frame,  // good: `frame`, `info` (null for an id without definition)
        bad_checksum,  // something that began and was as long as a frame: `frame`; its bytes are scanned again and end as frames or junk
        junk,  // `bytes` bytes that belong to no frame; a run is reported when it ends, or each 4,096 bytes of it
        unknown_flags,  // a whole frame with a good checksum and an incompatibility flag that is not defined: must not be handled
    };
    Kind kind = Kind::junk;
    FrameView frame;  // valid during the call
    const MessageInfo* info = nullptr;
    std::size_t bytes = 0;  // of junk
};

struct ParseCounters {
    Counter frames, frame_bytes;
    Counter unknown_ids;    // of `frames`: without definition
    Counter crc_error;      // bad_checksum events
    Counter unknown_flags;  // unknown_flags events
    Counter flagged_bytes;  // their bytes
    Counter junk_bytes;
    Counter implausible_unknown;  // ids without definition refused for their surroundings (routing.md 5.4)
};

}  // namespace mavloom::wire
