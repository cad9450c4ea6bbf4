// SPDX-License-Identifier: MIT
// Commands for the ground: reboot, storage, checks, calibration, failures, automatic tuning.
#include <algorithm>
#include <array>
#include <cmath>

#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "sim/calibration/calibration.hpp"
#include "sim/calibration/compass_calibration.hpp"
#include "sim/command/commands.hpp"
#include "sim/parts.hpp"
#include "sim/service/events.hpp"
#include "sim/store/parameter_service.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

// 1 boots again, 2 shuts down. The magic number forces it in the air.
Outcome reboot_or_shut_down(Parts& parts, const Command& command, Moment /*now*/) {
    constexpr float force = 20190226;
    const float action = command.param(1);
    if (action == 0) return Result::accepted;
    if (parts.flight.armed() && command.param(6) != force) return Result::denied;
    if (action != 1 && action != 2) return Result::denied;
    parts.reboot(action == 1);
    return Result::accepted;
}

// 0 loads, 1 saves, 2 and 4 reset everything, 3 resets the calibration. Values are kept as long as the simulator runs.
Outcome use_storage(Parts& parts, const Command& command, Moment /*now*/) {
    if (parts.flight.armed()) return Result::temporarily_rejected;
    const float action = command.param(1);
    if (action == 2 || action == 4) parts.parameter_service->reset();
    if (action == 3) parts.parameter_service->reset(parts.firmware.is_px4() ? "CAL_" : "INS_");
    const bool is_known = action == 0 || action == 1 || action == 2 || action == 3 || action == 4;
    return is_known ? Result::accepted : Result::denied;
}

Outcome run_checks(Parts& parts, const Command& /*command*/, Moment /*now*/) {
    parts.event_service->report_health();
    parts.streams.send_now(parts.view(), std::array{SysStatus::id});
    return Result::accepted;
}

Outcome calibrate(Parts& parts, const Command& command, Moment now) {
    return parts.calibration_service->begin(command, now);
}

Outcome confirm_position(Parts& parts, const Command& command, Moment now) {
    return parts.calibration_service->confirm(command.from, now) ? Result::accepted : Result::denied;
}

Outcome start_compass_calibration(Parts& parts, const Command& command, Moment now) {
    return parts.compass_calibration->start(command, now);
}

Outcome accept_compass_calibration(Parts& parts, const Command& command, Moment now) {
    return parts.compass_calibration->accept(command, now);
}

Outcome cancel_compass_calibration(Parts& parts, const Command& command, Moment /*now*/) {
    return parts.compass_calibration->cancel(command);
}

Outcome calibrate_compass_by_heading(Parts& parts, const Command& command, Moment /*now*/) {
    return parts.compass_calibration->calibrate_by_heading(command);
}

// The instances that the command addresses: by number, or without one (NaN) as bits.
std::uint16_t failing_instances(const Command& command) noexcept {
    if (std::isfinite(command.param(3))) return FailureTable::instance(command.whole(3).value_or(17));
    return static_cast<std::uint16_t>(command.whole(4, FailureTable::all_instances).value_or(0));
}

Outcome inject_failure(Parts& parts, const Command& command, Moment /*now*/) {
    const auto unit = command.whole(1), type = command.whole(2);
    if (!parts.flight.tuning().may_inject_failures || !unit || !type) return Result::denied;
    const std::uint16_t instances = failing_instances(command);
    const Result result = parts.failures.inject(*unit, *type, instances);
    if (result != Result::accepted || instances == 0) return result;
    Failures failures = parts.failures.failures();
    failures.wrong_fix = static_cast<std::uint8_t>(std::clamp(parts.parameters.get("SYS_FAIL_GPS_WRG", 2), 0.0, 8.0));
    parts.on_text(Severity::warning, FailureTable::text(*unit, *type, instances));
    return parts.flight.inject_failures(failures);
}

// --- Automatic tuning

bool can_tune(const Parts& parts) { return parts.flight.armed() && parts.flight.landed() == LandedState::in_air; }

// Only a pretence: the vehicle's controllers need no tuning.
Outcome tune(Parts& parts, const Command& command, Moment now) {
    constexpr Nanoseconds length = std::chrono::seconds{10};
    if (command.param(1) != 1) return Result::denied;
    if (!can_tune(parts)) return Result::temporarily_rejected;
    return parts.commands.begin(command, length, can_tune, now);
}

Outcome send_banner(Parts& parts, const Command& /*command*/, Moment now) {
    parts.announcer.say(Severity::info, parts.firmware.texts().banner, now.flight);
    return Result::accepted;
}

constexpr std::array maintenance_rows{
    CommandRow{MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, reboot_or_shut_down},
    CommandRow{MAV_CMD_PREFLIGHT_STORAGE, use_storage},
    CommandRow{MAV_CMD_RUN_PREARM_CHECKS, run_checks},
    CommandRow{MAV_CMD_PREFLIGHT_CALIBRATION, calibrate},
    CommandRow{MAV_CMD_ACCELCAL_VEHICLE_POS, confirm_position, KnownBy::ardupilot},
    CommandRow{MAV_CMD_DO_START_MAG_CAL, start_compass_calibration, KnownBy::ardupilot},
    CommandRow{MAV_CMD_DO_ACCEPT_MAG_CAL, accept_compass_calibration, KnownBy::ardupilot},
    CommandRow{MAV_CMD_DO_CANCEL_MAG_CAL, cancel_compass_calibration, KnownBy::ardupilot},
    CommandRow{MAV_CMD_FIXED_MAG_CAL_YAW, calibrate_compass_by_heading, KnownBy::ardupilot},
    CommandRow{MAV_CMD_INJECT_FAILURE, inject_failure, KnownBy::px4},
    CommandRow{MAV_CMD_DO_AUTOTUNE_ENABLE, tune, KnownBy::px4},
    CommandRow{MAV_CMD_DO_SEND_BANNER, send_banner, KnownBy::ardupilot},
};

}  // namespace

std::span<const CommandRow> maintenance_commands() noexcept { return maintenance_rows; }

}  // namespace mavloom::sim
