// SPDX-License-Identifier: MIT
// Parses the noise of a vehicle's sensors. Private to module simserve.
#pragma once

#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

// "false" (exact), "true" (the standard), or a preset and numbers that change it: "gazebo,gps:0.5". Errors are `usage`.
[[nodiscard]] SetupResult<void> set_noise(std::string_view text, sim::VehicleOptions& options);

}  // namespace mavloom::simserve
