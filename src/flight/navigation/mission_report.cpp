// SPDX-License-Identifier: MIT
#include "flight/navigation/mission_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>

#include "mavloom/msg/enums/mav_cmd.hpp"

namespace mavloom::flight {

namespace {

using namespace msg;

std::string filled_all(std::string_view text, std::initializer_list<std::string> values) {
    std::string result(text);
    for (const std::string& value : values) result = filled(result, value);
    return result;
}

std::string whole_number(double value) { return fmt::format("{:.0f}", std::isfinite(value) ? value : 0); }

bool is_waypoint(const PlanItem& item) noexcept {
    return item.command == MAV_CMD_NAV_WAYPOINT || item.command == MAV_CMD_NAV_SPLINE_WAYPOINT;
}

std::string_view end_text(const Texts& texts, std::uint16_t command) noexcept {
    switch (command) {
        case MAV_CMD_NAV_WAYPOINT:
        case MAV_CMD_NAV_SPLINE_WAYPOINT: return texts.command_done;
        case MAV_CMD_NAV_LOITER_TIME: return texts.loiter_time_done;
        case MAV_CMD_NAV_LOITER_TURNS: return texts.turns_done;
        case MAV_CMD_NAV_LOITER_TO_ALT: return texts.loiter_altitude_done;
        case MAV_CMD_NAV_TAKEOFF: return texts.takeoff_done;
        default: return {};
    }
}

}  // namespace

void report_begin(const FlightContext& context, std::uint16_t seq, const PlanItem& item) {
    const std::string_view name = context.firmware.item_name(item.command);
    if (name.empty()) return;
    context.say(Severity::info, filled_all(context.texts().item_begins, {std::to_string(seq), std::string(name)}));
}

void report_arrival(const FlightContext& context, std::uint16_t seq, const PlanItem& item, double distance, bool passed) {
    if (!is_waypoint(item)) return;
    const Texts& texts = context.texts();
    const float hold = item.params[0];
    const bool is_held = hold >= 1 && !texts.waypoint_held.empty();
    const std::string_view text = is_held  ? texts.waypoint_held
                                  : passed ? texts.waypoint_passed
                                           : texts.waypoint_reached;
    context.say(Severity::info,
                filled_all(text, {std::to_string(seq), whole_number(is_held ? double{hold} : distance)}));
}

void report_end(const FlightContext& context, std::uint16_t seq, const PlanItem& item) {
    const std::string_view text = end_text(context.texts(), item.command);
    const bool is_takeoff = item.command == MAV_CMD_NAV_TAKEOFF;
    context.say(Severity::info,
                filled(text, is_takeoff ? fmt::format("{:.2f}", context.craft.height()) : std::to_string(seq)));
}

void report_jump(const FlightContext& context, std::uint16_t seq, unsigned done, double wanted) {
    context.say(Severity::info, filled_all(context.texts().item_jumps,
                                           {std::to_string(seq), std::to_string(done), whole_number(wanted)}));
}

}  // namespace mavloom::flight
