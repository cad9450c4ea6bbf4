// SPDX-License-Identifier: MIT
#include "sim/telemetry/profiles.hpp"

#include <array>

#include "mavloom/msg/actuator_control_target.hpp"
#include "mavloom/msg/adsb_vehicle.hpp"
#include "mavloom/msg/ahrs.hpp"
#include "mavloom/msg/ahrs2.hpp"
#include "mavloom/msg/altitude.hpp"
#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/attitude_quaternion.hpp"
#include "mavloom/msg/attitude_target.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/current_mode.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/ekf_status_report.hpp"
#include "mavloom/msg/esc_info.hpp"
#include "mavloom/msg/esc_status.hpp"
#include "mavloom/msg/estimator_sensor_fusion_status.hpp"
#include "mavloom/msg/estimator_status.hpp"
#include "mavloom/msg/extended_sys_state.hpp"
#include "mavloom/msg/fence_status.hpp"
#include "mavloom/msg/gimbal_device_attitude_status.hpp"
#include "mavloom/msg/gimbal_manager_status.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/gnss_integrity.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "mavloom/msg/gps_raw_int.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/highres_imu.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/link_node_status.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/mcu_status.hpp"
#include "mavloom/msg/meminfo.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/mount_orientation.hpp"
#include "mavloom/msg/nav_controller_output.hpp"
#include "mavloom/msg/odometry.hpp"
#include "mavloom/msg/open_drone_id_location.hpp"
#include "mavloom/msg/open_drone_id_system.hpp"
#include "mavloom/msg/orbit_execution_status.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/position_target_global_int.hpp"
#include "mavloom/msg/position_target_local_ned.hpp"
#include "mavloom/msg/power_status.hpp"
#include "mavloom/msg/rangefinder.hpp"
#include "mavloom/msg/raw_imu.hpp"
#include "mavloom/msg/rc_channels.hpp"
#include "mavloom/msg/scaled_imu2.hpp"
#include "mavloom/msg/scaled_imu3.hpp"
#include "mavloom/msg/scaled_pressure.hpp"
#include "mavloom/msg/servo_output_raw.hpp"
#include "mavloom/msg/simstate.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/msg/terrain_report.hpp"
#include "mavloom/msg/time_estimate_to_target.hpp"
#include "mavloom/msg/timesync.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "mavloom/msg/vibration.hpp"
#include "mavloom/msg/wind.hpp"
#include "mavloom/msg/wind_cov.hpp"

namespace mavloom::sim {

namespace {

using namespace msg;

constexpr std::array rates_lite{
    StreamRate{Heartbeat::id, 1},
    StreamRate{SysStatus::id, 1},
    StreamRate{ExtendedSysState::id, 1},
    StreamRate{BatteryStatus::id, 1},
    StreamRate{HomePosition::id, 1},
    StreamRate{MissionCurrent::id, 1},
    StreamRate{CurrentMode::id, 1},
    StreamRate{SystemTime::id, 1},
    StreamRate{ServoOutputRaw::id, 1},
    StreamRate{RcChannels::id, 1, When::remote},
    StreamRate{WindCov::id, 1, When::wind},
    StreamRate{GlobalPositionInt::id, 2},
    StreamRate{Attitude::id, 2},
};

constexpr std::array rates_normal{
    StreamRate{Heartbeat::id, 1},
    StreamRate{SysStatus::id, 1},
    StreamRate{ExtendedSysState::id, 1},
    StreamRate{BatteryStatus::id, 1},
    StreamRate{HomePosition::id, 1},
    StreamRate{MissionCurrent::id, 1},
    StreamRate{CurrentMode::id, 1},
    StreamRate{SystemTime::id, 1},
    StreamRate{ServoOutputRaw::id, 1},
    StreamRate{RcChannels::id, 1, When::remote},
    StreamRate{WindCov::id, 1, When::wind},
    StreamRate{msg::Wind::id, 1, When::wind},
    StreamRate{Simstate::id, 1},
    StreamRate{AdsbVehicle::id, 1},
    StreamRate{GimbalManagerStatus::id, 1, When::gimbal},
    StreamRate{GpsRawInt::id, 5},
    StreamRate{VfrHud::id, 5},
    StreamRate{GlobalPositionInt::id, 5},
    StreamRate{Altitude::id, 5},
    StreamRate{PositionTargetGlobalInt::id, 5},
    StreamRate{ScaledPressure::id, 5},
    StreamRate{EstimatorStatus::id, 5},
    StreamRate{EkfStatusReport::id, 5},
    StreamRate{Vibration::id, 5},
    StreamRate{NavControllerOutput::id, 5},
    StreamRate{OrbitExecutionStatus::id, 5},
    StreamRate{GimbalDeviceAttitudeStatus::id, 5, When::gimbal},
    StreamRate{Attitude::id, 10},
    StreamRate{LocalPositionNed::id, 10},
    StreamRate{PositionTargetLocalNed::id, 10, When::armed},
    StreamRate{AttitudeQuaternion::id, 20},
    StreamRate{AttitudeTarget::id, 20, When::armed},
};

// The default messages in the four classes of the generator that came before this simulator. Nothing depends on the
// state of the vehicle.
constexpr std::array rates_original{
    StreamRate{Heartbeat::id, 1},
    StreamRate{SysStatus::id, 1},
    StreamRate{ExtendedSysState::id, 1},
    StreamRate{BatteryStatus::id, 1},
    StreamRate{HomePosition::id, 1},
    StreamRate{MissionCurrent::id, 1},
    StreamRate{CurrentMode::id, 1},
    StreamRate{SystemTime::id, 1},
    StreamRate{ServoOutputRaw::id, 1},
    StreamRate{RcChannels::id, 1},
    StreamRate{WindCov::id, 1},
    StreamRate{GpsRawInt::id, 5},
    StreamRate{VfrHud::id, 5},
    StreamRate{GlobalPositionInt::id, 5},
    StreamRate{Altitude::id, 5},
    StreamRate{PositionTargetGlobalInt::id, 5},
    StreamRate{ScaledPressure::id, 5},
    StreamRate{EstimatorStatus::id, 5},
    StreamRate{Vibration::id, 5},
    StreamRate{NavControllerOutput::id, 5},
    StreamRate{Attitude::id, 10},
    StreamRate{LocalPositionNed::id, 10},
    StreamRate{PositionTargetLocalNed::id, 10},
    StreamRate{AttitudeQuaternion::id, 20},
    StreamRate{ActuatorControlTarget::id, 20},
    StreamRate{AttitudeTarget::id, 20},
};

// PX4 1.17, mode "Normal", with the rates that the start script of its simulation raises for ground stations.
constexpr std::array rates_px4_normal{
    StreamRate{Heartbeat::id, 1},
    StreamRate{SysStatus::id, 1},
    StreamRate{Ping::id, 0.1},
    StreamRate{LinkNodeStatus::id, 1},
    StreamRate{GpsRawInt::id, 5},
    StreamRate{ScaledPressure::id, 1},
    StreamRate{Attitude::id, 50},
    StreamRate{AttitudeQuaternion::id, 50},
    StreamRate{LocalPositionNed::id, 50},
    StreamRate{GlobalPositionInt::id, 50},
    StreamRate{ServoOutputRaw::id, 50},
    StreamRate{MissionCurrent::id, 1},
    StreamRate{GpsGlobalOrigin::id, 1, When::once},
    StreamRate{NavControllerOutput::id, 1},
    StreamRate{RcChannels::id, 20, When::remote},
    StreamRate{VfrHud::id, 4},
    StreamRate{AttitudeTarget::id, 50},
    StreamRate{PositionTargetLocalNed::id, 50},
    StreamRate{PositionTargetGlobalInt::id, 1},
    StreamRate{DistanceSensor::id, 0.5},
    StreamRate{Altitude::id, 1},
    StreamRate{BatteryStatus::id, 0.5},
    StreamRate{EstimatorStatus::id, 0.5},
    StreamRate{WindCov::id, 0.5, When::wind},
    StreamRate{Vibration::id, 0.1},
    StreamRate{HomePosition::id, 0.5},
    StreamRate{ExtendedSysState::id, 1},
    StreamRate{AdsbVehicle::id, 5},
    StreamRate{MountOrientation::id, 10, When::gimbal},
    StreamRate{GimbalManagerStatus::id, 0.5, When::gimbal},
    StreamRate{GimbalDeviceAttitudeStatus::id, 5, When::gimbal},
    StreamRate{EscInfo::id, 1},
    StreamRate{EscStatus::id, 1},
    StreamRate{OrbitExecutionStatus::id, 2},
    StreamRate{TimeEstimateToTarget::id, 0.5},
    StreamRate{CurrentMode::id, 0.5},
    StreamRate{GnssIntegrity::id, 1},
    StreamRate{EstimatorSensorFusionStatus::id, 0.5},
    StreamRate{OpenDroneIdLocation::id, 1},
    StreamRate{OpenDroneIdSystem::id, 1},
};

// PX4 1.17, mode "Onboard". GPS_RAW_INT comes at the rate of the receiver.
constexpr std::array rates_px4_onboard{
    StreamRate{Heartbeat::id, 1},
    StreamRate{SysStatus::id, 5},
    StreamRate{SystemTime::id, 1},
    StreamRate{Ping::id, 1},
    StreamRate{LinkNodeStatus::id, 1},
    StreamRate{GpsRawInt::id, 8},
    StreamRate{ScaledPressure::id, 1},
    StreamRate{Attitude::id, 100},
    StreamRate{AttitudeQuaternion::id, 50},
    StreamRate{LocalPositionNed::id, 30},
    StreamRate{GlobalPositionInt::id, 50},
    StreamRate{ServoOutputRaw::id, 10},
    StreamRate{MissionCurrent::id, 1},
    StreamRate{GpsGlobalOrigin::id, 1, When::once},
    StreamRate{NavControllerOutput::id, 10},
    StreamRate{RcChannels::id, 20, When::remote},
    StreamRate{VfrHud::id, 10},
    StreamRate{AttitudeTarget::id, 10},
    StreamRate{PositionTargetLocalNed::id, 10},
    StreamRate{PositionTargetGlobalInt::id, 10},
    StreamRate{HighresImu::id, 50},
    StreamRate{Timesync::id, 10},
    StreamRate{DistanceSensor::id, 10},
    StreamRate{Altitude::id, 10},
    StreamRate{BatteryStatus::id, 0.5},
    StreamRate{EstimatorStatus::id, 1},
    StreamRate{WindCov::id, 10, When::wind},
    StreamRate{Vibration::id, 0.5},
    StreamRate{HomePosition::id, 0.5},
    StreamRate{ExtendedSysState::id, 5},
    StreamRate{AdsbVehicle::id, 5},
    StreamRate{MountOrientation::id, 10, When::gimbal},
    StreamRate{GimbalManagerStatus::id, 0.5, When::gimbal},
    StreamRate{GimbalDeviceAttitudeStatus::id, 5, When::gimbal},
    StreamRate{EscInfo::id, 10},
    StreamRate{EscStatus::id, 10},
    StreamRate{Odometry::id, 30},
    StreamRate{OrbitExecutionStatus::id, 5},
    StreamRate{TimeEstimateToTarget::id, 0.5},
    StreamRate{CurrentMode::id, 0.5},
    StreamRate{GnssIntegrity::id, 1},
    StreamRate{EstimatorSensorFusionStatus::id, 1},
    StreamRate{OpenDroneIdLocation::id, 1},
    StreamRate{OpenDroneIdSystem::id, 1},
};

// ArduPilot's groups (MAV_DATA_STREAM 1, 2, 3, 6, 10, 11, 12).
constexpr std::array group_raw_sensors{RawImu::id, ScaledImu2::id, ScaledImu3::id, ScaledPressure::id};
constexpr std::array group_extended_status{
    SysStatus::id,      PowerStatus::id, McuStatus::id,           Meminfo::id,
    MissionCurrent::id, GpsRawInt::id,   NavControllerOutput::id, PositionTargetGlobalInt::id,
    FenceStatus::id};
constexpr std::array group_rc_channels{RcChannels::id, ServoOutputRaw::id};
constexpr std::array group_position{GlobalPositionInt::id, LocalPositionNed::id};
constexpr std::array group_extra1{Attitude::id, Ahrs2::id, Simstate::id};
constexpr std::array group_extra2{VfrHud::id};
constexpr std::array group_extra3{SystemTime::id,  Ahrs::id,          msg::Wind::id,     DistanceSensor::id,
                                  Rangefinder::id, TerrainReport::id, BatteryStatus::id, EkfStatusReport::id,
                                  Vibration::id};
constexpr std::array group_table{
    StreamGroup{1, "SR0_RAW_SENS", group_raw_sensors}, StreamGroup{2, "SR0_EXT_STAT", group_extended_status},
    StreamGroup{3, "SR0_RC_CHAN", group_rc_channels},  StreamGroup{6, "SR0_POSITION", group_position},
    StreamGroup{10, "SR0_EXTRA1", group_extra1},       StreamGroup{11, "SR0_EXTRA2", group_extra2},
    StreamGroup{12, "SR0_EXTRA3", group_extra3},
};

// ArduPilot's simulation streams every group at 4 Hz before anybody asks. Its parameters may change that.
constexpr auto rates_ardupilot = [] {
    constexpr std::size_t rows = group_raw_sensors.size() + group_extended_status.size() + group_rc_channels.size() +
                                 group_position.size() + group_extra1.size() + group_extra2.size() + group_extra3.size();
    std::array<StreamRate, rows + 1> rates{StreamRate{Heartbeat::id, 1}};
    std::size_t next = 1;
    for (const StreamGroup& group : group_table)
        for (const MessageId message : group.messages) rates[next++] = {message, 4};
    return rates;
}();

}  // namespace

std::span<const StreamRate> rates_of(Profile profile) noexcept {
    switch (profile) {
        case Profile::lite: return rates_lite;
        case Profile::normal: return rates_normal;
        case Profile::px4_normal: return rates_px4_normal;
        case Profile::px4_onboard: return rates_px4_onboard;
        case Profile::ardupilot: return rates_ardupilot;
        case Profile::original: return rates_original;
    }
    return rates_lite;
}

bool holds(When when, const VehicleOptions& options) noexcept {
    switch (when) {
        case When::wind:
            return options.wind.speed_m_s != 0 || options.wind.gust_m_s != 0 || options.kind == Kind::plane;
        case When::remote: return options.has_manual_control;
        case When::gimbal: return options.has_gimbal;
        default: return true;
    }
}

std::span<const StreamGroup> stream_groups() noexcept { return group_table; }

}  // namespace mavloom::sim
