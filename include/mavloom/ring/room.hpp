// SPDX-License-Identifier: MIT
// How much a turn may hand over, and what is left out. Plain values.
#pragma once

#include <cstddef>
#include <cstdint>

namespace mavloom::ring {

// How many frames a turn may hand over: of the recordings together, of lossless rings together, of the other rings together.
struct Room {
    explicit Room(std::size_t all) : recordings(all), lossless(all), lossy(all) {}
    Room(std::size_t r, std::size_t lossless_rings, std::size_t lossy_rings)
        : recordings(r), lossless(lossless_rings), lossy(lossy_rings) {}
    std::size_t recordings, lossless, lossy;
};

// What the router of a ring marked as a duplicate or an echo: handed over, or left out and counted.
enum class Copies : std::uint8_t { kept, left_out };

}  // namespace mavloom::ring
