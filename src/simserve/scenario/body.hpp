// SPDX-License-Identifier: MIT
// Parses the body of a multicopter in a scenario. Private to module simserve; pure functions. Errors are `usage`.
#pragma once

#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::simserve {

// "PRESET" or "preset:PRESET,frame:FRAME,arm:0.25,mass:2"; each part may be left out. `frame` and `arm` replace the
// places of the preset's rotors; other keys replace one number each. A body that no pilot could fly is an error.
[[nodiscard]] SetupResult<sim::CopterBody> parse_body(std::string_view text);

}  // namespace mavloom::simserve
