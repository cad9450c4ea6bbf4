// SPDX-License-Identifier: MIT
// The texts with which ArduPilot reports the progress of a mission. PX4 has none: its texts are empty. Private to
// flight; functions. Source of the texts and their moments: ArduPilot 4.6.
#pragma once

#include "flight/context.hpp"

namespace mavloom::flight {

// The item becomes the current one.
void report_begin(const FlightContext& context, std::uint16_t seq, const PlanItem& item);
// The vehicle is at the item's place, or has `passed` it at a `distance` in metres.
void report_arrival(const FlightContext& context, std::uint16_t seq, const PlanItem& item, double distance, bool passed);
// The item is done.
void report_end(const FlightContext& context, std::uint16_t seq, const PlanItem& item);
// DO_JUMP jumps for the `done`th time.
void report_jump(const FlightContext& context, std::uint16_t seq, unsigned done, double wanted);

}  // namespace mavloom::flight
