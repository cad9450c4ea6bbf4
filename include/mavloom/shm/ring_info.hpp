// SPDX-License-Identifier: MIT
// Lists, inspects and removes rings: their writer, readers, lag and losses.
//
// Inspecting a ring takes no reader slot and does not affect its users. Any thread may call these functions. They
// allocate their results.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/shm/record.hpp"

namespace mavloom::shm {

// Returns the names of all files that look like rings, sorted. Empty if /dev/shm cannot be read.
[[nodiscard]] std::vector<std::string> ring_names();
// The same for counter pages.
[[nodiscard]] std::vector<std::string> counter_page_names();

struct ReaderStatus {
    unsigned slot = 0;
    std::uint32_t pid = 0;  // as stored by the reader; meaningless across PID namespaces
    std::string program;
    WallTime opened{};
    bool lossless = false;
    bool holds = false;  // false for a lossless reader between an eviction and its next read
    bool asleep = false;
    std::uint64_t behind_bytes = 0;
    std::uint64_t behind_records = 0;
    std::uint64_t missed = 0;  // records that it missed because the writer lapped it
};

struct RingStatus {
    std::string name;
    std::string path;
    std::string owner;
    unsigned mode = 0;
    std::uint64_t capacity = 0;  // bytes
    WallTime created{};
    bool retired = false;
    // The data before the end of the ring does not consist of valid records. Readers and writers reject such a ring.
    // All fields below are meaningless.
    bool damaged = false;
    bool writer_alive = false;
    std::uint32_t writer_pid = 0;  // of the last writer; 0 after a clean close
    WallTime writer_opened{};
    std::uint64_t writers = 0;  // number of writers so far
    WhenFull when_full = WhenFull::wait;
    std::uint64_t records = 0;  // since the ring was created
    std::uint64_t bytes = 0;    // since the ring was created, including headers and padding
    std::uint64_t dropped = 0;
    std::uint64_t evictions = 0;
    std::vector<ReaderStatus> readers;  // only those that are alive
};

// Reads the state of a ring that may be in use. Same errors as RingReader::open. In a program that does not survive
// lost mappings (lost_mapping.hpp), it also returns `permission` for rings that Trust{} refuses.
[[nodiscard]] SetupResult<RingStatus> ring_status(std::string_view name);

// Removes the names of a ring and of its counter page. Processes that have the ring mapped keep their mapping. Its
// readers then get `retired`, its writer `removed`. Never waits. A file under that name which is not a ring is removed
// too. So is a ring that ring_status() refuses; its users are not notified. Errors: `not_found` if neither file exists;
// `permission` names the owner.
[[nodiscard]] SetupResult<void> remove_ring(std::string_view name);
// Removes only the counter page. Succeeds if there is none.
[[nodiscard]] SetupResult<void> remove_counter_page(std::string_view name);

}  // namespace mavloom::shm
