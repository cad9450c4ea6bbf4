// SPDX-License-Identifier: MIT
// Names that ROS 2 accepts, made from MAVLink's: words of ASCII letters and digits, joined as the kind of name needs.
// Source: ROS 2 interface definition, "Naming of messages and services", "Constants".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::message {

[[nodiscard]] std::string ros2_message_name(std::string_view name);   // VFR_HUD -> VfrHud
[[nodiscard]] std::string ros2_field_name(std::string_view name);     // Roll_Rate -> roll_rate
[[nodiscard]] std::string ros2_constant_name(std::string_view name);  // GOPRO_RESOLUTION_4k -> GOPRO_RESOLUTION_4K

// A message's fields in the order of its payload.
[[nodiscard]] std::vector<const dialect::Field*> in_wire_order(const dialect::Message& definition);

}  // namespace mavloom::message
