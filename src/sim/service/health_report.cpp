// SPDX-License-Identifier: MIT
#include "sim/service/health_report.hpp"

#include <bit>

#include "sim/metadata/event_catalog.hpp"
#include "sim/store/log_service.hpp"

namespace mavloom::sim {

namespace {

// Groups of bits of navigation_mode_group_t, as PX4 sets them together.
constexpr std::uint32_t always = 0x80012a00;       // bits without a mode
constexpr std::uint32_t by_attitude = 0x1000;      // Descend
constexpr std::uint32_t by_position = 0x007e00b0;  // Hold, Return, Takeoff, Land, Orbit ...
constexpr std::uint32_t by_sticks = 0x8503, by_sticks_and_position = 0x44;
constexpr std::uint32_t mission_mode = 1u << 3, offboard_mode = 1u << 14;
// The modes that PX4 names with each problem.
constexpr std::uint32_t all_modes = 0xffffffff;
constexpr std::uint32_t attitude_modes = 0x007ed1fe, local_modes = 0x007e00fc, global_modes = 0x38;

std::uint8_t number_of(HealthComponent component) noexcept {
    return static_cast<std::uint8_t>(std::countr_zero(static_cast<std::uint32_t>(component)));
}

class Examiner {
public:
    Examiner(const Flight& flight, bool has_audience) noexcept
        : flight_(flight), has_audience_(has_audience), unready_(flight.unready()) {}

    HealthReport examine() {
        report_.present = health_absolute_pressure | health_motors | health_battery | health_local_position |
                          health_magnetometer | health_accelerometer | health_gyro;
        // PX4 records from boot on, until the end of the first flight; later from arming to disarming.
        if (flight_.armed() || flight_.flights() == 0) report_.present |= health_logging;
        if (has_audience_) report_.present |= health_communication;
        // The estimate of the attitude is ready with the first fix, that of the position at the end of the start.
        constexpr std::uint8_t three_dimensions = 3;
        const bool has_fix = flight_.sensors().gps().fix_type >= three_dimensions;
        const bool is_booting = (unready_ & unready_booting) != 0;
        const bool has_attitude = !is_booting || has_fix;
        const bool has_position = !is_booting && flight_.sensors().has_position() && flight_.home().has_value();
        if (has_fix) report_.present |= health_gps;
        find_runnable(has_attitude, has_position);
        find_problems(has_attitude, has_position);
        find_failures(flight_.sensors().failures());
        return report_;
    }

private:
    void find_runnable(bool has_attitude, bool has_position) {
        std::uint32_t modes = always;
        if (has_attitude) modes |= by_attitude;
        if (has_position) modes |= by_position;
        if (has_position && !flight_.plans().mission().empty()) modes |= mission_mode;
        if (has_attitude && flight_.has_sticks()) modes |= by_sticks;
        if (has_position && flight_.has_sticks()) modes |= by_sticks_and_position;
        if (has_offboard()) modes |= offboard_mode;
        report_.can_run = report_.can_arm = modes;
    }

    void find_problems(bool has_attitude, bool has_position) {
        if (!has_attitude) add(event_id::no_heading, local_modes, health_local_position);
        if (!has_offboard()) add(event_id::no_offboard_signal, offboard_mode, health_system);
        if (!has_attitude) add(event_id::no_attitude, attitude_modes, health_attitude);
        if (!has_position) add(event_id::no_local_position, local_modes, health_local_position);
        if (!has_position) add(event_id::no_global_position, global_modes, health_global_position);
        if (flight_.plans().mission().empty()) add(event_id::no_mission, mission_mode, health_system);
        if (!flight_.has_sticks()) add(event_id::no_manual_control, all_modes, health_remote_control);
        if (!has_audience_) add(event_id::no_ground_station, all_modes, health_communication);
        if ((unready_ & unready_terminated) != 0) add(event_id::terminated, all_modes, health_system);
        if (has_position && (unready_ & unready_mode) != 0) add(event_id::no_arming_in_mode, all_modes, health_system);
        find_battery_problem(flight_.battery().remaining());
        constexpr std::uint32_t by_modes = unready_booting | unready_position | unready_home;  // in can_run already
        if (has_position && (unready_ & ~by_modes) != 0) report_.can_arm = 0;
    }

    void find_battery_problem(double share) {
        const Tuning& tuning = flight_.tuning();
        if (share < tuning.battery_emergency) return add(event_id::battery_emergency, all_modes, health_battery);
        if (share < tuning.battery_critical) return add(event_id::battery_critical, all_modes, health_battery);
        if (share < tuning.battery_low) add(event_id::battery_low, all_modes, health_battery);
    }

    void find_failures(const Failures& failures) {
        if (failures.gps == Failure::off) add_failure(event_id::gps_offline, health_gps);
        if (is_frozen(failures.gyroscope)) add_failure(event_id::gyro_missing, health_gyro);
        if (is_frozen(failures.accelerometer)) add_failure(event_id::accelerometer_missing, health_accelerometer);
        if (is_frozen(failures.magnetometer)) add_failure(event_id::magnetometer_missing, health_magnetometer);
        if (is_frozen(failures.barometer)) add_failure(event_id::barometer_missing, health_absolute_pressure);
    }

    [[nodiscard]] bool has_offboard() const noexcept { return flight_.mode().behaviour == Behaviour::offboard; }

    // The level of the event decides whether the component has an error or a warning.
    void add(std::uint32_t event, std::uint32_t modes, HealthComponent component) {
        constexpr unsigned error_level = 3, warning_level = 4;
        const EventInfo* const info = find_event(event);
        const unsigned level = info == nullptr ? 7u : info->log_levels & 0xfu;
        if (level <= error_level) report_.arming_errors |= component;
        if (level == warning_level) report_.arming_warnings |= component;
        append({event, modes, number_of(component)});
    }
    void add_failure(std::uint32_t event, HealthComponent component) {
        report_.present &= ~std::uint32_t{component};
        report_.health_errors |= component;
        append({event, all_modes, number_of(component), true});
    }
    void append(const HealthProblem& problem) {
        if (report_.count < report_.problems.size()) report_.problems[report_.count++] = problem;
    }

    const Flight& flight_;
    const bool has_audience_;
    std::uint32_t unready_;
    HealthReport report_;
};

}  // namespace

HealthReport health_report(const flight::Flight& flight, bool has_audience) {
    return Examiner(flight, has_audience).examine();
}

}  // namespace mavloom::sim
