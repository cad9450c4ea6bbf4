// SPDX-License-Identifier: MIT
// Sets of links as bits, one for each slot: 64 links a word. Private to module route.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace mavloom::route {

using Slot = std::uint32_t;  // where the engine keeps a link: below the number of links that were ever there at once
inline constexpr Slot no_slot = ~Slot{0};

using Words = std::uint64_t*;
using ConstWords = const std::uint64_t*;

inline bool has(ConstWords set, Slot slot) noexcept { return (set[slot / 64] >> (slot % 64) & 1) != 0; }
inline void insert(Words set, Slot slot) noexcept { set[slot / 64] |= std::uint64_t{1} << (slot % 64); }
inline void erase(Words set, Slot slot) noexcept { set[slot / 64] &= ~(std::uint64_t{1} << (slot % 64)); }

inline bool any(ConstWords set, std::size_t words) noexcept {
    std::uint64_t all = 0;
    for (std::size_t w = 0; w < words; ++w) all |= set[w];
    return all != 0;
}
inline bool intersect(ConstWords a, ConstWords b, std::size_t words) noexcept {
    std::uint64_t all = 0;
    for (std::size_t w = 0; w < words; ++w) all |= a[w] & b[w];
    return all != 0;
}
inline void assign(Words to, ConstWords from, std::size_t words) noexcept {
    for (std::size_t w = 0; w < words; ++w) to[w] = from[w];
}

// Calls f(slot) for every member, in rising order.
template <class F>
void each_in_word(std::uint64_t bits, Slot first, F&& f) {
    for (; bits != 0; bits &= bits - 1) f(first + static_cast<Slot>(std::countr_zero(bits)));
}
template <class F>
void each(ConstWords set, std::size_t words, F&& f) {
    for (std::size_t w = 0; w < words; ++w) each_in_word(set[w], static_cast<Slot>(64 * w), f);
}

}  // namespace mavloom::route
