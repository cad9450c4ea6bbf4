// SPDX-License-Identifier: MIT
// secret_hash.hpp's product of 128 bits, for processors that have no integers of 128 bits.
#pragma once

#include <cstdint>

namespace mavloom {

// The upper 64 bits of the product, exclusive or the lower ones; by four products of 32-bit halves.
[[nodiscard]] constexpr std::uint64_t folded_product_of_halves(std::uint64_t a, std::uint64_t b) noexcept {
    constexpr std::uint64_t half = 0xffff'ffff;
    const std::uint64_t low = (a & half) * (b & half);
    const std::uint64_t mixed = (a >> 32) * (b & half) + (low >> 32);
    const std::uint64_t other = (a & half) * (b >> 32) + (mixed & half);
    const std::uint64_t high = (a >> 32) * (b >> 32) + (mixed >> 32) + (other >> 32);
    return high ^ (other << 32 | (low & half));
}

#ifndef __SIZEOF_INT128__
[[nodiscard]] constexpr std::uint64_t folded_product(std::uint64_t a, std::uint64_t b) noexcept {
    return folded_product_of_halves(a, b);
}
#endif

}  // namespace mavloom
