// SPDX-License-Identifier: MIT
// Commands that fly the vehicle. They translate parameters into orders; Flight obeys or refuses. Meaning of parameters:
// MAVLink common.xml. Comments state where PX4 and ArduPilot differ.
#include <algorithm>
#include <cmath>
#include <optional>

#include "flight/context.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/enums/mav_roi.hpp"
#include "sim/command/commands.hpp"
#include "sim/command/positions.hpp"
#include "sim/parts.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

using CarryOut = Outcome (*)(Parts&, const Command&, Moment);

// Answers UNSUPPORTED_MAV_FRAME to a position in a local frame.
template <CarryOut carry_out>
Outcome at_location(Parts& parts, const Command& command, Moment now) {
    return is_global_frame(command.frame) ? carry_out(parts, command, now) : Result::unsupported_frame;
}

double positive_or_nan(float value) noexcept { return std::isfinite(value) && value > 0 ? double{value} : nan; }

// --- Arming

// PX4's magic number for force is 21196, ArduPilot's for arming 2989; clients mix them. An order to disarm by force
// stops the motors in the air.
Outcome arm_or_disarm(Parts& parts, const Command& command, Moment /*now*/) {
    constexpr float force_disarm = 21196, force_arm = 2989;
    const float magic = command.param(2);
    if (command.param(1) == 1) return parts.flight.arm(magic == force_arm || magic == force_disarm, OrderedBy::client);
    if (command.param(1) == 0) return parts.flight.disarm(magic == force_disarm, OrderedBy::client);
    return Result::denied;
}

Outcome terminate(Parts& parts, const Command& command, Moment /*now*/) {
    if (std::isnan(command.param(1))) return Result::denied;
    return command.param(1) >= 0.5f ? parts.flight.terminate() : Outcome(Result::accepted);
}

// --- Modes

Outcome refuse_unknown_mode(Parts& parts, std::uint32_t number) {
    const bool is_px4 = parts.firmware.is_px4();
    parts.on_text(is_px4 ? Severity::critical : Severity::warning,
                  flight::filled(parts.firmware.texts().unknown_mode, std::to_string(number)));
    return is_px4 ? Result::temporarily_rejected : Result::failed;
}

// PX4: main mode and sub mode as small numbers. ArduPilot: the custom mode.
Outcome set_mode(Parts& parts, const Command& command, Moment /*now*/) {
    const auto base_mode = command.whole(1, 0xff);
    const auto main = command.whole(2);
    const auto sub = std::isnan(command.param(3)) ? std::optional(0u) : command.whole(3);
    if (!base_mode || !main || !sub) return Result::denied;
    const ModeInfo* const mode = parts.firmware.requested_mode(static_cast<std::uint8_t>(*base_mode), *main, *sub);
    return mode == nullptr ? refuse_unknown_mode(parts, *main) : parts.flight.set_mode(*mode, OrderedBy::client);
}

Outcome set_standard_mode(Parts& parts, const Command& command, Moment /*now*/) {
    const auto wanted = command.whole(1, 0xff);
    if (!wanted || *wanted == 0) return Result::denied;
    for (const ModeInfo& mode : parts.firmware.modes())
        if (mode.standard_mode == *wanted && mode.is_selectable())
            return parts.flight.set_mode(mode, OrderedBy::client);
    return Result::unsupported;
}

// PX4 itself does not know this one as a command. pymavlink's set_mode_loiter() sends it.
Outcome hold(Parts& parts, const Command& /*command*/, Moment /*now*/) {
    const ModeInfo* const mode = parts.firmware.mode_for(Behaviour::hold);
    return mode == nullptr ? Outcome(Result::unsupported) : parts.flight.set_mode(*mode, OrderedBy::client);
}

// --- Take-off, landing, return

// The altitude of a take-off. Clients of ArduPilot, and MAVProxy with any vehicle, send a height above home in a frame
// that counts from sea level. So an altitude below home is a height above it, and 0 is none.
double takeoff_altitude(const Parts& parts, const Command& command) {
    const double home = parts.flight.home_altitude();
    if (std::isnan(command.z) || command.z == 0) return nan;
    if (!parts.firmware.is_px4() && !command.is_int) return home + command.z;
    const double altitude = altitude_of(command, parts.flight);
    return altitude < home && command.z > 0 ? home + command.z : altitude;
}

// ArduPilot ignores the yaw, and its clients send 0.
double yaw_of_takeoff(const Parts& parts, const Command& command) noexcept {
    return parts.firmware.is_px4() ? to_radians(double{command.param(4)}) : nan;
}

Outcome take_off(Parts& parts, const Command& command, Moment /*now*/) {
    const CommandPosition position = position_of(command, parts);
    return parts.flight.take_off({.latitude = position.latitude,
                                  .longitude = position.longitude,
                                  .altitude = takeoff_altitude(parts, command),
                                  .yaw = yaw_of_takeoff(parts, command)});
}

Outcome land(Parts& parts, const Command& command, Moment /*now*/) {
    return parts.flight.land({.latitude = command.x, .longitude = command.y});
}

Outcome return_home(Parts& parts, const Command& /*command*/, Moment /*now*/) { return parts.flight.return_home(); }

// --- Going somewhere

// PX4 reads the yaw in radians. ArduPilot ignores it, and its clients send 0.
Outcome reposition(Parts& parts, const Command& command, Moment /*now*/) {
    constexpr std::uint32_t change_mode = 1;  // MAV_DO_REPOSITION_FLAGS
    const auto flags = command.whole(2);
    const CommandPosition position = position_of(command, parts);
    return parts.flight.reposition({.latitude = position.latitude,
                                    .longitude = position.longitude,
                                    .altitude = position.altitude,
                                    .speed = positive_or_nan(command.param(1)),
                                    .radius = double{command.param(3)},
                                    .yaw = parts.firmware.is_px4() ? double{command.param(4)} : nan,
                                    .may_change_mode = flags && (*flags & change_mode) != 0});
}

// The fourth parameter is the angle to fly, in radians.
Outcome orbit(Parts& parts, const Command& command, Moment /*now*/) {
    const auto yaw = command.whole(3, static_cast<double>(OrbitYaw::unchanged));
    if (!yaw && !std::isnan(command.param(3))) return Result::denied;
    const CommandPosition position = position_of(command, parts);
    const double angle = std::isfinite(command.param(4)) ? std::max(0.0, double{command.param(4)}) : 0;
    return parts.flight.orbit({.latitude = position.latitude,
                               .longitude = position.longitude,
                               .altitude = position.altitude,
                               .radius = double{command.param(1)},
                               .speed = positive_or_nan(command.param(2)),
                               .yaw = static_cast<OrbitYaw>(yaw.value_or(0)),
                               .turns = angle / (2 * pi)});
}

Outcome pause_or_continue(Parts& parts, const Command& command, Moment /*now*/) {
    if (command.param(1) == 0) return parts.flight.pause();
    return command.param(1) == 1 ? parts.flight.resume() : Outcome(Result::denied);
}

Outcome change_altitude(Parts& parts, const Command& command, Moment /*now*/) {
    const auto frame = command.whole(2, 0xff);
    if (!frame || !std::isfinite(command.param(1))) return Result::denied;
    Command with_altitude = command;
    with_altitude.frame = static_cast<std::uint8_t>(*frame);
    with_altitude.z = double{command.param(1)};
    if (!is_global_frame(with_altitude.frame)) return Result::denied;
    return parts.flight.change_altitude(altitude_of(with_altitude, parts.flight));
}

// A speed that is not positive means the usual one.
Outcome change_speed(Parts& parts, const Command& command, Moment /*now*/) {
    const auto kind = command.whole(1, static_cast<double>(SpeedKind::descent));
    if (!kind || std::isinf(command.param(2))) return Result::denied;
    return parts.flight.change_speed(static_cast<SpeedKind>(*kind), positive_or_nan(command.param(2)));
}

bool steers_by_orders(const Parts& parts) noexcept {
    const Behaviour behaviour = parts.flight.mode().behaviour;
    return behaviour == Behaviour::offboard || behaviour == Behaviour::mission;
}

// The third parameter is the direction of a relative turn: 1 clockwise, -1 counter-clockwise.
Outcome turn(Parts& parts, const Command& command, Moment /*now*/) {
    const double angle = double{command.param(1)};
    const bool is_relative = command.param(4) == 1;
    if (!(angle >= 0 && angle <= 360)) return Result::failed;
    if (!steers_by_orders(parts)) return Result::failed;
    const double sign = is_relative && command.param(3) == -1 ? -1 : 1;
    return parts.flight.turn_to(to_radians(sign * angle), to_radians(positive_or_nan(command.param(2))), is_relative);
}

Outcome guided_altitude(Parts& parts, const Command& command, Moment /*now*/) {
    if (!command.is_int) return Result::command_int_only;
    return std::isnan(command.z) ? Outcome(Result::denied)
                                 : parts.flight.change_altitude(altitude_of(command, parts.flight));
}

// The first parameter is HEADING_TYPE: 0 course over ground, 1 heading, 2 back to the usual.
Outcome guided_heading(Parts& parts, const Command& command, Moment /*now*/) {
    const auto type = command.whole(1, 2);
    const double angle = double{command.param(2)};
    if (!type || (*type != 2 && !(angle >= -180 && angle <= 360))) return Result::denied;
    if (!steers_by_orders(parts)) return Result::failed;
    return parts.flight.turn_to(*type == 2 ? nan : to_radians(angle), nan, false);
}

// --- Missions

// ArduPilot starts at the current item, whatever the first parameter is.
Outcome start_mission(Parts& parts, const Command& command, Moment /*now*/) {
    const float first = command.param(1);
    if (!parts.firmware.is_px4() || std::isnan(first) || first == -1) return parts.flight.start_mission(std::nullopt);
    const auto seq = command.whole(1, 0xffff);
    return seq ? parts.flight.start_mission(static_cast<std::uint16_t>(*seq)) : Outcome(Result::denied);
}

// Clients repeat the command until MISSION_CURRENT shows the item, so it goes out even if nothing changes.
Outcome set_current_item(Parts& parts, const Command& command, Moment /*now*/) {
    const bool resets = command.param(2) == 1;
    const bool keeps = command.param(1) == -1;
    const auto seq = command.whole(1, 0xffff);
    if (!keeps && !seq) return parts.firmware.is_px4() ? Result::failed : Result::denied;
    const std::optional item = keeps ? std::nullopt : std::optional(static_cast<std::uint16_t>(*seq));
    Outcome outcome = parts.flight.set_current_item(item, resets);
    if (outcome.is_accepted()) parts.on_mission_progress();
    return outcome;
}

// Jumps to the part of the mission that begins with this command as an item.
Outcome start_landing(Parts& parts, const Command& /*command*/, Moment /*now*/) {
    const auto items = parts.flight.plans().mission().items();
    const auto at = std::ranges::find(items, std::uint16_t{MAV_CMD_DO_LAND_START}, &PlanItem::command);
    if (at == items.end()) return parts.firmware.is_px4() ? Result::cancelled : Result::failed;
    const ModeInfo* const mode = parts.firmware.mode_for(Behaviour::mission);
    if (mode == nullptr) return Result::unsupported;
    const auto seq = static_cast<std::uint16_t>(at - items.begin());
    if (Outcome outcome = parts.flight.set_current_item(seq, false); !outcome.is_accepted()) return outcome;
    return parts.flight.set_mode(*mode, OrderedBy::client);
}

// --- Home, origin, region of interest, fence

std::optional<GeoPoint> whole_point(const Command& command, const Parts& parts) {
    const CommandPosition position = position_of(command, parts);
    if (std::isnan(position.latitude) || std::isnan(position.longitude) || std::isnan(command.z)) return std::nullopt;
    return GeoPoint{position.latitude, position.longitude, altitude_of(command, parts.flight)};
}

Outcome set_home(Parts& parts, const Command& command, Moment /*now*/) {
    if (command.param(1) >= 0.5f) return parts.flight.set_home(std::nullopt, nan);
    const auto point = whole_point(command, parts);
    return point ? parts.flight.set_home(*point, to_radians(double{command.param(4)})) : Outcome{Result::denied};
}

Outcome set_origin(Parts& parts, const Command& command, Moment /*now*/) {
    const auto point = whole_point(command, parts);
    return point ? set_global_origin(parts, *point) : Outcome{Result::denied};
}

Outcome set_roi_location(Parts& parts, const Command& command, Moment /*now*/) {
    const CommandPosition position = position_of(command, parts);
    if (std::isnan(position.latitude) || std::isnan(position.longitude)) return Result::denied;
    const double altitude = std::isnan(position.altitude) ? parts.flight.ground_altitude() : position.altitude;
    return parts.flight.set_roi(GeoPoint{position.latitude, position.longitude, altitude});
}

Outcome clear_roi(Parts& parts, const Command& /*command*/, Moment /*now*/) {
    return parts.flight.set_roi(std::nullopt);
}

// The older form: ROI mode first. ArduPilot ignores the mode; to it, no position means no region.
Outcome set_roi(Parts& parts, const Command& command, Moment now) {
    const bool has_position = !std::isnan(position_of(command, parts).latitude);
    const bool wants_position = parts.firmware.is_px4() ? command.param(1) == float{MAV_ROI_LOCATION} : has_position;
    return wants_position ? at_location<set_roi_location>(parts, command, now) : clear_roi(parts, command, now);
}

// ArduPilot keeps the state of the fence in a parameter.
Outcome enable_fence(Parts& parts, const Command& command, Moment /*now*/) {
    const auto enabled = command.whole(1, 2);
    if (!enabled) return Result::denied;
    if (!parts.firmware.is_px4()) parts.put_parameter("FENCE_ENABLE", *enabled == 1 ? 1 : 0);
    return parts.flight.enable_fence(*enabled == 1);
}

Outcome accept(Parts& /*parts*/, const Command& /*command*/, Moment /*now*/) { return Result::accepted; }

constexpr std::array flight_rows{
    CommandRow{MAV_CMD_COMPONENT_ARM_DISARM, arm_or_disarm},
    CommandRow{MAV_CMD_DO_FLIGHTTERMINATION, terminate},
    CommandRow{MAV_CMD_DO_SET_SAFETY_SWITCH_STATE, accept},

    CommandRow{MAV_CMD_DO_SET_MODE, set_mode},
    CommandRow{MAV_CMD_DO_SET_STANDARD_MODE, set_standard_mode, KnownBy::px4},
    CommandRow{MAV_CMD_NAV_LOITER_UNLIM, hold},
    CommandRow{MAV_CMD_NAV_TAKEOFF, at_location<take_off>},
    CommandRow{MAV_CMD_NAV_LAND, land},
    CommandRow{MAV_CMD_NAV_LAND_LOCAL, land, KnownBy::px4},  // PX4 lands with a beacon by this id
    CommandRow{MAV_CMD_NAV_RETURN_TO_LAUNCH, return_home},

    CommandRow{MAV_CMD_DO_REPOSITION, at_location<reposition>},
    CommandRow{MAV_CMD_DO_ORBIT, at_location<orbit>, KnownBy::px4},
    CommandRow{MAV_CMD_DO_PAUSE_CONTINUE, pause_or_continue},
    CommandRow{MAV_CMD_DO_CHANGE_ALTITUDE, change_altitude},
    CommandRow{MAV_CMD_DO_CHANGE_SPEED, change_speed},
    CommandRow{MAV_CMD_CONDITION_YAW, turn, KnownBy::ardupilot},
    CommandRow{MAV_CMD_GUIDED_CHANGE_SPEED, change_speed, KnownBy::ardupilot},
    CommandRow{MAV_CMD_GUIDED_CHANGE_ALTITUDE, at_location<guided_altitude>, KnownBy::ardupilot},
    CommandRow{MAV_CMD_GUIDED_CHANGE_HEADING, guided_heading, KnownBy::ardupilot},

    CommandRow{MAV_CMD_MISSION_START, start_mission},
    CommandRow{MAV_CMD_DO_SET_MISSION_CURRENT, set_current_item},
    CommandRow{MAV_CMD_DO_LAND_START, start_landing},
    CommandRow{MAV_CMD_DO_GO_AROUND, accept},

    CommandRow{MAV_CMD_DO_SET_HOME, at_location<set_home>},
    CommandRow{MAV_CMD_DO_SET_GLOBAL_ORIGIN, at_location<set_origin>},
    CommandRow{MAV_CMD_DO_SET_ROI_LOCATION, at_location<set_roi_location>},
    CommandRow{MAV_CMD_DO_SET_ROI_WPNEXT_OFFSET, clear_roi},
    CommandRow{MAV_CMD_DO_SET_ROI_NONE, clear_roi},
    CommandRow{MAV_CMD_DO_SET_ROI, set_roi},
    CommandRow{MAV_CMD_DO_FENCE_ENABLE, enable_fence},
};

}  // namespace

std::span<const CommandRow> flight_commands() noexcept { return flight_rows; }

}  // namespace mavloom::sim
