// SPDX-License-Identifier: MIT
// The tlog format's constants: a file is a row of records, each eight bytes of big-endian Unix microseconds and one whole MAVLink frame.
// Follows docs/formats/tlog.md.
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
// A time is plausible below this: the year 2255. It also fits WallTime, which ends in 2262.
inline constexpr std::uint64_t time_limit_us = std::uint64_t{1} << 53;

struct Record {
    WallTime time{};
    wire::FrameView frame;                    // points into the reader's buffer
    const wire::MessageInfo* info = nullptr;  // null: id without definition
    std::uint64_t offset = 0;                 // of the record, from the start of the file
    std::uint64_t lost_bytes = 0;             // damage skipped just before this record
};

}  // namespace mavloom::record
