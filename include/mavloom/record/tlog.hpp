// SPDX-License-Identifier: MIT
// Constants of the tlog format (docs/formats/tlog.md). A file is a sequence of records. Each record is a time (Unix
// microseconds in eight bytes, big-endian), then one whole MAVLink frame.
#pragma once

#include <cstddef>
#include <cstdint>

#include "mavloom/base/clock.hpp"
#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"

namespace mavloom::record {

inline constexpr std::size_t time_length = 8;
inline constexpr std::size_t max_record_length = time_length + wire::max_frame_length;
inline constexpr std::size_t min_record_length = time_length + wire::min_frame_length;
// Times below this limit are plausible. The limit is in the year 2255, and WallTime ends in 2262.
inline constexpr std::uint64_t time_limit_us = std::uint64_t{1} << 53;

struct Record {
    WallTime time{};
    wire::FrameView frame;                    // points into the reader's buffer
    const wire::MessageInfo* info = nullptr;  // null if the message id has no definition
    std::uint64_t offset = 0;                 // of the record, from the start of the file
    std::uint64_t lost_bytes = 0;             // damage skipped just before this record
};

}  // namespace mavloom::record
