// SPDX-License-Identifier: MIT
// Writes whole frames: header, payload as the version wants it, checksum, and where asked a signature. A pure function into the caller's bytes.
// MAVLink 2 drops trailing zero bytes but the first; MAVLink 1 sends no extension fields and always the full rest.
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
    std::uint8_t compat_flags = 0;  // MAVLink 2
};

// How a frame gets signed.
struct Signing {
    Signer* signer = nullptr;  // null: unsigned
    SigningTime now;
};

using FrameBuffer = std::array<std::uint8_t, max_frame_length>;

// True for an id that MAVLink 1 can carry.
[[nodiscard]] constexpr bool fits_v1(const MessageInfo& info) noexcept { return info.id.value <= 0xff; }

// Writes one frame into `out` and returns the view of it. `payload` is the full payload, `info.max_length` bytes (shorter ones are taken as
// zero-extended). MAVLink 1 needs fits_v1(info) and ignores `signing`.
[[nodiscard]] FrameView write_frame(std::span<std::uint8_t, max_frame_length> out, const FrameHeader& header,
                                    const MessageInfo& info, ByteView payload, Signing signing = {}) noexcept;

}  // namespace mavloom::wire
