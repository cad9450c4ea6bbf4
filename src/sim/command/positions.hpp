// SPDX-License-Identifier: MIT
// Positions in commands, and what several commands and messages do with them. Private to module sim.
#pragma once

#include "flight/physics/geodesy.hpp"
#include "sim/command/commands.hpp"

namespace mavloom::sim {

struct Parts;

// `nan` where the client gave nothing. The altitude is above mean sea level.
struct CommandPosition {
    double latitude, longitude, altitude;
};

// Latitude and longitude 0/0 count as not given: clients fill unused parameters with 0.
[[nodiscard]] CommandPosition position_of(const Command& command, const Parts& parts);
[[nodiscard]] bool is_global_frame(std::uint8_t frame) noexcept;
[[nodiscard]] bool is_terrain_frame(std::uint8_t frame) noexcept;

// Moves the origin of the local frame, and reports it on all links.
Outcome set_global_origin(Parts& parts, const GeoPoint& origin);

}  // namespace mavloom::sim
