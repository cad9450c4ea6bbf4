// SPDX-License-Identifier: MIT
// Parses the body of a vehicle in a scenario. Private to module simserve; pure functions. Errors are `usage`.
#pragma once

#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

// "PRESET" or "preset:PRESET,mass:2"; each part may be left out. Keys replace one number of the preset each, but a
// multicopter's `frame` and `arm` replace the places of its rotors, and a rover's `wheel_base` and `steering` its turn
// radius. A body that no pilot could fly or drive is an error.
[[nodiscard]] SetupResult<sim::CopterBody> parse_copter(std::string_view text);
[[nodiscard]] SetupResult<sim::PlaneBody> parse_plane(std::string_view text);
[[nodiscard]] SetupResult<sim::RoverBody> parse_rover(std::string_view text);

// Parses the body of the kind that the options have.
[[nodiscard]] SetupResult<void> set_body(std::string_view text, sim::VehicleOptions& options);

}  // namespace mavloom::simserve
