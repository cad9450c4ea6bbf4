// SPDX-License-Identifier: MIT
// Commands for what the vehicle carries: gimbal, servos, relays, logs. Cameras, grippers and winches are not simulated,
// so their commands have no row here and are answered UNSUPPORTED at once; PX4 leaves some of them without any answer.
#include <algorithm>
#include <array>
#include <cmath>

#include "mavloom/msg/enums/mav_cmd.hpp"
#include "sim/command/commands.hpp"
#include "sim/parts.hpp"
#include "sim/payload/gimbal.hpp"
#include "sim/store/log_service.hpp"

namespace mavloom::sim {

namespace {

Outcome gimbal_pitch_yaw(Parts& parts, const Command& command, Moment /*now*/) {
    return parts.gimbal ? parts.gimbal->set_pitch_yaw(command) : Result::unsupported;
}

Outcome gimbal_configure(Parts& parts, const Command& command, Moment /*now*/) {
    return parts.gimbal ? parts.gimbal->configure(command) : Result::unsupported;
}

Outcome mount_configure(Parts& parts, const Command& /*command*/, Moment /*now*/) {
    return parts.gimbal ? Result::accepted : Result::unsupported;
}

Outcome mount_control(Parts& parts, const Command& command, Moment /*now*/) {
    if (!parts.gimbal) return Result::unsupported;
    return parts.gimbal->mount_control(command.param(1), command.param(3), command.param(7));
}

// Parameter 7 counts sets of six actuators; the vehicle has one set.
Outcome set_actuator(Parts& parts, const Command& command, Moment /*now*/) {
    if (command.param(7) != 0 && std::isfinite(command.param(7))) return Result::denied;
    for (std::size_t i = 0; i < ServoOutputs::actuators; ++i) parts.servos.set_actuator(i, command.param(i + 1));
    return Result::accepted;
}

// ArduPilot refuses a channel that the vehicle itself drives.
Outcome set_servo(Parts& parts, const Command& command, Moment /*now*/) {
    if (command.param(1) <= parts.flight.plant().channels().used) return Result::failed;
    return parts.servos.set_pulse(command.param(1), command.param(2)) ? Result::accepted : Result::failed;
}

Outcome set_relay(Parts& parts, const Command& command, Moment /*now*/) {
    return parts.servos.set_relay(command.param(1), command.param(2)) ? Result::accepted : Result::failed;
}

// Tests of single motors, and changes of their direction, are for a vehicle whose propellers may not turn by
// themselves.
Outcome only_disarmed(Parts& parts, const Command& /*command*/, Moment /*now*/) {
    return parts.flight.armed() ? Result::denied : Result::accepted;
}

Outcome start_logging(Parts& parts, const Command& command, Moment now) {
    return parts.log_service->start_stream(command.from, now);
}

Outcome stop_logging(Parts& parts, const Command& command, Moment /*now*/) {
    return parts.log_service->stop_stream(command.from);
}

constexpr std::array payload_rows{
    CommandRow{msg::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, gimbal_pitch_yaw},
    CommandRow{msg::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, gimbal_configure},
    CommandRow{msg::MAV_CMD_DO_MOUNT_CONFIGURE, mount_configure, KnownBy::ardupilot},
    CommandRow{msg::MAV_CMD_DO_MOUNT_CONTROL, mount_control, KnownBy::ardupilot},
    CommandRow{msg::MAV_CMD_DO_SET_ACTUATOR, set_actuator, KnownBy::px4},
    CommandRow{msg::MAV_CMD_DO_SET_SERVO, set_servo, KnownBy::ardupilot},
    CommandRow{msg::MAV_CMD_DO_SET_RELAY, set_relay, KnownBy::ardupilot},
    CommandRow{msg::MAV_CMD_DO_MOTOR_TEST, only_disarmed, KnownBy::ardupilot},
    CommandRow{msg::MAV_CMD_ACTUATOR_TEST, only_disarmed, KnownBy::px4},
    CommandRow{msg::MAV_CMD_CONFIGURE_ACTUATOR, only_disarmed, KnownBy::px4},
    CommandRow{msg::MAV_CMD_LOGGING_START, start_logging, KnownBy::px4},
    CommandRow{msg::MAV_CMD_LOGGING_STOP, stop_logging, KnownBy::px4},
};

}  // namespace

std::span<const CommandRow> payload_commands() noexcept { return payload_rows; }

void carry_out_payload_item(Parts& parts, const PlanItem& item) {
    const auto row = std::ranges::find(payload_rows, item.command, &CommandRow::id);
    const bool is_logging = item.command == msg::MAV_CMD_LOGGING_START || item.command == msg::MAV_CMD_LOGGING_STOP;
    if (row == payload_rows.end() || is_logging) return;
    Command command{.from = {.link = {}, .id = {parts.options.system, autopilot_component}}, .id = item.command};
    const auto& p = item.params;
    command.params = {p[0], p[1], p[2], p[3], static_cast<float>(item.x), static_cast<float>(item.y), item.z};
    (void)row->carry_out(parts, command, parts.now);
}

}  // namespace mavloom::sim
