// SPDX-License-Identifier: MIT
// The outputs of PX4 as the channels of a plant. Private to hil; pure functions.
//
// HIL_ACTUATOR_CONTROLS has the outputs MAIN1 to MAIN16. PX4's airframe decides what each of them moves:
//   multicopter  MAIN1 and those after it: the motors, in PX4's order
//   plane        as airframe 1030, the plane of Gazebo classic
//   rover        as airframe 1060, the rover of Gazebo classic
#pragma once

#include <array>

#include "flight/plant/plant.hpp"

namespace mavloom::hil {

using Controls = std::array<float, 16>;

struct ReadOutputs {
    flight::Outputs outputs{};
    bool has_beyond = false;     // one was beyond its range, and counts as its limit
    bool has_no_number = false;  // one was NaN or infinite, and counts as 0
};
// Reads what the plant uses, and nothing else.
[[nodiscard]] ReadOutputs read_outputs(const Controls& controls, flight::Kind kind, const flight::Channels& channels);

}  // namespace mavloom::hil
