// SPDX-License-Identifier: MIT
// What stands at a position of a tlog. Pure functions over untrusted bytes; private to module record.
#pragma once

#include "mavloom/base/bytes.hpp"
#include "mavloom/record/tlog.hpp"

namespace mavloom::record {

struct Found {
    enum class Kind : std::uint8_t {
        nothing,        // no record begins here
        record,         // a plausible time and an intact frame
        unknown_flags,  // the same, but with an incompatibility flag that is not defined
    };
    Kind kind = Kind::nothing;
    std::size_t size = 0;  // of the whole record
    const wire::MessageInfo* info = nullptr;
};

// `bytes` begins at the position in question and holds all that is left of the file, or at least two longest records.
[[nodiscard]] Found examine_record(ByteView bytes, const wire::MessageTable& table) noexcept;

// How many bytes at the front cannot begin a record: no start byte stands where it would have to, or no plausible time before it. All but the last
// eight at most.
[[nodiscard]] std::size_t skip_startless(ByteView bytes) noexcept;

// The length of the record at the front, by its header alone; 0 where `bytes` does not hold it whole.
[[nodiscard]] std::size_t record_length(ByteView bytes) noexcept;

struct Joined {
    std::size_t length = 0;  // of the whole record; 0 where it has to be examined
    MessageId id{};
    std::uint64_t time_us = 0;
};

// A record that another one can be told to follow without looking at its checksum: its time is within a day of `before_us`, its id is known, and its
// frame has no undefined flag and is not longer than its definition. `record` has room for the longest.
//
// One of these waits for the length that the one before it gave, and nothing else: so version and flags are branches, which the processor foresees.
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
