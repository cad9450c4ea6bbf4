// SPDX-License-Identifier: MIT
// Recognizes records in the bytes of a tlog. Pure functions over untrusted bytes. Private to module record.
#pragma once

#include "mavloom/base/bytes.hpp"
#include "mavloom/record/tlog.hpp"

namespace mavloom::record {

struct Found {
    enum class Kind : std::uint8_t {
        nothing,        // no record begins here
        record,         // a plausible time and an intact frame
        unknown_flags,  // like `record`, but the frame has an incompatibility flag that is not defined
    };
    Kind kind = Kind::nothing;
    std::size_t size = 0;  // of the whole record
    const wire::MessageInfo* info = nullptr;
};

// Examines the start of `bytes`, which must hold the rest of the file or at least two records of the maximum length.
[[nodiscard]] Found examine_record(ByteView bytes, const wire::MessageTable& table) noexcept;

// Returns how many bytes at the front cannot begin a record. A record begins with a plausible time, directly followed
// by a start byte. The result never includes the last eight bytes.
[[nodiscard]] std::size_t skip_startless(ByteView bytes) noexcept;

// How many bytes of a file `begins_recording` looks at.
inline constexpr std::size_t recording_bytes = 65536;

// Returns whether the first bytes of a file are those of a tlog, which may be damaged or cut off. True also if all
// bytes are 0, because a power failure leaves such files. Examines times and headers only.
[[nodiscard]] bool begins_recording(ByteView first_bytes) noexcept;

// Returns the length of the record at the front, from its header alone, or 0 if `bytes` does not hold all of it.
[[nodiscard]] std::size_t record_length(ByteView bytes) noexcept;

struct Joined {
    std::size_t length = 0;  // of the whole record; 0 if the record must be examined
    MessageId id{};
    std::uint64_t time_us = 0;
};

// Recognizes a record that plausibly follows the previous one, without checking its checksum. Its time must be within a
// day of `before_us`, the time of the previous record. Its message id must be known. Its frame must have no undefined
// flag, and its payload must not be longer than the definition. `record` must point to at least max_record_length
// bytes.
//
// For speed, each call in a loop depends on the previous one only through the returned length. Version and flags are
// therefore tested with branches, which the processor predicts.
[[nodiscard]] inline Joined joined_record(const std::uint8_t* record, std::uint64_t before_us,
                                          const wire::MessageTable& table) noexcept {
    constexpr std::uint64_t day_us = 86'400'000'000;
    const auto* const frame = record + time_length;
    const std::size_t payload_length = frame[1];
    std::size_t length = time_length + payload_length;
    MessageId id;
    if (frame[0] == wire::stx_v2) [[likely]] {
        length += wire::header_length_v2 + wire::checksum_length;
        if (frame[2] != 0) [[unlikely]] {
            if (frame[2] != wire::incompat_signed) return {};
            length += wire::signature_length;
        }
        id = MessageId{load_le<std::uint32_t>(frame + 6) >> 8};
    } else {
        if (frame[0] != wire::stx_v1) return {};
        length += wire::min_frame_length;
        id = MessageId{frame[5]};
    }
    const auto time_us = load_be64(record);
    const auto* const info = table.find(id);
    if (info == nullptr || payload_length > info->max_length || time_us - before_us + day_us > 2 * day_us) return {};
    return {length, id, time_us};
}

}  // namespace mavloom::record
