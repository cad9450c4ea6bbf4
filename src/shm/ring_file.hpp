// SPDX-License-Identifier: MIT
// Creates, opens and checks ring files. Private to module shm. Header data is copied before it is checked, because
// other processes may change it. Any thread.
#pragma once

#include <cassert>
#include <functional>
#include <memory>

#include "mavloom/shm/layout.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "shm/segment.hpp"

namespace mavloom::shm {

inline constexpr std::size_t writer_byte = 0;  // the writer holds the lock on this byte; slot n uses byte n + 1
[[nodiscard]] constexpr std::size_t slot_byte(unsigned slot) noexcept {
    assert(slot < reader_slots);
    return slot + 1;
}

// Opens an existing ring: first checks its owner and mode by `check`, then its identity, before anything reads it
// through the mapping. `not_found` lists the rings that exist.
[[nodiscard]] SetupResult<Segment> open_ring(std::string_view name, Segment::Access access, const Segment::Check& check);
// Returns pointers into a ring that open_ring() or writer_segment() returned.
[[nodiscard]] RingMemory<SharedWords> memory_of(const Segment& segment) noexcept;

// Returns the ring to write to, existing or new, with its writer lock held. If `options.sets_aside` made it rename a
// file, stores the reason in `set_aside`.
[[nodiscard]] SetupResult<Segment> writer_segment(std::string_view name, const RingOptions& options,
                                                  std::string* set_aside = nullptr);

// Marks a ring as retired and wakes everything that sleeps on it. Readers then drain the ring and reopen its name, so
// remove the name first.
void retire(const Segment& segment) noexcept;

[[nodiscard]] WallTime unix_time() noexcept;

}  // namespace mavloom::shm
