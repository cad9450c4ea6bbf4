// SPDX-License-Identifier: MIT
// The tables of both firmwares. Private to flight; constants.
#pragma once

#include <span>

#include "flight/firmware/firmware.hpp"

namespace mavloom::flight {

// Sorted by name. Made at the first call for a firmware; all vehicles share them.
[[nodiscard]] std::span<const ParamInfo> px4_parameters(Kind kind);
[[nodiscard]] std::span<const ParamInfo> ardupilot_parameters(Kind kind);

[[nodiscard]] std::span<const ModeInfo> px4_modes(Kind kind) noexcept;
[[nodiscard]] std::span<const ModeInfo> ardupilot_modes(Kind kind) noexcept;

[[nodiscard]] Tuning px4_tuning(Kind kind, const Parameters& parameters);
[[nodiscard]] Tuning ardupilot_tuning(Kind kind, const Parameters& parameters);

[[nodiscard]] const Texts& px4_texts() noexcept;
[[nodiscard]] const Texts& ardupilot_texts(Kind kind) noexcept;

[[nodiscard]] const Firmware& px4_firmware(Kind kind);
[[nodiscard]] const Firmware& ardupilot_firmware(Kind kind);

}  // namespace mavloom::flight
