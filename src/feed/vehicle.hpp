// SPDX-License-Identifier: MIT
// Recognises vehicles by their heartbeats.
#pragma once

#include "mavloom/wire/frame.hpp"

namespace mavloom::feed {

// Returns true for the HEARTBEAT of a vehicle, and false for that of a ground station, camera, gimbal or computer.
[[nodiscard]] bool is_vehicle_heartbeat(const wire::FrameView& frame) noexcept;

}  // namespace mavloom::feed
