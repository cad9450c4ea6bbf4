// SPDX-License-Identifier: MIT
// A copy of a vehicle's state for people and programs outside: `mavloom ctl sim state`, metrics, tests.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/ids.hpp"
#include "mavloom/flight/moment.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

// Values as in MAV_LANDED_STATE.
enum class LandedState : std::uint8_t { undefined = 0, on_ground = 1, in_air = 2, takeoff = 3, landing = 4 };

struct VehicleStatus {
    SystemId system;
    Kind kind = Kind::quad;
    Autopilot autopilot = Autopilot::px4;
    bool armed = false;
    bool ready = false;  // can be armed now
    std::string_view mode;
    std::uint32_t custom_mode = 0;
    LandedState landed = LandedState::on_ground;
    double latitude_deg = 0, longitude_deg = 0;
    double altitude_m = 0;           // above mean sea level
    double relative_altitude_m = 0;  // above home
    double north_m_s = 0, east_m_s = 0, down_m_s = 0;
    double roll_deg = 0, pitch_deg = 0, heading_deg = 0;
    double battery_percent = 0, battery_volts = 0;
    std::uint16_t mission_items = 0, mission_current = 0;
    FlightTime since_boot{};
    unsigned not_finite = 0;          // times that its motion was not finite, so that it was put back at home
    std::vector<std::string> faults;  // on purpose: "gps off"; by clients: "motor off, instances 1"
};

}  // namespace mavloom::flight
