// SPDX-License-Identifier: MIT
#include "sim/telemetry/telemetry.hpp"

#include <algorithm>
#include <array>

#include "mavloom/msg/actuator_control_target.hpp"
#include "mavloom/msg/actuator_output_status.hpp"
#include "mavloom/msg/adsb_vehicle.hpp"
#include "mavloom/msg/ahrs.hpp"
#include "mavloom/msg/ahrs2.hpp"
#include "mavloom/msg/altitude.hpp"
#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/attitude_quaternion.hpp"
#include "mavloom/msg/attitude_target.hpp"
#include "mavloom/msg/available_modes_monitor.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/camera_capture_status.hpp"
#include "mavloom/msg/camera_image_captured.hpp"
#include "mavloom/msg/camera_settings.hpp"
#include "mavloom/msg/camera_trigger.hpp"
#include "mavloom/msg/collision.hpp"
#include "mavloom/msg/current_mode.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/ekf_status_report.hpp"
#include "mavloom/msg/esc_info.hpp"
#include "mavloom/msg/esc_status.hpp"
#include "mavloom/msg/estimator_sensor_fusion_status.hpp"
#include "mavloom/msg/estimator_status.hpp"
#include "mavloom/msg/extended_sys_state.hpp"
#include "mavloom/msg/fence_status.hpp"
#include "mavloom/msg/flight_information.hpp"
#include "mavloom/msg/gimbal_device_attitude_status.hpp"
#include "mavloom/msg/gimbal_device_information.hpp"
#include "mavloom/msg/gimbal_manager_information.hpp"
#include "mavloom/msg/gimbal_manager_status.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/gnss_integrity.hpp"
#include "mavloom/msg/gps2_raw.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "mavloom/msg/gps_raw_int.hpp"
#include "mavloom/msg/gps_status.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/high_latency2.hpp"
#include "mavloom/msg/highres_imu.hpp"
#include "mavloom/msg/hil_state_quaternion.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/hwstatus.hpp"
#include "mavloom/msg/link_node_status.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/mag_cal_progress.hpp"
#include "mavloom/msg/mag_cal_report.hpp"
#include "mavloom/msg/mcu_status.hpp"
#include "mavloom/msg/meminfo.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/mount_orientation.hpp"
#include "mavloom/msg/nav_controller_output.hpp"
#include "mavloom/msg/obstacle_distance.hpp"
#include "mavloom/msg/odometry.hpp"
#include "mavloom/msg/open_drone_id_location.hpp"
#include "mavloom/msg/open_drone_id_system.hpp"
#include "mavloom/msg/optical_flow_rad.hpp"
#include "mavloom/msg/orbit_execution_status.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/position_target_global_int.hpp"
#include "mavloom/msg/position_target_local_ned.hpp"
#include "mavloom/msg/power_status.hpp"
#include "mavloom/msg/rangefinder.hpp"
#include "mavloom/msg/raw_imu.hpp"
#include "mavloom/msg/raw_rpm.hpp"
#include "mavloom/msg/rc_channels.hpp"
#include "mavloom/msg/scaled_imu.hpp"
#include "mavloom/msg/scaled_imu2.hpp"
#include "mavloom/msg/scaled_imu3.hpp"
#include "mavloom/msg/scaled_pressure.hpp"
#include "mavloom/msg/servo_output_raw.hpp"
#include "mavloom/msg/simstate.hpp"
#include "mavloom/msg/storage_information.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/msg/terrain_report.hpp"
#include "mavloom/msg/time_estimate_to_target.hpp"
#include "mavloom/msg/timesync.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "mavloom/msg/vibration.hpp"
#include "mavloom/msg/video_stream_status.hpp"
#include "mavloom/msg/wind.hpp"
#include "mavloom/msg/wind_cov.hpp"
#include "sim/radio/radio.hpp"
#include "sim/telemetry/projections.hpp"

namespace mavloom::sim {

namespace {

using Write = bool (*)(const View&, ByteSpan);

template <class Message>
constexpr Projection row(Write write, KnownBy known_by = KnownBy::both) {
    return {wire::info_of<Message>, Message::name, write, known_by};
}

constexpr std::array projection_table{
    row<msg::Heartbeat>(write_heartbeat),
    row<msg::SysStatus>(write_sys_status),
    row<msg::SystemTime>(write_system_time),
    row<msg::Ping>(write_ping),
    row<msg::LinkNodeStatus>(write_link_node_status, KnownBy::px4),
    row<msg::GpsRawInt>(write_gps_raw_int),
    row<msg::GpsStatus>(nullptr),
    row<msg::ScaledImu>(write_scaled_imu),
    row<msg::RawImu>(write_raw_imu),
    row<msg::ScaledPressure>(write_scaled_pressure),
    row<msg::Attitude>(write_attitude),
    row<msg::AttitudeQuaternion>(write_attitude_quaternion),
    row<msg::LocalPositionNed>(write_local_position_ned),
    row<msg::GlobalPositionInt>(write_global_position_int),
    row<msg::ServoOutputRaw>(write_servo_output_raw),
    row<msg::MissionCurrent>(write_mission_current),
    row<msg::GpsGlobalOrigin>(write_gps_global_origin),
    row<msg::NavControllerOutput>(write_nav_controller_output),
    row<msg::RcChannels>(write_rc_channels),
    row<msg::VfrHud>(write_vfr_hud),
    row<msg::AttitudeTarget>(write_attitude_target),
    row<msg::PositionTargetLocalNed>(write_position_target_local_ned),
    row<msg::PositionTargetGlobalInt>(write_position_target_global_int),
    row<msg::HighresImu>(write_highres_imu),
    row<msg::OpticalFlowRad>(nullptr),
    row<msg::Timesync>(write_timesync),
    row<msg::CameraTrigger>(nullptr),
    row<msg::HilStateQuaternion>(write_hil_state_quaternion),
    row<msg::ScaledImu2>(write_scaled_imu2),
    row<msg::Gps2Raw>(nullptr),
    row<msg::PowerStatus>(write_power_status, KnownBy::ardupilot),
    row<msg::ScaledImu3>(write_scaled_imu3),
    row<msg::DistanceSensor>(write_distance_sensor),
    row<msg::TerrainReport>(write_terrain_report, KnownBy::ardupilot),
    row<msg::ActuatorControlTarget>(write_actuator_control_target),
    row<msg::Altitude>(write_altitude),
    row<msg::BatteryStatus>(write_battery_status),
    row<msg::Meminfo>(write_meminfo, KnownBy::ardupilot),
    row<msg::FenceStatus>(write_fence_status, KnownBy::ardupilot),
    row<msg::Ahrs>(write_ahrs, KnownBy::ardupilot),
    row<msg::Simstate>(write_simstate, KnownBy::ardupilot),
    row<msg::Hwstatus>(write_hwstatus, KnownBy::ardupilot),
    row<msg::Wind>(write_wind, KnownBy::ardupilot),
    row<msg::Rangefinder>(write_rangefinder, KnownBy::ardupilot),
    row<msg::Ahrs2>(write_ahrs2, KnownBy::ardupilot),
    row<msg::MagCalProgress>(nullptr, KnownBy::ardupilot),
    row<msg::MagCalReport>(nullptr, KnownBy::ardupilot),
    row<msg::EkfStatusReport>(write_ekf_status_report, KnownBy::ardupilot),
    row<msg::EstimatorStatus>(write_estimator_status, KnownBy::px4),
    row<msg::WindCov>(write_wind_cov),
    row<msg::HighLatency2>(write_high_latency2),
    row<msg::Vibration>(write_vibration),
    row<msg::HomePosition>(write_home_position),
    row<msg::ExtendedSysState>(write_extended_sys_state),
    row<msg::AdsbVehicle>(nullptr),
    row<msg::Collision>(nullptr),
    row<msg::CameraSettings>(nullptr),
    row<msg::StorageInformation>(nullptr),
    row<msg::CameraCaptureStatus>(nullptr),
    row<msg::CameraImageCaptured>(nullptr),
    row<msg::FlightInformation>(write_flight_information),
    row<msg::MountOrientation>(write_mount_orientation),
    row<msg::VideoStreamStatus>(nullptr),
    row<msg::GimbalManagerInformation>(write_gimbal_manager_information),
    row<msg::GimbalManagerStatus>(write_gimbal_manager_status),
    row<msg::GimbalDeviceInformation>(write_gimbal_device_information),
    row<msg::GimbalDeviceAttitudeStatus>(write_gimbal_device_attitude_status),
    row<msg::EscInfo>(write_esc_info),
    row<msg::EscStatus>(write_esc_status),
    row<msg::ObstacleDistance>(nullptr),
    row<msg::Odometry>(write_odometry),
    row<msg::RawRpm>(nullptr),
    row<msg::OrbitExecutionStatus>(write_orbit_execution_status),
    row<msg::ActuatorOutputStatus>(write_actuator_output_status),
    row<msg::TimeEstimateToTarget>(write_time_estimate_to_target, KnownBy::px4),
    row<msg::CurrentMode>(write_current_mode),
    row<msg::AvailableModesMonitor>(write_available_modes_monitor),
    row<msg::GnssIntegrity>(write_gnss_integrity, KnownBy::px4),
    row<msg::EstimatorSensorFusionStatus>(write_estimator_sensor_fusion_status, KnownBy::px4),
    row<msg::McuStatus>(write_mcu_status, KnownBy::ardupilot),
    row<msg::OpenDroneIdLocation>(write_open_drone_id_location),
    row<msg::OpenDroneIdSystem>(write_open_drone_id_system),
};

constexpr auto projection_id = [](const Projection& projection) { return projection.info.id; };
static_assert(std::ranges::adjacent_find(projection_table, std::ranges::greater_equal{}, projection_id) ==
                  projection_table.end(),
              "the table is sorted by id, without repetition");

}  // namespace

std::span<const Projection> projections() noexcept { return projection_table; }

const Projection* find_projection(MessageId id, bool is_px4) noexcept {
    const auto at = std::ranges::lower_bound(projection_table, id, {}, projection_id);
    if (at == projection_table.end() || at->info.id != id || !is_known(at->known_by, is_px4)) return nullptr;
    return &*at;
}

}  // namespace mavloom::sim
