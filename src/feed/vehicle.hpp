// SPDX-License-Identifier: MIT
// Recognises vehicles by their heartbeats.
#pragma once

#include "mavloom/wire/frame.hpp"

namespace mavloom::feed {

// Whether the frame is the HEARTBEAT of a vehicle, not that of a ground station, camera, gimbal or computer.
[[nodiscard]] bool is_vehicle_heartbeat(const wire::FrameView& frame) noexcept;

}  // namespace mavloom::feed
