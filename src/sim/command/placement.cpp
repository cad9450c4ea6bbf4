// SPDX-License-Identifier: MIT
#include "sim/command/placement.hpp"

#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

Place place_of(const Command& command, const Parts& parts) {
    const bool is_filler = command.x == 0 && command.y == 0;
    return {.latitude = is_filler ? nan : command.x,
            .longitude = is_filler ? nan : command.y,
            .altitude = altitude_of(command, parts)};
}

bool has_global_frame(const Command& command) noexcept {
    switch (command.frame) {
        case msg::MAV_FRAME_GLOBAL:
        case msg::MAV_FRAME_GLOBAL_RELATIVE_ALT:
        case msg::MAV_FRAME_GLOBAL_INT:
        case msg::MAV_FRAME_GLOBAL_RELATIVE_ALT_INT:
        case msg::MAV_FRAME_GLOBAL_TERRAIN_ALT:
        case msg::MAV_FRAME_GLOBAL_TERRAIN_ALT_INT: return true;
        default: return false;
    }
}

double home_altitude(const Parts& parts) noexcept {
    const auto& home = parts.flight.home();
    return home ? home->altitude : parts.flight.ground_altitude();
}

Outcome set_global_origin(Parts& parts, const GeoPoint& origin) {
    Outcome outcome = parts.flight.set_origin(origin);
    if (!outcome.is_accepted()) return outcome;
    for (const LinkId link : parts.radio.links())
        (void)parts.streams.send_once(parts.view(), link, msg::GpsGlobalOrigin::id);
    return outcome;
}

}  // namespace mavloom::sim
