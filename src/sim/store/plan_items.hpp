// SPDX-License-Identifier: MIT
// Items of plans on the wire: their two forms, and which items a vehicle accepts. Private to module sim; pure
// functions.
//
// MISSION_ITEM_INT and MISSION_ITEM carry the same item; MISSION_ITEM has x and y as float degrees. Sources: MAVLink
// guide, "Mission Protocol"; PX4 1.17.
#pragma once

#include <cstdint>
#include <optional>

#include "flight/plan.hpp"
#include "mavloom/msg/mission_item.hpp"
#include "mavloom/msg/mission_item_int.hpp"
#include "mavloom/sim/flight.hpp"

namespace mavloom::sim {

// Empty if a vehicle keeps no plan of this type.
[[nodiscard]] std::optional<PlanType> plan_type(std::uint8_t mission_type) noexcept;

[[nodiscard]] PlanItem item_of(const msg::MissionItemInt& message) noexcept;
// Degrees are rounded to the nearest 1e-7. A NaN becomes INT32_MAX, which means "not set".
[[nodiscard]] PlanItem item_of(const msg::MissionItem& message) noexcept;

// The fields of an item without target, seq, type and `current`. PX4 reports a global frame in the variant of the
// message (MAV_FRAME_GLOBAL_INT for MISSION_ITEM_INT); ArduPilot always in that of MISSION_ITEM.
[[nodiscard]] msg::MissionItemInt int_form(const PlanItem& item, bool is_px4) noexcept;
[[nodiscard]] msg::MissionItem float_form(const PlanItem& item) noexcept;

// The MAV_MISSION_RESULT for an item of a plan of `count` items.
[[nodiscard]] std::uint8_t check_item(const PlanItem& item, PlanType type, std::uint16_t count, bool is_px4) noexcept;

}  // namespace mavloom::sim
