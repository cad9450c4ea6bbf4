// SPDX-License-Identifier: MIT
// What goes into a ring and comes out of it: opaque bytes with a few tags. Values; nothing allocates.
#pragma once

#include <cstdint>
#include <string_view>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::shm {

// What a writer says about a record. The ring itself looks at none of it.
struct RecordInfo {
    WallTime time{};           // when the bytes were received
    LinkId link{};             // where from; the counter page has its name
    std::uint16_t kind = 0;    // what the bytes are
    std::uint8_t verdict = 0;  // what the writer found out about them
};

struct RingRecord {
    ByteView data;  // until the next call of the reader
    RecordInfo info;
    std::uint64_t position = 0;  // in bytes since the ring was made
    std::uint64_t sequence = 0;  // in records since then
    std::uint64_t missed = 0;    // records that this reader was lapped by since the one before
};

// What a writer does when lossless readers hold the ring full.
enum class WhenFull : std::uint8_t {
    wait,         // for room, until the caller's deadline
    drop_newest,  // leave the new record out and count it
    evict,        // take the hold away from the readers in the way; they are told what they missed
};

enum class WriteError : std::uint8_t {
    too_long,  // the payload is longer than max_payload(); nothing was written
    full,      // readers hold the ring (until the deadline); nothing was written, and with drop_newest that was counted
    removed,   // the ring was removed or replaced: reopen
    forked,    // opened before fork() by the parent, whose writer it stays
};

enum class ReadError : std::uint8_t {
    empty,      // nothing more until the deadline
    no_writer,  // all is read, and no writer is alive; one may come back
    retired,    // all is read, and the ring was removed or replaced: open it by its name again
    damaged,    // what stands there is no record of this format, written by something else; close
    forked,     // opened before fork() by the parent, whose reader it stays
};

[[nodiscard]] std::string_view to_text(WriteError error) noexcept;
[[nodiscard]] std::string_view to_text(ReadError error) noexcept;
[[nodiscard]] std::string_view to_text(WhenFull policy) noexcept;

template <class T>
using WriteResult = Result<T, WriteError>;
template <class T>
using ReadResult = Result<T, ReadError>;

}  // namespace mavloom::shm
