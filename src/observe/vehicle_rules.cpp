// SPDX-License-Identifier: MIT
#include "observe/vehicle_rules.hpp"

#include <fmt/format.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace mavloom::observe {

namespace {

using Kind = Alarm::Kind;
using Severity = Alarm::Severity;

struct Found {
    Severity severity;
    std::string text;
};

// Raises the alarm, or ends it if nothing was found.
void set(Alarms& alarms, const Alarms::Key& key, std::optional<Found> found, WallTime time) {
    if (!found) return alarms.clear(key, time);
    alarms.raise(key, {found->severity, std::move(found->text)}, time);
}

// The alarm ends some percent above the limit that began it.
std::optional<Found> low_percent(int percent, bool is_raised) {
    constexpr int low = 15, critical = 7, more_to_end = 2;
    if (percent < 0 || percent > low + (is_raised ? more_to_end : 0)) return std::nullopt;
    return Found{percent <= critical ? Severity::error : Severity::warning, fmt::format("battery at {} %", percent)};
}

std::optional<Found> bad_charge_state(std::uint8_t state) {
    // From MAV_BATTERY_CHARGE_STATE_LOW on.
    constexpr std::array<std::string_view, 5> states{"low", "critical", "in emergency", "failed", "unhealthy"};
    constexpr std::uint8_t first = 2;
    if (state < first || state - first >= int{states.size()}) return std::nullopt;
    return Found{state == first ? Severity::warning : Severity::error, std::string(states[state - first])};
}

// "3D_GYRO, GPS"
std::string names_of(std::uint32_t sensors, const dialect::Dialect& dialect) {
    constexpr std::string_view prefix = "MAV_SYS_STATUS_", more = "SENSOR_";
    const auto* const all = dialect.find_enum("MAV_SYS_STATUS_SENSOR");
    std::string names;
    for (int bit = 0; bit < 32; ++bit) {
        const auto value = std::uint32_t{1} << bit;
        if ((sensors & value) == 0) continue;
        const auto* const entry = all == nullptr ? nullptr : all->find(value);
        auto name = entry == nullptr ? fmt::format("bit {}", bit) : std::string(entry->name);
        for (const auto begin : {prefix, more})
            if (name.starts_with(begin)) name.erase(0, begin.size());
        names += (names.empty() ? "" : ", ") + name;
    }
    return names;
}

struct Ratio {
    std::string_view name;
    float value;
};

std::string over(std::span<const Ratio> ratios, float limit) {
    std::string text;
    for (const auto& ratio : ratios)
        if (ratio.value >= limit) text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", ratio.name, ratio.value);
    return text;
}

}  // namespace

void judge(Alarms& alarms, const Moment& at, const msg::Heartbeat& heartbeat) {
    constexpr std::uint8_t critical = 5, emergency = 6, termination = 8;  // MAV_STATE
    std::optional<Found> found;
    if (heartbeat.system_status == critical) found = {Severity::error, "fail-safe: the vehicle is in a critical state"};
    if (heartbeat.system_status == emergency) found = {Severity::error, "emergency: the vehicle has lost control"};
    if (heartbeat.system_status == termination) found = {Severity::error, "the vehicle terminates its flight"};
    set(alarms, {Kind::failsafe, at.source}, std::move(found), at.time);
}

std::uint32_t HealthRule::ready(const Moment& at, const msg::SysStatus& status) {
    constexpr auto all = ~std::uint32_t{0};
    auto sender = senders_.find(at.source);
    if (sender == senders_.end()) {
        if (senders_.size() >= max_senders) return all;
        sender = senders_.emplace(at.source, Sender{at.now, 0}).first;
    }
    auto& its = sender->second;
    its.healthy |= status.onboard_control_sensors_health;
    return at.now - its.first >= longest_boot ? all : its.healthy;
}

void HealthRule::judge(Alarms& alarms, const Moment& at, const msg::SysStatus& status, const dialect::Dialect& dialect) {
    constexpr std::uint32_t prearm_check = 1u << 28;  // before the flight it only means: not ready
    const auto bad = status.onboard_control_sensors_present & status.onboard_control_sensors_enabled &
                     ~status.onboard_control_sensors_health & ~prearm_check & ready(at, status);
    std::optional<Found> found;
    if (bad != 0) found = {Severity::warning, "not healthy: " + names_of(bad, dialect)};
    set(alarms, {Kind::health, at.source}, std::move(found), at.time);
}

void judge_battery(Alarms& alarms, const Moment& at, const msg::SysStatus& status) {
    const Alarms::Key battery{Kind::battery, at.source};
    set(alarms, battery, low_percent(status.battery_remaining, alarms.is_raised(battery)), at.time);
}

void judge(Alarms& alarms, const Moment& at, const msg::BatteryStatus& status) {
    constexpr std::uint8_t undefined = 0;
    const Alarms::Key key{Kind::battery, at.source, status.id_};
    auto found = status.charge_state == undefined ? low_percent(status.battery_remaining, alarms.is_raised(key))
                                                  : bad_charge_state(status.charge_state);
    if (found && status.charge_state != undefined) {
        const auto percent = status.battery_remaining < 0 ? "" : fmt::format(", at {} %", status.battery_remaining);
        found->text = fmt::format("battery is {}{}", found->text, percent);
    }
    if (found && status.id_ != 0) found->text.replace(0, 7, fmt::format("battery {}", status.id_));
    set(alarms, key, std::move(found), at.time);
}

void judge(Alarms& alarms, const Moment& at, const msg::EkfStatusReport& report) {
    constexpr float warns = 0.5F, fails = 0.8F;
    constexpr std::uint16_t attitude = 1, uninitialized = 1024;  // EKF_STATUS_FLAGS
    const std::array variances{
        Ratio{"velocity", report.velocity_variance}, Ratio{"horizontal position", report.pos_horiz_variance},
        Ratio{"vertical position", report.pos_vert_variance}, Ratio{"compass", report.compass_variance}};
    std::optional<Found> found;
    if (const auto text = over(variances, warns); !text.empty())
        found = {over(variances, fails).empty() ? Severity::warning : Severity::error, "EKF variance: " + text};
    else if ((report.flags & uninitialized) == 0 && (report.flags & attitude) == 0)
        found = {Severity::error, "EKF has no good attitude"};
    set(alarms, {Kind::ekf, at.source}, std::move(found), at.time);
}

void judge(Alarms& alarms, const Moment& at, const msg::EstimatorStatus& status) {
    constexpr std::uint16_t gps_glitch = 1024, accel_error = 2048;  // ESTIMATOR_STATUS_FLAGS
    const std::array ratios{Ratio{"velocity", status.vel_ratio},
                            Ratio{"horizontal position", status.pos_horiz_ratio},
                            Ratio{"vertical position", status.pos_vert_ratio},
                            Ratio{"magnetometer", status.mag_ratio},
                            Ratio{"height above ground", status.hagl_ratio},
                            Ratio{"airspeed", status.tas_ratio}};
    std::optional<Found> found;
    if (const auto text = over(ratios, 1.0F); !text.empty()) found = {Severity::warning, "estimator rejects: " + text};
    if ((status.flags & gps_glitch) != 0) found = {Severity::warning, "estimator: GPS glitch"};
    if ((status.flags & accel_error) != 0) found = {Severity::error, "estimator: bad accelerometer"};
    set(alarms, {Kind::ekf, at.source}, std::move(found), at.time);
}

void TextRule::judge(Alarms& alarms, const Moment& at, const msg::Statustext& text) {
    constexpr std::uint8_t error = 3, warning = 4;  // MAV_SEVERITY
    if (text.severity > warning) return;
    if (!joiner_.add(at.source, text)) key_ = {Kind::text, at.source, std::hash<std::string_view>{}(joiner_.text())};
    const auto severity = text.severity <= error ? Severity::error : Severity::warning;
    alarms.happened(key_, {severity, joiner_.text()}, at.time, at.now);
}

}  // namespace mavloom::observe
