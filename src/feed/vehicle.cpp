// SPDX-License-Identifier: MIT
#include "feed/vehicle.hpp"

#include <algorithm>
#include <cstdint>

#include "mavloom/msg/heartbeat.hpp"

namespace mavloom::feed {
namespace {

// MAV_TYPEs that are not vehicles, and the autopilot value of components without one (MAVLink, minimal.xml).
constexpr std::uint8_t no_vehicles[] = {6, 18, 26, 27, 30};  // GCS, onboard controller, gimbal, ADS-B, camera
constexpr std::uint8_t autopilot_invalid = 8;

}  // namespace

bool is_vehicle_heartbeat(const wire::FrameView& frame) noexcept {
    if (frame.id() != msg::Heartbeat::id) return false;
    const auto heartbeat = msg::Heartbeat::decode(frame.payload());
    return heartbeat.autopilot != autopilot_invalid &&
           std::ranges::find(no_vehicles, heartbeat.type) == std::end(no_vehicles);
}

}  // namespace mavloom::feed
