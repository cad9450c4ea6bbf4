// SPDX-License-Identifier: MIT
// The functions behind the table of projections, by subject; each subject has a file in messages/. Private to module
// sim. Each function writes one payload and returns true, or returns false when there is nothing to report.
#pragma once

#include "sim/telemetry/telemetry.hpp"

namespace mavloom::sim {

template <class Message>
bool put(const Message& message, ByteSpan payload) noexcept {
    (void)message.encode(payload);
    return true;
}

// status.cpp: the vehicle as a whole
bool write_heartbeat(const View& view, ByteSpan payload);
bool write_sys_status(const View& view, ByteSpan payload);
bool write_extended_sys_state(const View& view, ByteSpan payload);
bool write_current_mode(const View& view, ByteSpan payload);
bool write_available_modes_monitor(const View& view, ByteSpan payload);
bool write_flight_information(const View& view, ByteSpan payload);
bool write_mission_current(const View& view, ByteSpan payload);
bool write_high_latency2(const View& view, ByteSpan payload);

// battery.cpp
bool write_battery_status(const View& view, ByteSpan payload);
// The battery as SYS_STATUS and BATTERY_STATUS have it, so that both agree.
struct BatteryOnWire {
    std::uint16_t millivolts;
    std::int16_t centiamperes;
    std::int8_t percent;
};
[[nodiscard]] BatteryOnWire battery_on_wire(const Battery& battery) noexcept;

// link.cpp: the link and its clocks
bool write_system_time(const View& view, ByteSpan payload);
bool write_ping(const View& view, ByteSpan payload);
bool write_timesync(const View& view, ByteSpan payload);
bool write_link_node_status(const View& view, ByteSpan payload);

// attitude.cpp
bool write_attitude(const View& view, ByteSpan payload);
bool write_attitude_quaternion(const View& view, ByteSpan payload);
bool write_odometry(const View& view, ByteSpan payload);
bool write_hil_state_quaternion(const View& view, ByteSpan payload);
// The attitude as w, x, y, z with w >= 0.
[[nodiscard]] std::array<float, 4> quaternion_on_wire(const Quaternion& q) noexcept;

// position.cpp
bool write_local_position_ned(const View& view, ByteSpan payload);
bool write_global_position_int(const View& view, ByteSpan payload);
bool write_gps_global_origin(const View& view, ByteSpan payload);
bool write_home_position(const View& view, ByteSpan payload);
bool write_vfr_hud(const View& view, ByteSpan payload);
bool write_altitude(const View& view, ByteSpan payload);
[[nodiscard]] double airspeed_of(const View& view) noexcept;
// Metres above the ground, never negative.
[[nodiscard]] double height_of(const View& view);
// Metres above home; before there is one, above the ground.
[[nodiscard]] double relative_altitude_of(const View& view);

// gnss.cpp: the satellite receiver
bool write_gps_raw_int(const View& view, ByteSpan payload);
bool write_gnss_integrity(const View& view, ByteSpan payload);

// remote_id.cpp
bool write_open_drone_id_location(const View& view, ByteSpan payload);
bool write_open_drone_id_system(const View& view, ByteSpan payload);

// sensors.cpp: all other sensors
bool write_highres_imu(const View& view, ByteSpan payload);
bool write_raw_imu(const View& view, ByteSpan payload);
bool write_scaled_imu(const View& view, ByteSpan payload);
bool write_scaled_imu2(const View& view, ByteSpan payload);
bool write_scaled_imu3(const View& view, ByteSpan payload);
bool write_scaled_pressure(const View& view, ByteSpan payload);
bool write_distance_sensor(const View& view, ByteSpan payload);
bool write_vibration(const View& view, ByteSpan payload);

// estimator.cpp
bool write_estimator_status(const View& view, ByteSpan payload);
bool write_estimator_sensor_fusion_status(const View& view, ByteSpan payload);
bool write_ekf_status_report(const View& view, ByteSpan payload);
bool write_wind_cov(const View& view, ByteSpan payload);

// actuators.cpp: motors, servos, and the sticks that a remote control sends
bool write_servo_output_raw(const View& view, ByteSpan payload);
bool write_actuator_control_target(const View& view, ByteSpan payload);
bool write_actuator_output_status(const View& view, ByteSpan payload);
bool write_esc_info(const View& view, ByteSpan payload);
bool write_esc_status(const View& view, ByteSpan payload);
bool write_rc_channels(const View& view, ByteSpan payload);

// targets.cpp: what the controllers follow
bool write_attitude_target(const View& view, ByteSpan payload);
bool write_position_target_local_ned(const View& view, ByteSpan payload);
bool write_position_target_global_int(const View& view, ByteSpan payload);
bool write_nav_controller_output(const View& view, ByteSpan payload);
bool write_orbit_execution_status(const View& view, ByteSpan payload);
bool write_time_estimate_to_target(const View& view, ByteSpan payload);

// payload/gimbal_messages.cpp: only with a gimbal
bool write_gimbal_manager_information(const View& view, ByteSpan payload);
bool write_gimbal_device_information(const View& view, ByteSpan payload);
bool write_gimbal_manager_status(const View& view, ByteSpan payload);
bool write_gimbal_device_attitude_status(const View& view, ByteSpan payload);
bool write_mount_orientation(const View& view, ByteSpan payload);

// ardupilot.cpp: messages that only ArduPilot sends
bool write_ahrs(const View& view, ByteSpan payload);
bool write_ahrs2(const View& view, ByteSpan payload);
bool write_simstate(const View& view, ByteSpan payload);
bool write_meminfo(const View& view, ByteSpan payload);
bool write_power_status(const View& view, ByteSpan payload);
bool write_hwstatus(const View& view, ByteSpan payload);
bool write_wind(const View& view, ByteSpan payload);
bool write_fence_status(const View& view, ByteSpan payload);
bool write_terrain_report(const View& view, ByteSpan payload);
bool write_rangefinder(const View& view, ByteSpan payload);
bool write_mcu_status(const View& view, ByteSpan payload);

}  // namespace mavloom::sim
