// SPDX-License-Identifier: MIT
// Alarms from what a vehicle reports of itself. Private to module observe. The limits are vehicles' own:
// - Battery: PX4's defaults of BAT_LOW_THR (15 %) and BAT_CRIT_THR (7 %), src/lib/battery/module.yaml. A vehicle that
//   sends BATTERY_STATUS.charge_state judges by its own limits.
// - EKF_STATUS_REPORT: ArduPilot's default of FS_EKF_THRESH (0.8), from which its fail-safe acts; Mission Planner warns
//   from 0.5 on.
// - ESTIMATOR_STATUS: PX4's estimator rejects a measurement if its test ratio is above 1 (definition of the message).
// - HEARTBEAT: MAV_STATE_CRITICAL is a fail-safe in flight, MAV_STATE_EMERGENCY a vehicle that is out of control.
// - SYS_STATUS: a sensor that is present and enabled, but not healthy, as QGroundControl judges. A vehicle that boots
//   has sensors that are not ready yet: they are alarms after 30 s, our own choice, or if they were healthy before.
// - STATUSTEXT: severities from MAV_SEVERITY_EMERGENCY to MAV_SEVERITY_WARNING.
#pragma once

#include <cstdint>
#include <map>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/ekf_status_report.hpp"
#include "mavloom/msg/estimator_status.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/statustext.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "mavloom/observe/alarm.hpp"
#include "observe/text_joiner.hpp"

namespace mavloom::observe {

struct Moment {
    Source source;
    WallTime time;
    MonoTime now;
};

void judge(Alarms& alarms, const Moment& at, const msg::Heartbeat& heartbeat);
// Call it if the vehicle sends no BATTERY_STATUS.
void judge_battery(Alarms& alarms, const Moment& at, const msg::SysStatus& status);
void judge(Alarms& alarms, const Moment& at, const msg::BatteryStatus& status);
void judge(Alarms& alarms, const Moment& at, const msg::EkfStatusReport& report);
void judge(Alarms& alarms, const Moment& at, const msg::EstimatorStatus& status);

// Remembers which sensors were healthy.
class HealthRule {
public:
    void judge(Alarms& alarms, const Moment& at, const msg::SysStatus& status, const dialect::Dialect& dialect);

private:
    static constexpr std::size_t max_senders = 4096;  // further ones count as booted
    static constexpr Nanoseconds longest_boot = std::chrono::seconds(30);
    struct Sender {
        MonoTime first;
        std::uint32_t healthy;  // at any time
    };
    // The sensors that should be healthy by now.
    [[nodiscard]] std::uint32_t ready(const Moment& at, const msg::SysStatus& status);

    std::map<Source, Sender> senders_;
};

// Texts in several messages are one alarm.
class TextRule {
public:
    void judge(Alarms& alarms, const Moment& at, const msg::Statustext& text);

private:
    TextJoiner joiner_;
    Alarms::Key key_{Alarm::Kind::text};
};

}  // namespace mavloom::observe
