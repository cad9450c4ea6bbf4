// SPDX-License-Identifier: MIT
// `mavloom sim --hil`: a PX4 outside flies each vehicle.
#pragma once

#include "command.hpp"
#include "mavloom/simserve/scenario.hpp"

namespace mavloom::app {

// Runs a scenario that has `hil`.
[[nodiscard]] Exit simulate_for_px4(const Common& common, const simserve::Scenario& scenario,
                                    const dialect::Dialect& dialect, bool prints_json);

}  // namespace mavloom::app
