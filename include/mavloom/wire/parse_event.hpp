// SPDX-License-Identifier: MIT
// The events and counters of the parsers. Invalid input is reported as events and counted; it is never an error.
// Every input byte is counted once: bytes in = frame_bytes + flagged_bytes + junk_bytes + bytes still pending.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mavloom/base/counter.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::wire {

struct ParseEvent {
    enum class Kind : std::uint8_t {
        frame,  // a valid frame; `info` is null for an id without definition
        // A candidate in `frame` whose checksum is wrong. Its bytes are scanned again and end up in frames or junk.
        bad_checksum,
        // `bytes` bytes that belong to no frame. Reported when the run of junk ends, after every 4,096 bytes of it, and
        // when the caller asks (StreamParser::report_junk).
        junk,
        // A frame with a valid checksum and an unknown incompatibility flag. The specification forbids handling it.
        unknown_flags,
    };
    Kind kind = Kind::junk;
    FrameView frame;  // valid only during the call
    const MessageInfo* info = nullptr;
    std::size_t bytes = 0;  // for `junk` only
};

struct ParseCounters {
    Counter frames, frame_bytes;
    Counter unknown_ids;    // those of `frames` whose id has no definition
    Counter crc_error;      // bad_checksum events
    Counter unknown_flags;  // unknown_flags events
    Counter flagged_bytes;  // bytes in unknown_flags events
    Counter junk_bytes;
    // Candidates without definition that were rejected because of the bytes around them (see unknown_ids.hpp).
    Counter implausible_unknown;
};

}  // namespace mavloom::wire
