// SPDX-License-Identifier: MIT
// Parts of what is known of a vehicle, as short texts. Private to module view.
#pragma once

#include <string>

#include "mavloom/observe/vehicle_table.hpp"
#include "mavloom/view/grid.hpp"

namespace mavloom::view {

// "87 % 15.9 V"; "-": unknown.
[[nodiscard]] std::string battery_text(const observe::Vehicle& vehicle);
[[nodiscard]] std::string gps_text(const observe::Vehicle& vehicle, const dialect::Dialect& dialect);

}  // namespace mavloom::view
