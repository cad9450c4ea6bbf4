// SPDX-License-Identifier: MIT
// Byte spans, and loads and stores of little-endian and big-endian numbers. MAVLink is little-endian on the wire.
// Nothing here checks bounds; the caller must.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace mavloom {

using ByteView = std::span<const std::uint8_t>;
using ByteSpan = std::span<std::uint8_t>;

namespace detail {
template <class T>
constexpr T swap_if_big(T v) noexcept {
    if constexpr (std::endian::native == std::endian::little || sizeof(T) == 1) {
        return v;
    } else {
        T r{};
        for (std::size_t i = 0; i < sizeof(T); ++i) r = static_cast<T>((r << 8) | ((v >> (8 * i)) & 0xff));
        return r;
    }
}
template <class T>
using bits_of = std::conditional_t<
    sizeof(T) == 1, std::uint8_t,
    std::conditional_t<sizeof(T) == 2, std::uint16_t, std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>>>;
}  // namespace detail

// Loads a little-endian integer or IEEE 754 float. `p` needs no alignment.
template <class T>
[[nodiscard]] inline T load_le(const void* p) noexcept {
    static_assert(std::is_arithmetic_v<T>);
    detail::bits_of<T> bits;
    std::memcpy(&bits, p, sizeof bits);
    return std::bit_cast<T>(detail::swap_if_big(bits));
}

template <class T>
inline void store_le(void* p, T value) noexcept {
    static_assert(std::is_arithmetic_v<T>);
    const auto bits = detail::swap_if_big(std::bit_cast<detail::bits_of<T>>(value));
    std::memcpy(p, &bits, sizeof bits);
}

// Big-endian, for the timestamps of tlog files. GCC 12 compiles the built-in to one load; it would compile a loop over
// the bytes to eight.
[[nodiscard]] inline std::uint64_t load_be64(const void* p) noexcept {
    return __builtin_bswap64(load_le<std::uint64_t>(p));
}
inline void store_be64(void* p, std::uint64_t v) noexcept { store_le(p, __builtin_bswap64(v)); }

}  // namespace mavloom
