// SPDX-License-Identifier: MIT
// Limits for one turn: how many frames each kind of source may deliver, and whether copies are left out. Plain values.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mavloom::ring {

// How many frames one turn may deliver. Recordings, lossless rings and lossy rings each share one budget.
struct Room {
    explicit Room(std::size_t all) : recordings(all), lossless(all), lossy(all) {}
    Room(std::size_t r, std::size_t lossless_rings, std::size_t lossy_rings)
        : recordings(r), lossless(lossless_rings), lossy(lossy_rings) {}
    std::size_t recordings, lossless, lossy;
};

// Whether frames that the ring's router marked as a duplicate or an echo are delivered, or left out and counted.
enum class Copies : std::uint8_t { kept, left_out };

}  // namespace mavloom::ring
