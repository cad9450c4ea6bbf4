// SPDX-License-Identifier: MIT
// Which firmware knows a command or a message. Private to module sim.
#pragma once

#include <cstdint>

namespace mavloom::sim {

enum class KnownBy : std::uint8_t { both, px4, ardupilot };

[[nodiscard]] constexpr bool is_known(KnownBy by, bool is_px4) noexcept {
    return by == KnownBy::both || by == (is_px4 ? KnownBy::px4 : KnownBy::ardupilot);
}

}  // namespace mavloom::sim
