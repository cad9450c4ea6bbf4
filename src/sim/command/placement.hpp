// SPDX-License-Identifier: MIT
// Positions in commands, and what several commands and messages do with them. Private to module sim.
#pragma once

#include "flight/physics/geodesy.hpp"
#include "sim/command/commands.hpp"

namespace mavloom::sim {

struct Parts;

// `nan` where the client gave nothing. The altitude is above mean sea level.
struct Place {
    double latitude, longitude, altitude;
};

// Latitude and longitude 0/0 count as not given: clients fill unused parameters with 0.
[[nodiscard]] Place place_of(const Command& command, const Parts& parts);
[[nodiscard]] bool has_global_frame(const Command& command) noexcept;
// The altitude of home above mean sea level. Until home is set, the altitude of the ground.
[[nodiscard]] double home_altitude(const Parts& parts) noexcept;

// Moves the origin of the local frame, and reports it on all links.
Outcome set_global_origin(Parts& parts, const GeoPoint& origin);

}  // namespace mavloom::sim
