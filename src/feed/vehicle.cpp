// SPDX-License-Identifier: MIT
#include "feed/vehicle.hpp"

#include <algorithm>
#include <cstdint>

namespace mavloom::feed {
namespace {

// MAV_TYPEs that are not vehicles, and the autopilot value of components without one (MAVLink, minimal.xml).
constexpr std::uint8_t no_vehicles[] = {6, 18, 26, 27, 30};  // GCS, onboard controller, gimbal, ADS-B, camera
constexpr std::uint8_t autopilot_invalid = 8;
constexpr std::size_t heartbeat_type = 4, heartbeat_autopilot = 5;  // payload offsets

}  // namespace

bool is_vehicle_heartbeat(const wire::FrameView& frame) noexcept {
    if (frame.id() != MessageId{0}) return false;
    const auto payload = frame.payload();
    const auto byte = [&](std::size_t at) { return at < payload.size() ? payload[at] : std::uint8_t{0}; };
    return byte(heartbeat_autopilot) != autopilot_invalid &&
           std::ranges::find(no_vehicles, byte(heartbeat_type)) == std::end(no_vehicles);
}

}  // namespace mavloom::feed
