// SPDX-License-Identifier: MIT
// Finds and removes numbers in set-points that a controller cannot follow, such as misplaced NaNs or huge values.
// Private to flight; pure functions.
#pragma once

#include "flight/pilot/pilot.hpp"

namespace mavloom::flight {

// True if every number is within sensible limits. `nan` is allowed where it means "not given".
[[nodiscard]] bool is_plain(const Setpoint& setpoint) noexcept;
// Returns the set-point with all other numbers replaced by "not given" or by their defaults.
[[nodiscard]] Setpoint made_plain(const Setpoint& setpoint);

}  // namespace mavloom::flight
