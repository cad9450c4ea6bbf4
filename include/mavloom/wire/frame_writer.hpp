// SPDX-License-Identifier: MIT
// Writes a complete frame: header, payload, checksum and, optionally, a signature. MAVLink 2 payloads lose their
// trailing zero bytes, but at least one byte stays. MAVLink 1 payloads have full length but no extension fields. Writes
// into the caller's buffer and allocates nothing. The only state is in the Signer, which advances its time.
// Source: MAVLink guide, "Packet Serialization".
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "mavloom/wire/frame.hpp"
#include "mavloom/wire/message_table.hpp"
#include "mavloom/wire/signing.hpp"

namespace mavloom::wire {

struct FrameHeader {
    Version version = Version::v2;
    std::uint8_t sequence = 0;
    Source source;
    std::uint8_t compat_flags = 0;  // MAVLink 2 only
};

// The signer to use, and the current time for its timestamp.
struct Signing {
    Signer* signer = nullptr;  // null: unsigned
    SigningTime now;
};

using FrameBuffer = std::array<std::uint8_t, max_frame_length>;

// True if MAVLink 1 can carry the message id (at most 255).
[[nodiscard]] constexpr bool fits_v1(const MessageInfo& info) noexcept { return info.id.value <= 0xff; }

// Writes one frame into `out` and returns a view of it. `payload` is the full payload of `info.max_length` bytes; a
// shorter one is extended with zeros. For MAVLink 1, `fits_v1(info)` must be true and `signing` is ignored.
[[nodiscard]] FrameView write_frame(std::span<std::uint8_t, max_frame_length> out, const FrameHeader& header,
                                    const MessageInfo& info, ByteView payload, Signing signing = {}) noexcept;

}  // namespace mavloom::wire
