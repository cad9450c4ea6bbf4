// SPDX-License-Identifier: MIT
// A ring as a file: made, opened and checked. What is read from it is copied before it is checked.
#pragma once

#include <functional>
#include <memory>

#include "mavloom/shm/layout.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "shm/segment.hpp"

namespace mavloom::shm {

inline constexpr std::size_t writer_byte = 0;  // whose lock the writer holds; slot n's is n + 1
[[nodiscard]] constexpr std::size_t slot_byte(unsigned slot) noexcept { return slot + 1; }

// Opens what is there and checks its identity. `not_found` lists the rings that there are.
[[nodiscard]] SetupResult<Segment> open_ring(std::string_view name, Segment::Access access);
// The words of a ring that open_ring() or writer_segment() gave.
[[nodiscard]] RingMemory<SharedWords> memory_of(const Segment& segment) noexcept;

// The ring to write to, its writer lock held: the one that is there, or a new one.
[[nodiscard]] SetupResult<Segment> writer_segment(std::string_view name, const RingOptions& options);

// Marks it and wakes all who sleep there: who reads it drains it and opens its name again, which must not lead here any longer.
void retire(const Segment& segment) noexcept;

[[nodiscard]] WallTime unix_time() noexcept;

}  // namespace mavloom::shm
