// SPDX-License-Identifier: MIT
// The kind and verdict that `mavloom route --ring` stores with each frame in the ring (docs/formats/ring.md). Plain
// values; any thread.
#pragma once

#include <cstdint>
#include <optional>

#include "mavloom/route/engine.hpp"

namespace mavloom::ring {

// Kind of a record that holds one whole MAVLink frame as received, including start byte, checksum and signature.
inline constexpr std::uint16_t ring_kind_frame = 1;

enum class FrameSignature : std::uint8_t {
    none,       // the frame has no signature
    unchecked,  // it has one that was not checked
    good,       // it came through an endpoint with `verify=` and is valid
    bad,        // it is invalid; a router drops such frames and never writes them
};

// Builds the record's verdict byte. Bits 0 to 3 hold the routing verdict plus one (0: not recorded). Bits 4 and 5 hold
// the result of the signature check.
[[nodiscard]] constexpr std::uint8_t ring_verdict(FrameSignature signature) noexcept {
    return static_cast<std::uint8_t>(static_cast<unsigned>(signature) << 4u);
}
[[nodiscard]] constexpr std::uint8_t ring_verdict(route::Verdict verdict, FrameSignature signature) noexcept {
    return static_cast<std::uint8_t>(ring_verdict(signature) | (static_cast<unsigned>(verdict) + 1u));
}
// Returns the routing verdict. Returns nothing if the writer recorded none (mavloom.hear, `shm write`) or if this
// version does not know the value.
[[nodiscard]] constexpr std::optional<route::Verdict> verdict_of(std::uint8_t ring_verdict) noexcept {
    const unsigned number = ring_verdict & 15u;
    if (number == 0 || number > static_cast<unsigned>(route::Verdict::unknown_link) + 1u) return std::nullopt;
    return static_cast<route::Verdict>(number - 1u);
}
[[nodiscard]] constexpr FrameSignature signature_of(std::uint8_t ring_verdict) noexcept {
    return static_cast<FrameSignature>((ring_verdict >> 4u) & 3u);
}

// These numbers are part of the format: other programs read them.
static_assert(static_cast<int>(route::Verdict::forwarded) == 0 && static_cast<int>(route::Verdict::nowhere) == 1 &&
              static_cast<int>(route::Verdict::filtered) == 2 && static_cast<int>(route::Verdict::rate_limited) == 3 &&
              static_cast<int>(route::Verdict::duplicate) == 4 && static_cast<int>(route::Verdict::echo) == 5 &&
              static_cast<int>(route::Verdict::unknown_target) == 6 && static_cast<int>(route::Verdict::consumed) == 7 &&
              static_cast<int>(route::Verdict::tap) == 8 && static_cast<int>(route::Verdict::private_link) == 9 &&
              static_cast<int>(route::Verdict::unknown_link) == 10);

}  // namespace mavloom::ring
