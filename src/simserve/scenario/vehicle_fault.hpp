// SPDX-License-Identifier: MIT
// Parses the faults of vehicles: "gps jump 100 0", "motor off 1". Private to module simserve.
#pragma once

#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

// An unknown part or fault, or a wrong number, is an error (`usage`) that states what there is.
[[nodiscard]] SetupResult<sim::Fault> parse_vehicle_fault(std::string_view text);

}  // namespace mavloom::simserve
