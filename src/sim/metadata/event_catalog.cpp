// SPDX-License-Identifier: MIT
#include "sim/metadata/event_catalog.hpp"

#include <algorithm>
#include <array>

namespace mavloom::sim {

namespace {

// Log levels, internal and external alike.
constexpr std::uint8_t log_critical = 0x22, log_error = 0x33, log_warning = 0x44, log_notice = 0x55, log_info = 0x66,
                       log_protocol = 0x88;

constexpr std::array<EventArgument, 2> health_problem{
    {{"modes", "navigation_mode_group_t"}, {"health_component_index", "uint8_t"}}};
constexpr std::array<EventArgument, 3> instance_problem{
    {{"modes", "navigation_mode_group_t"}, {"health_component_index", "uint8_t"}, {"arg0", "uint8_t"}}};
constexpr std::array<EventArgument, 5> arming_summary{{{"chunk_idx", "uint8_t"},
                                                       {"error", "px4::health_component_t"},
                                                       {"warning", "px4::health_component_t"},
                                                       {"can_arm", "px4::navigation_mode_group_t"},
                                                       {"can_run", "px4::navigation_mode_group_t"}}};
constexpr std::array<EventArgument, 4> health_arguments{{{"chunk_idx", "uint8_t"},
                                                         {"is_present", "px4::health_component_t"},
                                                         {"error", "px4::health_component_t"},
                                                         {"warning", "px4::health_component_t"}}};
constexpr std::array<EventArgument, 1> arming_reason{{{"arg0", "px4::arm_disarm_reason_t"}}};
constexpr std::array<EventArgument, 1> one_float{{{"arg0", "float"}}};
constexpr std::array<EventArgument, 2> two_integers{{{"arg0", "int32_t"}, {"arg1", "int32_t"}}};
constexpr std::array<EventArgument, 6> date_arguments{{{"arg0", "uint16_t"},
                                                       {"arg1", "uint8_t"},
                                                       {"arg2", "uint8_t"},
                                                       {"arg3", "uint8_t"},
                                                       {"arg4", "uint8_t"},
                                                       {"arg5", "uint8_t"}}};

constexpr std::string_view arming = "arming_check", health = "health", general = "default";

constexpr EventInfo catalog[] = {
    {event_id::arming_check_summary, log_protocol, arming, "commander_arming_check_summary",
     "Arming check summary event", arming_summary, "summary"},
    {event_id::health_summary, log_protocol, health, "commander_health_summary", "Health report summary event",
     health_arguments, "summary"},
    // Problems of a report
    {event_id::no_heading,
     log_error,
     arming,
     "check_estimator_heading_no_source",
     "No heading reference",
     health_problem,
     {},
     "The estimator has not aligned its heading yet."},
    {event_id::no_attitude,
     log_critical,
     arming,
     "check_modes_attitude",
     "No valid attitude estimate",
     health_problem,
     {},
     "Wait until the estimator has started."},
    {event_id::no_local_position,
     log_error,
     arming,
     "check_modes_local_pos",
     "Navigation error: No valid position estimate",
     health_problem,
     {},
     "The mode needs a position."},
    {event_id::no_global_position,
     log_error,
     arming,
     "check_modes_global_pos",
     "Navigation error: No valid global position estimate",
     health_problem,
     {},
     "The mode needs a global position."},
    {event_id::no_offboard_signal,
     log_error,
     arming,
     "check_modes_offboard_signal_lost",
     "No offboard signal",
     health_problem,
     {},
     "No set-points arrive."},
    {event_id::no_mission,
     log_info,
     arming,
     "check_modes_mission",
     "No valid mission available",
     health_problem,
     {},
     "Upload a mission first."},
    {event_id::no_manual_control,
     log_warning,
     arming,
     "check_modes_manual_control",
     "No manual control input",
     health_problem,
     {},
     "Send MANUAL_CONTROL, or choose a mode that needs no sticks."},
    {event_id::no_ground_station, log_info, arming, "check_rc_dl_no_dllink",
     "No connection to the ground control station", health_problem},
    {event_id::battery_low, log_warning, arming, "check_battery_low", "Low battery", health_problem},
    {event_id::battery_critical, log_critical, arming, "check_battery_critical", "Critical battery", health_problem},
    {event_id::battery_emergency, log_critical, arming, "check_battery_emergency", "Emergency battery level",
     health_problem},
    {event_id::terminated, log_critical, arming, "check_system_flight_term_active", "Flight termination active",
     health_problem},
    {event_id::no_arming_in_mode, log_error, arming, "check_modes_cannot_takeoff", "Mode not suitable for arming",
     health_problem},
    {event_id::gps_offline, log_critical, health, "check_gnss_receiver_offline", "GPS {3} offline", instance_problem},
    {event_id::gyro_missing, log_critical, health, "check_gyro_missing", "Gyro sensor {3} missing", instance_problem},
    {event_id::accelerometer_missing, log_critical, health, "check_accel_missing", "Accelerometer sensor {3} missing",
     instance_problem},
    {event_id::magnetometer_missing, log_critical, health, "check_mag_missing", "Compass sensor {3} missing",
     instance_problem},
    {event_id::barometer_missing, log_critical, health, "check_baro_missing", "Barometer {3} missing", instance_problem},
    // Events of a flight
    {26266355, log_info, general, "commander_armed_by", "Armed by {1}", arming_reason},
    {32794487, log_info, general, "commander_disarmed_by", "Disarmed by {1}", arming_reason},
    {21054825, log_info, general, "commander_takeoff_detected", "Takeoff detected"},
    {26622124, log_info, general, "commander_landing_detected", "Landing detected"},
    {20262116, log_info, general, "commander_rtl", "Returning to launch"},
    {20099806, log_info, general, "commander_landing_current_pos", "Landing at current position"},
    {22161044, log_info, general, "vrtl_return_at", "RTL: start return at {1m_v} ({2m_v} above destination)",
     two_integers},
    {16962474, log_info, general, "rtl_land_at_destination", "RTL: land at destination"},
    {32375217, log_info, general, "mission_execute", "Executing Mission"},
    {24986204, log_info, general, "mission_climb_before_start", "Climb to {1:.1m_v} above home", one_float},
    {24580612, log_info, general, "mission_finished", "Mission finished, landed"},
    {21455606, log_info, general, "mission_finished_loiter", "Mission finished, loitering"},
    {27571288, log_notice, general, "commander_gcs_lost", "Connection to ground control station lost"},
    {31011876, log_info, general, "commander_dl_regained", "GCS connection regained"},
    {22400324, log_critical, general, "commander_rc_lost", "Manual control lost"},
    {23844490, log_critical, general, "commander_mission_start_denied_no_mission",
     "Mission start denied! No valid mission"},
    {25868725, log_critical, general, "commander_disarm_denied_not_landed", "Disarming denied: not landed"},
    {16910493, log_critical, general, "commander_arm_denied_resolve_failures",
     "Arming denied: Resolve system health failures first"},
    {18843603, log_critical, general, "commander_arm_denied_calibrating", "Arming denied: calibrating"},
    {19098816, log_critical, general, "navigator_takeoff_already_higher",
     "Already higher than takeoff altitude (not descending)"},
    {28993875, log_warning, general, "commander_failsafe_enter_low_bat", "Low battery level, return advised"},
    {19252160, log_critical, general, "commander_failsafe_enter_crit_bat_warn", "Critical battery level, land now"},
    {16828543, log_critical, general, "commander_failsafe_enter_crit_low_bat_warn",
     "Emergency battery level, land immediately"},
    {event_id::log_opened, log_info, general, "logger_open_file_time",
     "logging: opening log file {1}-{2}-{3}/{4}_{5}_{6}.ulg", date_arguments},
};

// Values of arm_disarm_reason_t.
constexpr std::uint8_t by_client = 4, by_mission = 5, by_landing = 6, by_inaction = 7, by_kill = 8, by_failsafe = 14;

constexpr EventText catalog_texts[] = {
    {"Armed by external command", 26266355, by_client},
    {"Armed by mission start", 26266355, by_mission},
    {"Disarmed by external command", 32794487, by_client},
    {"Disarmed by landing", 32794487, by_landing},
    {"Disarmed by auto preflight disarming", 32794487, by_inaction},
    {"Disarmed by kill switch", 32794487, by_kill},
    {"Disarmed by failsafe", 32794487, by_failsafe},
    {"Takeoff detected", 21054825},
    {"Landing detected", 26622124},
    {"Returning to launch", 20262116},
    {"Landing at current position", 20099806},
    {"RTL: start return at {} m ({} m above destination)", 22161044},
    {"RTL: land at destination", 16962474},
    {"Executing Mission", 32375217},
    {"Climb to {} meters above home", 24986204},
    {"Mission finished, landed", 24580612},
    {"Mission finished, loitering", 21455606},
    {"Connection to ground control station lost", 27571288},
    {"GCS connection regained", 31011876},
    {"Manual control lost", 22400324},
    {"Disarming denied: not landed", 25868725},
    {"Arming denied: Resolve system health failures first", 16910493},
    {"Arming denied: calibrating", 18843603},
    {"Mission start denied! No valid mission", 23844490},
    {"Already higher than takeoff altitude (not descending)", 19098816},
    {"Low battery level, return advised", 28993875},
    {"Critical battery level, land now", 19252160},
    {"Emergency battery level, land immediately", 16828543},
};

constexpr NavigationGroup groups[] = {
    {0, 0x00010000, "manual", "Manual"},
    {1, 0x00020000, "altctl", "Altitude"},
    {2, 0x00030000, "posctl", "Position"},
    {3, 0x04040000, "mission", "Mission"},
    {4, 0x03040000, "loiter", "Hold"},
    {5, 0x05040000, "rtl", "Return"},
    {6, 0x02030000, "position_slow", "Position Slow"},
    {7, 0x13040000, "course", "Guided Course"},
    {8, 0x000b0000, "altitude_cruise", "Altitude Cruise"},
    {10, 0x00050000, "acro", "Acro"},
    {12, 0x14040000, "descend", "Descend"},
    {14, 0x00060000, "offboard", "Offboard"},
    {15, 0x00070000, "stab", "Stabilized"},
    {17, 0x02040000, "takeoff", "Takeoff"},
    {18, 0x06040000, "land", "Land"},
    {19, 0x08040000, "follow_target", "Follow Target"},
    {20, 0x09040000, "precland", "Precision Landing"},
    {21, 0x01030000, "orbit", "Orbit"},
    {22, 0x0a040000, "vtol_takeoff", "VTOL Takeoff"},
    {23, 0x0b040000, "external1", "External 1"},
    {24, 0x0c040000, "external2", "External 2"},
    {25, 0x0d040000, "external3", "External 3"},
    {26, 0x0e040000, "external4", "External 4"},
    {27, 0x0f040000, "external5", "External 5"},
    {28, 0x10040000, "external6", "External 6"},
    {29, 0x11040000, "external7", "External 7"},
    {30, 0x12040000, "external8", "External 8"},
};

constexpr std::array group_entries = [] {
    std::array<EventEnumEntry, std::size(groups)> entries{};
    for (std::size_t i = 0; i < entries.size(); ++i)
        entries[i] = {1u << groups[i].index, groups[i].name, groups[i].description};
    return entries;
}();
constexpr EventEnumEntry health_entries[] = {
    {1, "none", "None"},
    {health_absolute_pressure, "absolute_pressure", "Absolute pressure"},
    {1u << 2, "differential_pressure", "Differential pressure"},
    {health_gps, "gps", "GPS"},
    {health_remote_control, "remote_control", "Remote control (RC or joystick)"},
    {health_motors, "motors_escs", "Motors"},
    {health_logging, "logging", "Logging"},
    {health_battery, "battery", "Battery"},
    {health_communication, "communication_links", "Communication links"},
    {health_attitude, "attitude_estimate", "Attitude estimate"},
    {health_local_position, "local_position_estimate", "Local position estimate"},
    {1u << 18, "mission", "Mission"},
    {health_system, "system", "System"},
    {health_global_position, "global_position_estimate", "Global position estimate"},
    {health_magnetometer, "magnetometer", "Magnetometer"},
    {health_accelerometer, "accel", "Accelerometer"},
    {health_gyro, "gyro", "Gyroscope"},
};
constexpr EventEnumEntry reason_entries[] = {
    {1, "stick_gesture", "stick gesture"},
    {2, "rc_switch", "RC switch"},
    {3, "command_internal", "internal command"},
    {by_client, "command_external", "external command"},
    {by_mission, "mission_start", "mission start"},
    {by_landing, "landing", "landing"},
    {by_inaction, "preflight_inaction", "preflight inaction"},
    {by_kill, "kill_switch", "kill switch"},
    {by_failsafe, "failsafe", "failsafe"},
};
constexpr EventEnum enums[] = {
    {"health_component_t", "uint32_t", true, health_entries},
    {"navigation_mode_group_t", "uint32_t", true, group_entries},
    {"arm_disarm_reason_t", "uint8_t", false, reason_entries},
};

}  // namespace

std::span<const EventInfo> event_infos() noexcept { return catalog; }

const EventInfo* find_event(std::uint32_t id) noexcept {
    const auto at = std::ranges::find(catalog, id, &EventInfo::id);
    return at == std::end(catalog) ? nullptr : at;
}

std::span<const EventText> event_texts() noexcept { return catalog_texts; }

std::span<const NavigationGroup> navigation_groups() noexcept { return groups; }

std::span<const EventEnum> event_enums() noexcept { return enums; }

}  // namespace mavloom::sim
