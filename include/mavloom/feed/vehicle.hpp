// SPDX-License-Identifier: MIT
// The rule of which components are vehicles, for everything that waits for one or addresses one. Pure; any thread.
#pragma once

#include <cstdint>

#include "mavloom/wire/frame.hpp"

namespace mavloom::feed {

// Whether a HEARTBEAT with these values comes from a vehicle:
// - A type of vehicle (MAV_TYPE: a quadrotor, a rover, ...) is one, even if it names no autopilot, as home-made boards
//   do (MAV_AUTOPILOT_INVALID).
// - A ground station, onboard controller, gimbal, ADS-B receiver or camera is none.
// - Any other type is one if it has an autopilot.
[[nodiscard]] bool is_vehicle(std::uint8_t type, std::uint8_t autopilot) noexcept;

// Whether the frame is such a HEARTBEAT.
[[nodiscard]] bool is_vehicle_heartbeat(const wire::FrameView& frame) noexcept;

}  // namespace mavloom::feed
