// SPDX-License-Identifier: MIT
#include "sim/command/positions.hpp"

#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

CommandPosition position_of(const Command& command, const Parts& parts) {
    const bool is_filler = command.x == 0 && command.y == 0;
    return {.latitude = is_filler ? nan : command.x,
            .longitude = is_filler ? nan : command.y,
            .altitude = altitude_of(command, parts.flight)};
}

bool is_global_frame(std::uint8_t frame) noexcept {
    switch (frame) {
        case msg::MAV_FRAME_GLOBAL:
        case msg::MAV_FRAME_GLOBAL_RELATIVE_ALT:
        case msg::MAV_FRAME_GLOBAL_INT:
        case msg::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT:
        case msg::MAV_FRAME_GLOBAL_TERRAIN_ALT:
        case msg::MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: return true;
        default: return false;
    }
}

bool is_terrain_frame(std::uint8_t frame) noexcept {
    return frame == msg::MAV_FRAME_GLOBAL_TERRAIN_ALT || frame == msg::MAV_FRAME_GLOBAL_TERRAIN_ALT_INT;
}

Outcome set_global_origin(Parts& parts, const GeoPoint& origin) {
    Outcome outcome = parts.flight.set_origin(origin);
    if (!outcome.is_accepted()) return outcome;
    for (const LinkId link : parts.radio.links())
        (void)parts.streams.send_once(parts.view(), link, msg::GpsGlobalOrigin::id);
    return outcome;
}

}  // namespace mavloom::sim
