// SPDX-License-Identifier: MIT
#include "mavloom/wire/crc32.hpp"

#include <array>

namespace mavloom::wire {

namespace {

constexpr std::array<std::uint32_t, 256> table = [] {
    std::array<std::uint32_t, 256> entries{};
    for (std::uint32_t i = 0; i < entries.size(); ++i) {
        std::uint32_t entry = i;
        for (int bit = 0; bit < 8; ++bit) entry = (entry & 1) != 0 ? entry >> 1 ^ 0xedb88320u : entry >> 1;
        entries[i] = entry;
    }
    return entries;
}();

}  // namespace

std::uint32_t crc32(std::uint32_t crc, ByteView bytes) noexcept {
    for (const std::uint8_t byte : bytes) crc = table[(crc ^ byte) & 0xff] ^ crc >> 8;
    return crc;
}

}  // namespace mavloom::wire
