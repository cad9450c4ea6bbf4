// SPDX-License-Identifier: MIT
// Names, types, defaults, ranges and units are PX4 1.17's; defaults are those of its simulated airframes.
#include <array>

#include "flight/firmware/tables.hpp"

namespace mavloom::flight {

namespace {

constexpr ParamChoice off_on[] = {{0, "Disabled"}, {1, "Enabled"}};
constexpr ParamChoice manual_inputs[] = {{0, "RC only"},
                                         {1, "MAVLink only"},
                                         {2, "RC or MAVLink with fallback"},
                                         {3, "RC or MAVLink keep first"},
                                         {4, "Disable manual control"}};
constexpr ParamChoice mode_slots[] = {{-1, "Unassigned"}, {0, "Manual"},     {1, "Altitude"},       {2, "Position"},
                                      {3, "Mission"},     {4, "Hold"},       {5, "Return"},         {6, "Acro"},
                                      {7, "Offboard"},    {8, "Stabilized"}, {9, "Position Slow"},  {10, "Takeoff"},
                                      {11, "Land"},       {12, "Follow Me"}, {13, "Precision Land"}};
constexpr ParamChoice boot_modes[] = {{0, "Manual"}, {1, "Altitude"}, {2, "Position"}, {3, "Mission"}, {4, "Hold"}};
constexpr ParamChoice gcs_loss_actions[] = {{0, "Disabled"},  {1, "Hold mode"}, {2, "Return mode"},
                                            {3, "Land mode"}, {5, "Terminate"}, {6, "Disarm"}};
constexpr ParamChoice manual_loss_actions[] = {{1, "Hold mode"}, {2, "Return mode"}, {3, "Land mode"},
                                               {5, "Terminate"}, {6, "Disarm"},      {7, "Hold mode (no failsafe)"}};
constexpr ParamChoice offboard_loss_actions[] = {{0, "Position mode"}, {1, "Altitude mode"}, {2, "Stabilized"},
                                                 {3, "Return mode"},   {4, "Land mode"},     {5, "Hold mode"},
                                                 {6, "Terminate"},     {7, "Disarm"}};
constexpr ParamChoice low_battery_actions[] = {{0, "Warning"},
                                               {2, "Land mode"},
                                               {3, "Return at critical level, land at emergency level"},
                                               {4, "Return at critical level, terminate at emergency level"}};
constexpr ParamChoice fence_actions[] = {{0, "None"},        {1, "Warning"},   {2, "Hold mode"},
                                         {3, "Return mode"}, {4, "Terminate"}, {5, "Land mode"}};
constexpr ParamChoice position_modes[] = {{0, "Direct velocity"}, {4, "Acceleration based"}};
constexpr ParamChoice gps_arming[] = {{0, "Deny arming"}, {1, "Warning only"}, {2, "Disabled"}};
constexpr ParamChoice airmodes[] = {{0, "Disabled"}, {1, "Roll/Pitch"}, {2, "Roll/Pitch/Yaw"}};
constexpr ParamChoice mavlink_versions[] = {{1, "Version 1 with auto-upgrade to v2 if detected"}, {2, "Version 2"}};

constexpr ParamRow system_rows[] = {
    int32("SYS_AUTOCONFIG", 0, "Replace all parameters by those of the airframe at the next boot"),
    int32("SYS_AUTOSTART", 10040, "Number of the airframe").in(0, 9999999).at_reboot(),
    int32("SYS_HAS_BARO", 1, "Whether the vehicle has a barometer").one_of(off_on).at_reboot(),
    int32("SYS_HAS_GPS", 1, "Whether the vehicle has a GNSS receiver").one_of(off_on).at_reboot(),
    int32("SYS_HAS_MAG", 1, "Number of magnetometers the vehicle must have").at_reboot(),
    int32("SYS_HAS_NUM_ASPD", 0, "Number of airspeed sensors the vehicle must have").in(0, 1),
    int32("SYS_HITL", 0, "Run in a hardware-in-the-loop simulation after the next boot").at_reboot(),
    int32("SYS_PARAM_VER", 1, "Version of the parameter set").in(0, 0),
    int32("SYS_RESTART_TYPE", 2, "Reason of the last boot").in(0, 2).by_vehicle(),
};
constexpr ParamRow mavlink_rows[] = {
    int32("MAV_COMP_ID", 1, "Component id of the autopilot").in(1, 250).at_reboot(),
    int32("MAV_PROTO_VER", 2, "MAVLink version that the vehicle sends").one_of(mavlink_versions),
    int32("MAV_SYS_ID", 1, "System id of the vehicle").in(1, 250).at_reboot(),
    int32("MAV_TYPE", 2, "MAV_TYPE in the vehicle's heartbeat").in(0, 23),
};
constexpr ParamRow failure_rows[] = {
    int32("SYS_FAILURE_EN", 1, "Accept failures that clients inject").one_of(off_on),
};
constexpr ParamRow land_detector_rows[] = {
    int32("LND_FLIGHT_T_HI", 0, "Total flight time in microseconds, upper 32 bits").by_vehicle(),
    int32("LND_FLIGHT_T_LO", 0, "Total flight time in microseconds, lower 32 bits").by_vehicle(),
};
constexpr ParamRow other_rows[] = {
    int32("TRIG_MODE", 0, "How the camera is triggered").in(0, 4).at_reboot(),
    int32("UAVCAN_ENABLE", 0, "Which devices on the CAN bus the vehicle uses").in(0, 3).at_reboot(),
    int32("PD_GRIPPER_EN", 0, "Whether the vehicle has a gripper for payloads").one_of(off_on),
    real("THR_MDL_FAC", 0, "Share of the square term in the relation of motor command and thrust").in(0, 1, {}, 1),
};
constexpr ParamRow simulator_rows[] = {
    real("SIM_BAT_DRAIN", 60, "Time from full to empty of PX4's own battery model").in(1, 86400, "s"),
    real("SIM_BAT_MIN_PCT", 50, "Charge at which PX4's own battery model stops").in(0, 100, "%"),
    int32("SIM_GPS_USED", 10, "Satellites that the simulated GNSS receiver uses").in(0, 50),
};

constexpr ParamRow calibration_rows[] = {
    int32("CAL_ACC0_ID", 1310988, "Device that the calibration of accelerometer 0 belongs to"),
    int32("CAL_ACC1_ID", 1310996, "Device that the calibration of accelerometer 1 belongs to"),
    int32("CAL_ACC2_ID", 1311004, "Device that the calibration of accelerometer 2 belongs to"),
    real("CAL_ACC0_XOFF", 0, "Offset of accelerometer 0 along x").unit_of("m/s^2", 3).by_vehicle(),
    real("CAL_ACC0_YOFF", 0, "Offset of accelerometer 0 along y").unit_of("m/s^2", 3).by_vehicle(),
    real("CAL_ACC0_ZOFF", 0, "Offset of accelerometer 0 along z").unit_of("m/s^2", 3).by_vehicle(),
    int32("CAL_GYRO0_ID", 1310988, "Device that the calibration of gyroscope 0 belongs to"),
    int32("CAL_GYRO1_ID", 1310996, "Device that the calibration of gyroscope 1 belongs to"),
    int32("CAL_GYRO2_ID", 1311004, "Device that the calibration of gyroscope 2 belongs to"),
    real("CAL_GYRO0_XOFF", 0, "Offset of gyroscope 0 around x").unit_of("rad/s", 3).by_vehicle(),
    real("CAL_GYRO0_YOFF", 0, "Offset of gyroscope 0 around y").unit_of("rad/s", 3).by_vehicle(),
    real("CAL_GYRO0_ZOFF", 0, "Offset of gyroscope 0 around z").unit_of("rad/s", 3).by_vehicle(),
    int32("CAL_MAG0_ID", 197388, "Device that the calibration of magnetometer 0 belongs to"),
    int32("CAL_MAG1_ID", 197644, "Device that the calibration of magnetometer 1 belongs to"),
    int32("CAL_MAG2_ID", 0, "Device that the calibration of magnetometer 2 belongs to"),
    int32("CAL_MAG3_ID", 0, "Device that the calibration of magnetometer 3 belongs to"),
    int32("CAL_MAG0_PRIO", 50, "Priority of magnetometer 0; 0 disables it").in(-1, 100),
    int32("CAL_MAG1_PRIO", 50, "Priority of magnetometer 1; 0 disables it").in(-1, 100),
    int32("CAL_MAG0_ROT", -1, "Rotation of magnetometer 0 in the vehicle; -1 for an internal one").in(-1, 100),
    int32("CAL_MAG1_ROT", -1, "Rotation of magnetometer 1 in the vehicle; -1 for an internal one").in(-1, 100),
    int32("CAL_MAG2_ROT", -1, "Rotation of magnetometer 2 in the vehicle; -1 for an internal one").in(-1, 100),
    int32("CAL_MAG3_ROT", -1, "Rotation of magnetometer 3 in the vehicle; -1 for an internal one").in(-1, 100),
    real("CAL_MAG0_XOFF", 0, "Offset of magnetometer 0 along x").unit_of("gauss", 3).by_vehicle(),
    real("CAL_MAG0_YOFF", 0, "Offset of magnetometer 0 along y").unit_of("gauss", 3).by_vehicle(),
    real("CAL_MAG0_ZOFF", 0, "Offset of magnetometer 0 along z").unit_of("gauss", 3).by_vehicle(),
    real("SENS_DPRES_OFF", 0.001, "Offset of the differential pressure sensor").by_vehicle(),
};
constexpr ParamRow sensor_rows[] = {
    int32("SENS_BOARD_ROT", 0, "Rotation of the autopilot's board in the vehicle").in(-1, 40).at_reboot(),
    real("SENS_BOARD_X_OFF", 0.000001, "Correction of the board's rotation around x").in(-45, 45, "deg", 1),
    real("SENS_BOARD_Y_OFF", 0, "Correction of the board's rotation around y").in(-45, 45, "deg", 1),
    real("SENS_BOARD_Z_OFF", 0, "Correction of the board's rotation around z").in(-45, 45, "deg", 1),
};
constexpr ParamRow estimator_rows[] = {
    real("EKF2_MAGBIAS_X", 0, "Magnetometer bias along x that the estimator learned").in(-0.5, 0.5, "gauss", 3).by_vehicle(),
    real("EKF2_MAGBIAS_Y", 0, "Magnetometer bias along y that the estimator learned").in(-0.5, 0.5, "gauss", 3).by_vehicle(),
    real("EKF2_MAGBIAS_Z", 0, "Magnetometer bias along z that the estimator learned").in(-0.5, 0.5, "gauss", 3).by_vehicle(),
    real("EKF2_MAG_DECL", 0, "Magnetic declination that the estimator found").unit_of("deg", 1).by_vehicle(),
};

constexpr ParamRow commander_rows[] = {
    int32("COM_ARM_WO_GPS", 1, "What happens when the vehicle is armed without a position").one_of(gps_arming),
    real("COM_DISARM_LAND", 2, "Time after landing until the vehicle disarms; negative: never").unit_of("s", 1),
    real("COM_DISARM_PRFLT", 10, "Time after arming until the vehicle disarms if it did not take off; negative: never")
        .unit_of("s", 1),
    int32("COM_DL_LOSS_T", 10, "Time without a ground station's heartbeat until the connection counts as lost")
        .in(5, 300, "s"),
    int32("COM_FLIGHT_UUID", 0, "Number of the next flight").in(0, 2147483647).by_vehicle(),
    int32("COM_FLTMODE1", -1, "Mode of slot 1 of the remote control's mode switch").one_of(mode_slots),
    int32("COM_FLTMODE2", -1, "Mode of slot 2 of the remote control's mode switch").one_of(mode_slots),
    int32("COM_FLTMODE3", -1, "Mode of slot 3 of the remote control's mode switch").one_of(mode_slots),
    int32("COM_FLTMODE4", -1, "Mode of slot 4 of the remote control's mode switch").one_of(mode_slots),
    int32("COM_FLTMODE5", -1, "Mode of slot 5 of the remote control's mode switch").one_of(mode_slots),
    int32("COM_FLTMODE6", -1, "Mode of slot 6 of the remote control's mode switch").one_of(mode_slots),
    int32("COM_FLTMODE_BOOT", 4, "Mode after boot").one_of(boot_modes),
    int32("COM_HOME_EN", 1, "Whether the vehicle sets a home position").one_of(off_on).at_reboot(),
    int32("COM_LOW_BAT_ACT", 3, "What the vehicle does when the battery is low").one_of(low_battery_actions),
    int32("COM_OBL_RC_ACT", 0, "What the vehicle does when it loses its set-points in Offboard")
        .one_of(offboard_loss_actions),
    real("COM_OF_LOSS_T", 1, "Time without a set-point until the offboard controller counts as lost").in(0, 60, "s", 1),
    int32("COM_RC_IN_MODE", 1, "Where manual control comes from").one_of(manual_inputs),
    real("COM_RC_LOSS_T", 0.5, "Time without manual control until it counts as lost").in(0, 35, "s", 1),
    real("COM_SPOOLUP_TIME", 1, "Time from arming until the vehicle may climb").in(0, 30, "s", 1),
    int32("NAV_DLL_ACT", 0, "What the vehicle does when it loses the ground station").one_of(gcs_loss_actions),
    int32("NAV_RCL_ACT", 2, "What the vehicle does when it loses manual control").one_of(manual_loss_actions),
};
constexpr ParamRow radio_rows[] = {
    int32("RC_CHAN_CNT", 0, "Number of calibrated channels").in(0, 18),
    int32("RC_MAP_ROLL", 0, "Channel that steers roll").in(0, 18),
    int32("RC_MAP_PITCH", 0, "Channel that steers pitch").in(0, 18),
    int32("RC_MAP_YAW", 0, "Channel that steers yaw").in(0, 18),
    int32("RC_MAP_THROTTLE", 0, "Channel that steers the throttle").in(0, 18),
    int32("RC_MAP_FLAPS", 0, "Channel that sets the flaps").in(0, 18),
    int32("RC_MAP_AUX1", 0, "Channel of auxiliary output 1").in(0, 18),
    int32("RC_MAP_AUX2", 0, "Channel of auxiliary output 2").in(0, 18),
    int32("RC_MAP_FLTMODE", 0, "Channel that selects a mode slot").in(0, 18),
};
constexpr ParamRow fence_rows[] = {
    int32("GF_ACTION", 2, "What the vehicle does when it leaves the fence").in(0, 5).one_of(fence_actions),
    real("GF_MAX_HOR_DIST", 0, "Greatest horizontal distance from home; 0: no limit").in(0, 10000, "m"),
    real("GF_MAX_VER_DIST", 0, "Greatest height above home; 0: no limit").in(0, 10000, "m"),
};
constexpr ParamRow battery_rows[] = {
    int32("BAT1_SOURCE", 0, "Where the measurements of battery 1 come from").at_reboot(),
    int32("BAT1_N_CELLS", 4, "Number of cells of battery 1"),
    real("BAT1_V_CHARGED", 4.05, "Voltage of a full cell").unit_of("V", 2).at_reboot(),
    real("BAT1_V_EMPTY", 3.6, "Voltage of an empty cell").unit_of("V", 2).at_reboot(),
    real("BAT1_V_DIV", -1, "Voltage divider of the power module; -1: the board's").at_reboot(),
    real("BAT1_A_PER_V", -1, "Amperes per volt of the current sensor; -1: the board's").at_reboot(),
    real("BAT1_CAPACITY", -1, "Capacity of battery 1; -1: unknown").in(-1, 100000, "mAh").at_reboot(),
    real("BAT_LOW_THR", 0.15, "Charge below which the vehicle warns").in(0.12, 0.5, "norm", 2),
    real("BAT_CRIT_THR", 0.07, "Charge below which the battery is critical").in(0.05, 0.5, "norm", 2),
    real("BAT_EMERGEN_THR", 0.05, "Charge below which the vehicle must land at once").in(0.03, 0.5, "norm", 2),
};
constexpr ParamRow mission_rows[] = {
    real("MIS_DIST_1WP", 10000, "Greatest distance from home to the first waypoint").in(-1, 100000, "m", 1),
    real("MIS_TAKEOFF_ALT", 2.5, "Height of a take-off without an altitude").in(0, 0, "m", 1),
    real("MIS_YAW_ERR", 12, "Heading error at which a waypoint counts as reached").in(0, 90, "deg", 1),
    real("MIS_YAW_TMT", -1, "Time that the vehicle may take to turn at a waypoint; -1: it need not").in(-1, 20, "s", 1),
    real("NAV_ACC_RAD", 10, "Distance at which a waypoint counts as reached").in(0.05, 200, "m", 1),
    real("NAV_LOITER_RAD", 80, "Radius of circles in Hold; negative: counter-clockwise").in(-10000, 10000, "m", 1),
};
constexpr ParamRow return_rows[] = {
    int32("RTL_CONE_ANG", 45, "Half of the angle of the cone that lowers the return altitude near home")
        .in(0, 90, "deg"),
    real("RTL_DESCEND_ALT", 30, "Height above home at which the vehicle waits before it lands").in(0, 0, "m", 1),
    real("RTL_LAND_DELAY", 0, "Time that the vehicle waits before it lands; -1: it does not land").in(-1, 0, "s", 1),
    real("RTL_MIN_DIST", 10, "Distance from home below which the cone lowers the return altitude").in(0.5, 0, "m", 1),
    real("RTL_RETURN_ALT", 60, "Height above home at which the vehicle returns").in(0, 0, "m", 1),
    int32("RTL_TYPE", 0, "Where and by which path the vehicle returns").in(0, 5),
};
constexpr ParamRow follow_rows[] = {
    int32("FLW_TGT_ALT_M", 0, "How the altitude depends on the target's").in(0, 2),
    real("FLW_TGT_DST", 8, "Distance from the target").in(1, 0, "m", 1),
    real("FLW_TGT_FA", 180, "Direction from the target, in relation to its course").in(-180, 180, "deg", 1),
    real("FLW_TGT_HT", 8, "Height above the target's ground").in(8, 0, "m", 1),
    real("FLW_TGT_MAX_VEL", 5, "Greatest speed on the circle around the target").in(0, 20, "m/s", 1),
    real("FLW_TGT_RS", 0.1, "How quickly the vehicle reacts to the target").in(0, 1, {}, 2),
};

constexpr ParamGroup px4_common_groups[] = {
    {"System", system_rows},
    {"MAVLink", mavlink_rows},
    {"Failure Injection", failure_rows},
    {"Land Detector", land_detector_rows},
    {"Miscellaneous", other_rows},
    {"Simulator", simulator_rows},
    {"Sensor Calibration", calibration_rows},
    {"Sensors", sensor_rows},
    {"EKF2", estimator_rows},
    {"Commander", commander_rows},
    {"Radio Calibration", radio_rows},
    {"Geofence", fence_rows},
    {"Battery Calibration", battery_rows},
    {"Mission", mission_rows},
    {"Return Mode", return_rows},
    {"Follow target", follow_rows},
};

constexpr ParamRow copter_position_rows[] = {
    real("CP_DIST", -1, "Distance to keep from obstacles; negative: off").in(-1, 15, "m", 1),
    real("MPC_ACC_DOWN_MAX", 3, "Greatest downward acceleration").in(2, 15, "m/s^2", 1),
    real("MPC_ACC_HOR", 3, "Horizontal acceleration").in(2, 15, "m/s^2", 1),
    real("MPC_ACC_HOR_MAX", 5, "Greatest horizontal acceleration under manual control").in(2, 15, "m/s^2", 2),
    real("MPC_ACC_UP_MAX", 4, "Greatest upward acceleration").in(2, 15, "m/s^2", 1),
    real("MPC_HOLD_MAX_XY", 0.8, "Speed below which the vehicle holds its position when sticks are centred")
        .in(0, 3, "m/s", 2),
    real("MPC_JERK_AUTO", 4, "Greatest jerk in autonomous modes").in(1, 80, "m/s^3", 1),
    real("MPC_LAND_ALT1", 10, "Height below which a landing slows down").in(0, 122, "m", 1),
    real("MPC_LAND_ALT2", 5, "Height below which a landing is slow").in(0, 122, "m", 1),
    real("MPC_LAND_CRWL", 0.3, "Descent rate close to the ground, if its distance is known").in(0.1, 0, "m/s", 1),
    real("MPC_LAND_SPEED", 0.7, "Descent rate of the last part of a landing").in(0.6, 0, "m/s", 1),
    real("MPC_MAN_TILT_MAX", 35, "Greatest tilt under manual control").in(1, 70, "deg"),
    int32("MPC_POS_MODE", 4, "How sticks steer in Position mode").one_of(position_modes),
    real("MPC_THR_HOVER", 0.5, "Thrust that carries the vehicle").in(0.1, 0.8, "norm", 2),
    real("MPC_TILTMAX_AIR", 45, "Greatest tilt in flight").in(20, 89, "deg"),
    real("MPC_TILTMAX_LND", 12, "Greatest tilt while taking off and landing").in(5, 89, "deg"),
    real("MPC_TKO_RAMP_T", 3, "Time in which the thrust rises at take-off").in(0, 5, "s", 1),
    real("MPC_TKO_SPEED", 1.5, "Climb rate of a take-off").in(1, 5, "m/s", 2),
    real("MPC_XY_CRUISE", 5, "Horizontal speed in autonomous modes").in(3, 20, "m/s", 1),
    real("MPC_XY_P", 0.95, "Gain of the horizontal position controller").in(0, 2, {}, 2),
    real("MPC_XY_VEL_D_ACC", 0.2, "Differential gain of the horizontal velocity controller").in(0.1, 2, {}, 2),
    real("MPC_XY_VEL_I_ACC", 0.4, "Integral gain of the horizontal velocity controller").in(0, 60, {}, 2),
    real("MPC_XY_VEL_MAX", 12, "Greatest horizontal speed").in(0, 20, "m/s", 1),
    real("MPC_XY_VEL_P_ACC", 1.8, "Proportional gain of the horizontal velocity controller").in(1.2, 5, {}, 2),
    real("MPC_Z_P", 1, "Gain of the altitude controller").in(0.1, 1.5, {}, 2),
    real("MPC_Z_VEL_D_ACC", 0, "Differential gain of the vertical velocity controller").in(0, 2, {}, 2),
    real("MPC_Z_VEL_I_ACC", 2, "Integral gain of the vertical velocity controller").in(0.2, 3, {}, 2),
    real("MPC_Z_VEL_MAX_DN", 1.5, "Greatest descent rate").in(0.5, 4, "m/s", 1),
    real("MPC_Z_VEL_MAX_UP", 3, "Greatest climb rate").in(0.5, 8, "m/s", 1),
    real("MPC_Z_VEL_P_ACC", 4, "Proportional gain of the vertical velocity controller").in(2, 15, {}, 2),
    real("MPC_Z_V_AUTO_DN", 1.5, "Descent rate in autonomous modes").in(0.5, 4, "m/s", 1),
    real("MPC_Z_V_AUTO_UP", 3, "Climb rate in autonomous modes").in(0.5, 8, "m/s", 1),
};
constexpr ParamRow copter_attitude_rows[] = {
    real("MC_PITCH_P", 4, "Gain of the pitch controller").in(0, 12, {}, 2),
    real("MC_ROLL_P", 4, "Gain of the roll controller").in(0, 12, {}, 2),
    real("MC_YAW_P", 2.8, "Gain of the yaw controller").in(0, 5, {}, 2),
    real("MPC_YAWRAUTO_MAX", 60, "Greatest yaw rate in autonomous modes").in(5, 360, "deg/s"),
};
constexpr ParamRow copter_rate_rows[] = {
    int32("MC_AIRMODE", 0, "Which axes keep their authority at low thrust").one_of(airmodes),
    real("MC_PITCHRATE_D", 0.003, "Differential gain of the pitch rate controller").in(0, 0, {}, 4),
    real("MC_PITCHRATE_I", 0.2, "Integral gain of the pitch rate controller").in(0, 0, {}, 3),
    real("MC_PITCHRATE_K", 1, "Factor on all gains of the pitch rate controller").in(0.01, 5, {}, 4),
    real("MC_PITCHRATE_P", 0.15, "Proportional gain of the pitch rate controller").in(0.01, 0.6, {}, 3),
    real("MC_ROLLRATE_D", 0.003, "Differential gain of the roll rate controller").in(0, 0.01, {}, 4),
    real("MC_ROLLRATE_I", 0.2, "Integral gain of the roll rate controller").in(0, 0, {}, 3),
    real("MC_ROLLRATE_K", 1, "Factor on all gains of the roll rate controller").in(0.01, 5, {}, 4),
    real("MC_ROLLRATE_P", 0.15, "Proportional gain of the roll rate controller").in(0.01, 0.5, {}, 3),
    real("MC_YAWRATE_D", 0, "Differential gain of the yaw rate controller").in(0, 0, {}, 2),
    real("MC_YAWRATE_I", 0.1, "Integral gain of the yaw rate controller").in(0, 0, {}, 2),
    real("MC_YAWRATE_K", 1, "Factor on all gains of the yaw rate controller").in(0, 5, {}, 4),
    real("MC_YAWRATE_P", 0.2, "Proportional gain of the yaw rate controller").in(0, 0.6, {}, 2),
};
constexpr ParamRow copter_mission_rows[] = {
    real("NAV_MC_ALT_RAD", 0.8, "Altitude error at which a waypoint counts as reached").in(0.05, 200, "m", 1),
};
constexpr ParamGroup px4_copter_groups[] = {
    {"Multicopter Position Control", copter_position_rows},
    {"Multicopter Attitude Control", copter_attitude_rows},
    {"Multicopter Rate Control", copter_rate_rows},
    {"Mission", copter_mission_rows},
};
constexpr ParamPreset px4_copter_presets[] = {{"RTL_RETURN_ALT", 30}, {"RTL_DESCEND_ALT", 10}};

constexpr ParamRow plane_rows[] = {
    real("FW_AIRSPD_MAX", 20, "Greatest airspeed").in(0.5, 0, "m/s", 1),
    real("FW_AIRSPD_MIN", 10, "Smallest airspeed").in(0.5, 0, "m/s", 1),
    real("FW_AIRSPD_STALL", 7, "Airspeed at which the vehicle stalls").in(0.5, 0, "m/s", 1),
    real("FW_AIRSPD_TRIM", 15, "Airspeed in autonomous modes").in(0.5, 0, "m/s", 1),
    real("FW_LND_ANG", 5, "Angle of the landing approach").in(1, 15, "deg", 1),
    real("FW_P_LIM_MAX", 30, "Greatest pitch").in(0, 60, "deg", 1),
    real("FW_P_LIM_MIN", -30, "Smallest pitch").in(-60, 0, "deg", 1),
    real("FW_R_LIM", 50, "Greatest roll").in(35, 65, "deg", 1),
    real("FW_THR_MAX", 1, "Greatest throttle").in(0, 1, "norm", 2),
    real("FW_THR_TRIM", 0.6, "Throttle that keeps the trim airspeed in level flight").in(0, 1, "norm", 2),
    real("FW_TKO_PITCH_MIN", 10, "Smallest pitch during take-off").in(-5, 30, "deg", 1),
    real("FW_T_CLMB_MAX", 5, "Greatest climb rate").in(1, 15, "m/s", 1),
    real("FW_T_CLMB_R_SP", 3, "Climb rate in autonomous modes").in(0.5, 15, "m/s", 2),
    real("FW_T_SINK_MAX", 5, "Greatest sink rate").in(1, 15, "m/s", 1),
    real("FW_T_SINK_R_SP", 2, "Sink rate in autonomous modes").in(0.5, 15, "m/s", 2),
    real("NAV_FW_ALT_RAD", 10, "Altitude error at which a waypoint counts as reached").in(0.05, 200, "m", 1),
    int32("RWTO_TKOFF", 1, "Take off from a runway").one_of(off_on),
};
constexpr ParamRow plane_attitude_rows[] = {
    real("FW_PR_I", 0.1, "Integral gain of the pitch rate controller").in(0, 10, {}, 3),
    real("FW_PR_P", 0.08, "Proportional gain of the pitch rate controller").in(0, 10, {}, 3),
    real("FW_P_TC", 0.4, "Time constant of the pitch controller").in(0.2, 1, "s", 2),
    real("FW_RR_I", 0.1, "Integral gain of the roll rate controller").in(0, 10, {}, 3),
    real("FW_RR_P", 0.05, "Proportional gain of the roll rate controller").in(0, 10, {}, 3),
    real("FW_R_TC", 0.4, "Time constant of the roll controller").in(0.2, 1, "s", 2),
};
constexpr ParamGroup px4_plane_groups[] = {
    {"Fixed-wing Control", plane_rows},
    {"Fixed-wing Attitude Control", plane_attitude_rows},
};
constexpr ParamPreset px4_plane_presets[] = {
    {"MAV_TYPE", 1}, {"MIS_TAKEOFF_ALT", 30}, {"SYS_AUTOSTART", 10041}, {"SYS_HAS_NUM_ASPD", 1}};

constexpr ParamRow rover_rows[] = {
    real("RA_MAX_STR_ANG", 0.5236, "Greatest steering angle").in(0, 1.5708, "rad", 2),
    real("RA_WHEEL_BASE", 0.5, "Distance of the axles").in(0, 100, "m", 3),
    real("RO_ACCEL_LIM", 3, "Greatest acceleration").in(-1, 100, "m/s^2", 2),
    real("RO_DECEL_LIM", 6, "Greatest deceleration").in(-1, 100, "m/s^2", 2),
    real("RO_JERK_LIM", 15, "Greatest jerk").in(-1, 100, "m/s^3", 2),
    real("RO_MAX_THR_SPEED", 6, "Speed at full throttle").in(0, 100, "m/s", 2),
    real("RO_SPEED_I", 0.1, "Integral gain of the speed controller").in(0, 100, {}, 3),
    real("RO_SPEED_LIM", 5, "Greatest speed, and speed in autonomous modes").in(-1, 100, "m/s", 2),
    real("RO_SPEED_P", 1, "Proportional gain of the speed controller").in(0, 100, {}, 2),
    real("RO_YAW_P", 5, "Gain of the yaw controller").in(0, 100, {}, 3),
    real("RO_YAW_RATE_LIM", 100, "Greatest yaw rate").in(0, 10000, "deg/s", 1),
};
constexpr ParamGroup px4_rover_groups[] = {{"Rover Control", rover_rows}};
constexpr ParamPreset px4_rover_presets[] = {{"COM_DISARM_LAND", -1}, {"COM_DISARM_PRFLT", -1}, {"MAV_TYPE", 10},
                                             {"NAV_ACC_RAD", 2},      {"SYS_AUTOSTART", 10045}, {"RTL_LAND_DELAY", -1}};

}  // namespace

const ParamTable& px4_parameters(Kind kind) {
    static const ParamTable quad = joined({px4_common_groups, px4_copter_groups}, px4_copter_presets);
    static const ParamTable plane = joined({px4_common_groups, px4_plane_groups}, px4_plane_presets);
    static const ParamTable rover = joined({px4_common_groups, px4_rover_groups}, px4_rover_presets);
    return kind == Kind::quad ? quad : kind == Kind::plane ? plane : rover;
}

}  // namespace mavloom::flight
