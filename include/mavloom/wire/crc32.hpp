// SPDX-License-Identifier: MIT
// The CRC-32 of MAVLink's parameter hash, plan ids, FTP and metadata: reflected polynomial 0xEDB88320, initial value 0,
// no inversion at the end. It is not zip's CRC-32.
#pragma once

#include <cstdint>

#include "mavloom/base/bytes.hpp"

namespace mavloom::wire {

// Continues a checksum; start with 0.
[[nodiscard]] std::uint32_t crc32(std::uint32_t crc, ByteView bytes) noexcept;

}  // namespace mavloom::wire
