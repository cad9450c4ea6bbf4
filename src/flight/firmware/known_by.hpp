// SPDX-License-Identifier: MIT
// Whether PX4, ArduPilot or both know a command or a message. Private to flight and sim.
#pragma once

#include <cstdint>

namespace mavloom::flight {

enum class KnownBy : std::uint8_t { both, px4, ardupilot };

[[nodiscard]] constexpr bool is_known(KnownBy by, bool is_px4) noexcept {
    return by == KnownBy::both || by == (is_px4 ? KnownBy::px4 : KnownBy::ardupilot);
}

}  // namespace mavloom::flight
