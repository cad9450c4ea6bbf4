// SPDX-License-Identifier: MIT
// Parses how autopilots outside fly the vehicles of a scenario. Private to module simserve; pure functions. Errors are
// `usage`.
#pragma once

#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/hil/sensor_rates.hpp"

namespace mavloom::simserve {

// "px4" or "px4=ENDPOINT".
[[nodiscard]] SetupResult<endpoint::Endpoint> parse_hil(std::string_view text);
// "imu:250,mag:50,baro:50,gps:10,gps_delay:0.1,distance:20": Hz, and seconds; each part may be left out.
[[nodiscard]] SetupResult<hil::SensorRates> parse_hil_sensors(std::string_view text);

}  // namespace mavloom::simserve
