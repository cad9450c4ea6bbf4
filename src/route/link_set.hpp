// SPDX-License-Identifier: MIT
// Sets of links as bit sets, with one bit per slot and 64 slots per word. Private to module route.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace mavloom::route {

using Slot = std::uint32_t;  // the engine's index of a link; free slots are reused, so slots stay small
inline constexpr Slot no_slot = ~Slot{0};

using Words = std::uint64_t*;
using ConstWords = const std::uint64_t*;

inline bool has(ConstWords set, Slot slot) noexcept { return (set[slot / 64] >> (slot % 64) & 1) != 0; }
inline void insert(Words set, Slot slot) noexcept { set[slot / 64] |= std::uint64_t{1} << (slot % 64); }
inline void erase(Words set, Slot slot) noexcept { set[slot / 64] &= ~(std::uint64_t{1} << (slot % 64)); }

// Calls f(w) for every word. Optimized for one word, that is up to 64 links.
template <class F>
[[gnu::always_inline]] inline void each_word(std::size_t words, F&& f) {
    if (words == 1) [[likely]] {
        f(std::size_t{0});
        return;
    }
    for (std::size_t w = 0; w < words; ++w) f(w);
}

inline bool any(ConstWords set, std::size_t words) noexcept {
    std::uint64_t all = 0;
    each_word(words, [&](std::size_t w) { all |= set[w]; });
    return all != 0;
}
// Whether the set has a member other than this one.
inline bool has_other(ConstWords set, Slot slot, std::size_t words) noexcept {
    std::uint64_t all = 0;
    each_word(words, [&](std::size_t w) { all |= set[w] & ~(w == slot / 64 ? std::uint64_t{1} << (slot % 64) : 0); });
    return all != 0;
}
inline bool intersect(ConstWords a, ConstWords b, std::size_t words) noexcept {
    std::uint64_t all = 0;
    each_word(words, [&](std::size_t w) { all |= a[w] & b[w]; });
    return all != 0;
}
inline bool is_subset(ConstWords a, ConstWords of, std::size_t words) noexcept {
    std::uint64_t outside = 0;
    each_word(words, [&](std::size_t w) { outside |= a[w] & ~of[w]; });
    return outside == 0;
}
inline void assign(Words to, ConstWords from, std::size_t words) noexcept {
    each_word(words, [&](std::size_t w) { to[w] = from[w]; });
}
inline void unite(Words to, ConstWords from, std::size_t words) noexcept {
    each_word(words, [&](std::size_t w) { to[w] |= from[w]; });
}

inline bool equal(ConstWords a, ConstWords b, std::size_t words) noexcept {
    std::uint64_t differs = 0;
    each_word(words, [&](std::size_t w) { differs |= a[w] ^ b[w]; });
    return differs == 0;
}

// Calls f(slot) for every member, in ascending order.
template <class F>
void each_in_word(std::uint64_t bits, Slot first, F&& f) {
    for (; bits != 0; bits &= bits - 1) f(first + static_cast<Slot>(std::countr_zero(bits)));
}
template <class F>
void each(ConstWords set, std::size_t words, F&& f) {
    each_word(words, [&](std::size_t w) { each_in_word(set[w], static_cast<Slot>(64 * w), f); });
}

}  // namespace mavloom::route
