// SPDX-License-Identifier: MIT
// Set-points without numbers that a controller cannot follow. Private to flight; pure functions.
#pragma once

#include "flight/physics/airframe.hpp"

namespace mavloom::flight {

// True if every number is `nan` where that means "not given", and of a sensible size elsewhere.
[[nodiscard]] bool is_plain(const Setpoint& setpoint) noexcept;
// The set-point with every other number not given, or at its default.
[[nodiscard]] Setpoint made_plain(const Setpoint& setpoint);

}  // namespace mavloom::flight
