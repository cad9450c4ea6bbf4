// SPDX-License-Identifier: MIT
#include "sim/telemetry/profiles.hpp"

#include <array>

namespace mavloom::sim {

namespace {

using enum When;

// Message ids, as far as profiles need them.
constexpr MessageId heartbeat{0}, sys_status{1}, system_time{2}, ping{4}, link_node_status{8}, gps_raw_int{24},
    raw_imu{27}, scaled_pressure{29}, attitude{30}, attitude_quaternion{31}, local_position_ned{32},
    global_position_int{33}, servo_output_raw{36}, mission_current{42}, nav_controller_output{62}, rc_channels{65},
    vfr_hud{74}, attitude_target{83}, position_target_local_ned{85}, position_target_global_int{87}, highres_imu{105},
    timesync{111}, scaled_imu2{116}, power_status{125}, scaled_imu3{129}, distance_sensor{132}, terrain_report{136},
    actuator_control_target{140}, altitude{141}, battery_status{147}, meminfo{152}, fence_status{162}, ahrs{163},
    simstate{164}, wind_message{168}, rangefinder{173}, ahrs2{178}, ekf_status_report{193}, estimator_status{230},
    wind_cov{231}, vibration{241}, home_position{242}, extended_sys_state{245}, adsb_vehicle{246},
    mount_orientation{265}, gimbal_manager_status{281}, gimbal_device_attitude_status{285}, esc_info{290},
    esc_status{291}, odometry{331}, orbit_execution_status{360}, time_estimate_to_target{380}, current_mode{436},
    gnss_integrity{441}, estimator_sensor_fusion_status{514}, mcu_status{11039}, open_drone_id_location{12901},
    open_drone_id_system{12904};

constexpr std::array lite{
    StreamRate{heartbeat, 1},          StreamRate{sys_status, 1},
    StreamRate{extended_sys_state, 1}, StreamRate{battery_status, 1},
    StreamRate{home_position, 1},      StreamRate{mission_current, 1},
    StreamRate{current_mode, 1},       StreamRate{system_time, 1},
    StreamRate{servo_output_raw, 1},   StreamRate{rc_channels, 1, remote},
    StreamRate{wind_cov, 1, wind},     StreamRate{global_position_int, 2},
    StreamRate{attitude, 2},
};

constexpr std::array normal{
    StreamRate{heartbeat, 1},
    StreamRate{sys_status, 1},
    StreamRate{extended_sys_state, 1},
    StreamRate{battery_status, 1},
    StreamRate{home_position, 1},
    StreamRate{mission_current, 1},
    StreamRate{current_mode, 1},
    StreamRate{system_time, 1},
    StreamRate{servo_output_raw, 1},
    StreamRate{rc_channels, 1, remote},
    StreamRate{wind_cov, 1, wind},
    StreamRate{wind_message, 1, wind},
    StreamRate{simstate, 1},
    StreamRate{adsb_vehicle, 1},
    StreamRate{gimbal_manager_status, 1, gimbal},
    StreamRate{gps_raw_int, 5},
    StreamRate{vfr_hud, 5},
    StreamRate{global_position_int, 5},
    StreamRate{altitude, 5},
    StreamRate{position_target_global_int, 5},
    StreamRate{scaled_pressure, 5},
    StreamRate{estimator_status, 5},
    StreamRate{ekf_status_report, 5},
    StreamRate{vibration, 5},
    StreamRate{nav_controller_output, 5},
    StreamRate{orbit_execution_status, 5},
    StreamRate{gimbal_device_attitude_status, 5, gimbal},
    StreamRate{attitude, 10},
    StreamRate{local_position_ned, 10},
    StreamRate{position_target_local_ned, 10, armed},
    StreamRate{attitude_quaternion, 20},
    StreamRate{actuator_control_target, 20},
    StreamRate{attitude_target, 20, armed},
};

// The default messages in the four classes of the generator that came before this simulator. Nothing depends on the
// state of the vehicle.
constexpr std::array original{
    StreamRate{heartbeat, 1},
    StreamRate{sys_status, 1},
    StreamRate{extended_sys_state, 1},
    StreamRate{battery_status, 1},
    StreamRate{home_position, 1},
    StreamRate{mission_current, 1},
    StreamRate{current_mode, 1},
    StreamRate{system_time, 1},
    StreamRate{servo_output_raw, 1},
    StreamRate{rc_channels, 1},
    StreamRate{wind_cov, 1},
    StreamRate{gps_raw_int, 5},
    StreamRate{vfr_hud, 5},
    StreamRate{global_position_int, 5},
    StreamRate{altitude, 5},
    StreamRate{position_target_global_int, 5},
    StreamRate{scaled_pressure, 5},
    StreamRate{estimator_status, 5},
    StreamRate{vibration, 5},
    StreamRate{nav_controller_output, 5},
    StreamRate{attitude, 10},
    StreamRate{local_position_ned, 10},
    StreamRate{position_target_local_ned, 10},
    StreamRate{attitude_quaternion, 20},
    StreamRate{actuator_control_target, 20},
    StreamRate{attitude_target, 20},
};

// PX4 1.17, mode "Normal", with the rates that the start script of its simulation raises for ground stations.
constexpr std::array px4_normal{
    StreamRate{heartbeat, 1},
    StreamRate{sys_status, 1},
    StreamRate{ping, 0.1},
    StreamRate{link_node_status, 1},
    StreamRate{gps_raw_int, 5},
    StreamRate{scaled_pressure, 1},
    StreamRate{attitude, 50},
    StreamRate{attitude_quaternion, 50},
    StreamRate{local_position_ned, 50},
    StreamRate{global_position_int, 50},
    StreamRate{servo_output_raw, 50},
    StreamRate{mission_current, 1},
    StreamRate{nav_controller_output, 1},
    StreamRate{rc_channels, 20, remote},
    StreamRate{vfr_hud, 4},
    StreamRate{attitude_target, 50},
    StreamRate{position_target_local_ned, 50},
    StreamRate{position_target_global_int, 1},
    StreamRate{distance_sensor, 0.5},
    StreamRate{altitude, 1},
    StreamRate{battery_status, 0.5},
    StreamRate{estimator_status, 0.5},
    StreamRate{wind_cov, 0.5, wind},
    StreamRate{vibration, 0.1},
    StreamRate{home_position, 0.5},
    StreamRate{extended_sys_state, 1},
    StreamRate{adsb_vehicle, 5},
    StreamRate{mount_orientation, 10, gimbal},
    StreamRate{gimbal_manager_status, 0.5, gimbal},
    StreamRate{gimbal_device_attitude_status, 5, gimbal},
    StreamRate{esc_info, 1},
    StreamRate{esc_status, 1},
    StreamRate{orbit_execution_status, 2},
    StreamRate{time_estimate_to_target, 0.5},
    StreamRate{current_mode, 0.5},
    StreamRate{gnss_integrity, 1},
    StreamRate{estimator_sensor_fusion_status, 0.5},
    StreamRate{open_drone_id_location, 1},
    StreamRate{open_drone_id_system, 1},
};

// PX4 1.17, mode "Onboard". GPS_RAW_INT comes at the rate of the receiver.
constexpr std::array px4_onboard{
    StreamRate{heartbeat, 1},
    StreamRate{sys_status, 5},
    StreamRate{system_time, 1},
    StreamRate{ping, 1},
    StreamRate{link_node_status, 1},
    StreamRate{gps_raw_int, 8},
    StreamRate{scaled_pressure, 1},
    StreamRate{attitude, 100},
    StreamRate{attitude_quaternion, 50},
    StreamRate{local_position_ned, 30},
    StreamRate{global_position_int, 50},
    StreamRate{servo_output_raw, 10},
    StreamRate{mission_current, 1},
    StreamRate{nav_controller_output, 10},
    StreamRate{rc_channels, 20, remote},
    StreamRate{vfr_hud, 10},
    StreamRate{attitude_target, 10},
    StreamRate{position_target_local_ned, 10},
    StreamRate{position_target_global_int, 10},
    StreamRate{highres_imu, 50},
    StreamRate{timesync, 10},
    StreamRate{distance_sensor, 10},
    StreamRate{altitude, 10},
    StreamRate{battery_status, 0.5},
    StreamRate{estimator_status, 1},
    StreamRate{wind_cov, 10, wind},
    StreamRate{vibration, 0.5},
    StreamRate{home_position, 0.5},
    StreamRate{extended_sys_state, 5},
    StreamRate{adsb_vehicle, 5},
    StreamRate{mount_orientation, 10, gimbal},
    StreamRate{gimbal_manager_status, 0.5, gimbal},
    StreamRate{gimbal_device_attitude_status, 5, gimbal},
    StreamRate{esc_info, 10},
    StreamRate{esc_status, 10},
    StreamRate{odometry, 30},
    StreamRate{orbit_execution_status, 5},
    StreamRate{time_estimate_to_target, 0.5},
    StreamRate{current_mode, 0.5},
    StreamRate{gnss_integrity, 1},
    StreamRate{estimator_sensor_fusion_status, 1},
    StreamRate{open_drone_id_location, 1},
    StreamRate{open_drone_id_system, 1},
};

// ArduPilot's groups (MAV_DATA_STREAM 1, 2, 3, 6, 10, 11, 12).
constexpr std::array raw_sensors{raw_imu, scaled_imu2, scaled_imu3, scaled_pressure};
constexpr std::array extended_status{sys_status,
                                     power_status,
                                     mcu_status,
                                     meminfo,
                                     mission_current,
                                     gps_raw_int,
                                     nav_controller_output,
                                     position_target_global_int,
                                     fence_status};
constexpr std::array rc_group{rc_channels, servo_output_raw};
constexpr std::array position{global_position_int, local_position_ned};
constexpr std::array extra1{attitude, ahrs2, simstate};
constexpr std::array extra2{vfr_hud};
constexpr std::array extra3{system_time,    ahrs,           wind_message,      distance_sensor, rangefinder,
                            terrain_report, battery_status, ekf_status_report, vibration};
constexpr std::array groups{
    StreamGroup{1, raw_sensors}, StreamGroup{2, extended_status}, StreamGroup{3, rc_group}, StreamGroup{6, position},
    StreamGroup{10, extra1},     StreamGroup{11, extra2},         StreamGroup{12, extra3},
};

// ArduPilot's simulation streams every group at 4 Hz before anybody asks.
constexpr auto ardupilot = [] {
    constexpr std::size_t rows = raw_sensors.size() + extended_status.size() + rc_group.size() + position.size() +
                                 extra1.size() + extra2.size() + extra3.size();
    std::array<StreamRate, rows + 1> rates{StreamRate{heartbeat, 1}};
    std::size_t next = 1;
    for (const StreamGroup& group : groups)
        for (const MessageId message : group.messages) rates[next++] = {message, 4};
    return rates;
}();

}  // namespace

std::span<const StreamRate> rates_of(Profile profile) noexcept {
    switch (profile) {
        case Profile::lite: return lite;
        case Profile::normal: return normal;
        case Profile::px4_normal: return px4_normal;
        case Profile::px4_onboard: return px4_onboard;
        case Profile::ardupilot: return ardupilot;
        case Profile::original: return original;
    }
    return lite;
}

bool holds(When when, const VehicleOptions& options) noexcept {
    switch (when) {
        case wind: return options.wind.speed_m_s != 0 || options.wind.gust_m_s != 0 || options.kind == Kind::plane;
        case remote: return options.has_manual_control;
        case gimbal: return options.has_gimbal;
        default: return true;
    }
}

std::span<const StreamGroup> stream_groups() noexcept { return groups; }

}  // namespace mavloom::sim
