// SPDX-License-Identifier: MIT
// Looks after rings: which there are, who is attached, how far behind, what was lost. Looking takes no slot and disturbs nobody. Any thread;
// allocates its results.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/shm/record.hpp"

namespace mavloom::shm {

// Names of the files that look like rings, sorted. Empty where the folder cannot be read.
[[nodiscard]] std::vector<std::string> ring_names();

struct ReaderStatus {
    unsigned slot = 0;
    std::uint32_t pid = 0;  // as the reader wrote it: in another PID namespace it means nothing here
    std::string program;
    WallTime opened{};
    bool lossless = false;
    bool holds = false;  // of a lossless one: false between an eviction and its next read
    bool asleep = false;
    std::uint64_t behind_bytes = 0;
    std::uint64_t behind_records = 0;
    std::uint64_t missed = 0;  // records that it was lapped by
};

struct RingStatus {
    std::string name;
    std::string path;
    std::string owner;
    unsigned mode = 0;
    std::uint64_t capacity = 0;  // bytes
    WallTime created{};
    bool retired = false;
    bool damaged = false;  // refused by readers and writers: what stands before its end are no records, and no number below means anything
    bool writer_alive = false;
    std::uint32_t writer_pid = 0;  // of the last writer; 0 when it closed cleanly
    WallTime writer_opened{};
    std::uint64_t writers = 0;  // so far
    WhenFull when_full = WhenFull::wait;
    std::uint64_t records = 0;  // since the ring was made
    std::uint64_t bytes = 0;    // likewise, with headers and padding
    std::uint64_t dropped = 0;
    std::uint64_t evictions = 0;
    std::vector<ReaderStatus> readers;  // that are alive
};

// One moment of a ring that may be in use. Errors as of RingReader::open.
[[nodiscard]] SetupResult<RingStatus> ring_status(std::string_view name);

// Takes a ring's name and its counter page's away. Who reads or writes it keeps what he has mapped and is told (retired, removed); nothing waits.
// `not_found` when neither is there; `permission` names the owner. What is no ring is removed as well, if the name fits.
[[nodiscard]] SetupResult<void> remove_ring(std::string_view name);
// The counter page alone; success when there is none.
[[nodiscard]] SetupResult<void> remove_counter_page(std::string_view name);

}  // namespace mavloom::shm
