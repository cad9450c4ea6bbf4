// SPDX-License-Identifier: MIT
#include "mavloom/feed/vehicle.hpp"

#include <algorithm>

#include "mavloom/msg/heartbeat.hpp"

namespace mavloom::feed {
namespace {

// MAV_TYPE and MAV_AUTOPILOT: MAVLink, minimal.xml.
// GCS, onboard controller, gimbal, ADS-B, camera.
constexpr std::uint8_t no_vehicles[] = {6, 18, 26, 27, 30};
// Fixed wing, quadrotor, coaxial, helicopter; airship, balloon, rocket, rover, boat, submarine, hexarotor, octorotor,
// tricopter, flapping wing, kite; seven kinds of VTOL; parafoil, dodecarotor, decarotor, generic multirotor,
// spacecraft, ground quadruped, gyrodyne.
constexpr std::uint8_t vehicles[] = {1,  2,  3,  4,  7,  8,  9,  10, 11, 12, 13, 14, 15, 16, 17,
                                     19, 20, 21, 22, 23, 24, 25, 28, 29, 35, 43, 45, 46, 47};
constexpr std::uint8_t autopilot_invalid = 8;

bool has(const auto& types, std::uint8_t type) noexcept { return std::ranges::find(types, type) != std::end(types); }

}  // namespace

bool is_vehicle(std::uint8_t type, std::uint8_t autopilot) noexcept {
    return has(vehicles, type) || (autopilot != autopilot_invalid && !has(no_vehicles, type));
}

bool is_vehicle_heartbeat(const wire::FrameView& frame) noexcept {
    if (frame.id() != msg::Heartbeat::id) return false;
    const auto heartbeat = msg::Heartbeat::decode(frame.payload());
    return is_vehicle(heartbeat.type, heartbeat.autopilot);
}

}  // namespace mavloom::feed
