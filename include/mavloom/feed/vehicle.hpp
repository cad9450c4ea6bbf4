// SPDX-License-Identifier: MIT
// Decides which components are vehicles, for code that waits for a vehicle or addresses one. Pure; any thread.
#pragma once

#include <cstdint>

#include "mavloom/wire/frame.hpp"

namespace mavloom::feed {

// Whether a HEARTBEAT with these values comes from a vehicle:
// - A vehicle's type (MAV_TYPE: quadrotor, rover, ...) is enough, even without an autopilot (MAV_AUTOPILOT_INVALID), as
//   home-made boards report it.
// - A ground station, onboard controller, gimbal, ADS-B receiver or camera is not a vehicle.
// - Any other type is a vehicle if it has an autopilot.
[[nodiscard]] bool is_vehicle(std::uint8_t type, std::uint8_t autopilot) noexcept;

// Whether the frame is such a HEARTBEAT.
[[nodiscard]] bool is_vehicle_heartbeat(const wire::FrameView& frame) noexcept;

}  // namespace mavloom::feed
