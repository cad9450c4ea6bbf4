// SPDX-License-Identifier: MIT
// The MAVLink frame checksum: CRC-16/MCRF4XX (polynomial 0x1021, reflected, seed 0xffff, no final xor).
// MAVLink documentation calls it X.25. It covers the frame from the byte after the start byte to the end of the
// payload, then the message's CRC_EXTRA byte. There are two implementations: portable (lookup tables) and fast
// (carry-less multiplication), selected once at run time. Pure functions, safe from any thread.
// Source: MAVLink guide, "Checksum"; check value 0x6f91 in the CRC catalogue.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "mavloom/base/bytes.hpp"

namespace mavloom::wire {

inline constexpr std::uint16_t crc_seed = 0xffff;

namespace detail {

// slices[k][b] is the checksum of byte b followed by k zero bytes.
consteval std::array<std::array<std::uint16_t, 256>, 8> make_crc_slices() {
    std::array<std::array<std::uint16_t, 256>, 8> slices{};
    for (unsigned b = 0; b < 256; ++b) {
        auto crc = static_cast<std::uint16_t>(b);
        for (int bit = 0; bit < 8; ++bit) crc = static_cast<std::uint16_t>((crc >> 1) ^ ((crc & 1) != 0 ? 0x8408 : 0));
        slices[0][b] = crc;
    }
    for (std::size_t k = 1; k < slices.size(); ++k)
        for (unsigned b = 0; b < 256; ++b)
            slices[k][b] = static_cast<std::uint16_t>((slices[k - 1][b] >> 8) ^ slices[0][slices[k - 1][b] & 0xff]);
    return slices;
}

inline constexpr auto crc_slices = make_crc_slices();

}  // namespace detail

struct CrcImplementation {
    std::string_view name;
    std::uint16_t (*update)(std::uint16_t crc, const std::uint8_t* bytes, std::size_t size) noexcept;
    // `tail` holds CRC_EXTRA in its lowest byte and the received checksum in the next two.
    // Returns true if the checksum over `bytes` and CRC_EXTRA equals the received one. `readable` is explained at
    // `crc_agrees`.
    bool (*check)(std::uint32_t tail, const std::uint8_t* bytes, std::size_t size, std::size_t readable) noexcept;
};
// The implementations that this processor supports, portable first. For tests and benchmarks.
[[nodiscard]] std::span<const CrcImplementation> crc_implementations() noexcept;

namespace detail {
extern const CrcImplementation crc_fastest;
}

// Adds one byte to the checksum.
[[nodiscard]] constexpr std::uint16_t crc_update(std::uint16_t crc, std::uint8_t byte) noexcept {
    return static_cast<std::uint16_t>((crc >> 8) ^ detail::crc_slices[0][(crc ^ byte) & 0xff]);
}

// Adds `bytes` to the checksum, using the fastest implementation that this processor supports.
[[nodiscard]] inline std::uint16_t crc_update(std::uint16_t crc, ByteView bytes) noexcept {
    return detail::crc_fastest.update(crc, bytes.data(), bytes.size());
}

// The inverse of adding `byte`: returns the checksum before, given the checksum `after`.
[[nodiscard]] constexpr std::uint16_t crc_before(std::uint16_t after, std::uint8_t byte) noexcept {
    // A table entry is t << 8 ^ t << 3 ^ t >> 4, where t = index ^ index << 4 in eight bits. The high byte of the entry
    // gives t, and t gives the index.
    const unsigned high = after >> 8;
    const unsigned t = (high ^ high >> 5) & 0xff;
    const unsigned index = (t ^ t << 4) & 0xff;
    return static_cast<std::uint16_t>((index ^ byte) | ((after ^ t << 3 ^ t >> 4) & 0xff) << 8);
}

// Returns true if the checksum over `covered`, then `crc_extra`, equals `received`. Faster than computing the checksum
// and comparing. `covered` must not be empty. The first `readable` bytes from covered.data() on must be readable
// memory; `readable` is at least covered.size().
[[nodiscard]] inline bool crc_agrees(ByteView covered, std::size_t readable, std::uint8_t crc_extra,
                                     std::uint16_t received) noexcept {
    const std::uint32_t tail = crc_extra | std::uint32_t{received} << 8;
    return detail::crc_fastest.check(tail, covered.data(), covered.size(), readable);
}

// Returns the CRC_EXTRA byte that turns the checksum `before` (header and payload) into `received`, or -1 if none does.
// At most one byte does, because the high bytes of all table entries differ.
[[nodiscard]] int crc_extra_between(std::uint16_t before, std::uint16_t received) noexcept;

}  // namespace mavloom::wire
