// SPDX-License-Identifier: MIT
// Types that ring writers and readers share: a record, which is opaque bytes with a few tags, and the error codes.
// Plain values; nothing allocates.
#pragma once

#include <cstdint>
#include <string_view>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::shm {

// The writer's tags for a record. The ring itself does not interpret them.
struct RecordInfo {
    WallTime time{};           // when the bytes were received
    LinkId link{};             // the source link; the counter page has its name
    std::uint16_t kind = 0;    // what the bytes are
    std::uint8_t verdict = 0;  // what the writer decided about the bytes
};

struct RingRecord {
    ByteView data;  // valid until the next call to the reader
    RecordInfo info;
    std::uint64_t position = 0;  // bytes since the ring was created
    std::uint64_t sequence = 0;  // records since the ring was created
    std::uint64_t missed = 0;    // records that this reader missed directly before this one
};

// The behaviour of a writer when lossless readers block the ring.
enum class WhenFull : std::uint8_t {
    wait,         // wait for room, until the caller's deadline
    drop_newest,  // drop the new record and count it
    evict,        // remove the holds of the blocking readers; their next record reports how many they missed
};

enum class WriteError : std::uint8_t {
    too_long,  // the payload exceeds max_payload(); nothing was written
    // Readers blocked the ring until the deadline. Nothing was written; drop_newest counted the record as dropped.
    full,
    removed,  // the ring was removed or replaced; reopen it
    forked,   // the parent opened the writer before fork(); the child cannot use it
};

enum class ReadError : std::uint8_t {
    empty,      // no record until the deadline
    no_writer,  // all records are read and no writer is alive; another may come
    retired,    // all records are read and the ring was removed or replaced; open it by name again
    damaged,    // the data is not a record of this format: something else wrote it; close the reader
    forked,     // the parent opened the reader before fork(); the child cannot use it
};

[[nodiscard]] std::string_view to_text(WriteError error) noexcept;
[[nodiscard]] std::string_view to_text(ReadError error) noexcept;
[[nodiscard]] std::string_view to_text(WhenFull policy) noexcept;

template <class T>
using WriteResult = Result<T, WriteError>;
template <class T>
using ReadResult = Result<T, ReadError>;

}  // namespace mavloom::shm
