// SPDX-License-Identifier: MIT
// Parameters of one kind of PX4 vehicle: multicopter, plane or rover.
//
// Names, types, ranges, units and names of values are those of PX4 1.17; defaults are those of its simulated airframes.
#include "flight/firmware/param_tables/px4_choices.hpp"
#include "flight/firmware/param_tables/rows.hpp"

namespace mavloom::flight {

namespace {

constexpr ParamRow px4_copter_autotune[] = {
    int32("MC_AT_APPLY", 1).one_of(mc_at_apply_values),
    int32("MC_AT_EN", 1).one_of(off_on),
    real("MC_AT_RISE_TIME", 0.14).in(0.01, 0.5, "s", 2),
    real("MC_AT_SYSID_AMP", 0.7).in(0.1, 6, {}, 1),
};
constexpr ParamRow px4_copter_flight_task_orbit[] = {
    real("MC_ORBIT_RAD_MAX", 1000).in(1, 10000, "m", 1),
    int32("MC_ORBIT_YAW_MOD", 0).one_of(mc_orbit_yaw_mod_values),
};
constexpr ParamRow px4_copter_follow_target[] = {
    int32("FLW_TGT_ALT_M", 0, "How the altitude depends on the target's").one_of(flw_tgt_alt_m_values),
    real("FLW_TGT_DST", 8, "Distance from the target").from(1, "m"),
    real("FLW_TGT_FA", 180, "Direction from the target, in relation to its course").in(-180, 180),
    real("FLW_TGT_HT", 8, "Height above the target's ground").from(8, "m"),
    real("FLW_TGT_MAX_VEL", 5, "Greatest speed on the circle around the target").in(0, 20, {}, 1),
    real("FLW_TGT_RS", 0.1, "How quickly the vehicle reacts to the target").in(0, 1, {}, 2),
};
constexpr ParamRow px4_copter_hover_thrust_estimator[] = {
    real("HTE_ACC_GATE", 3).in(1, 10, "SD", 1),
    real("HTE_HT_ERR_INIT", 0.1).in(0, 1, "normalized_thrust", 3),
    real("HTE_HT_NOISE", 0.0036).in(0.0001, 1, "normalized_thrust/s", 4),
    real("HTE_THR_RANGE", 0.2).in(0.01, 0.4, "normalized_thrust", 2),
    real("HTE_VXY_THR", 10).in(1, 20, "m/s", 1),
    real("HTE_VZ_THR", 2).in(1, 10, "m/s", 1),
};
constexpr ParamRow px4_copter_land_detector[] = {
    real("LNDMC_ALT_GND", 2).from(-1, "m", 2),
    real("LNDMC_ROT_MAX", 20).unit_of("deg/s", 1),
    real("LNDMC_XY_VEL_MAX", 1.5).unit_of("m/s", 1),
    real("LNDMC_Z_VEL_MAX", 0.25).from(0, "m/s", 2),
};
constexpr ParamRow px4_copter_mission[] = {
    int32("MPC_YAW_MODE", 0).in(0, 5).one_of(mpc_yaw_mode_values),
};
constexpr ParamRow px4_copter_mixer_output[] = {
    int32("MC_AIRMODE", 0, "Which axes keep their authority at low thrust").one_of(mc_airmode_values),
};
constexpr ParamRow px4_copter_motor_failure[] = {
    real("MOTFAIL_C2T", 35).in(0, 50, "A/%", 2),
    real("MOTFAIL_OFF", 10).in(0, 30, "A", 2),
    real("MOTFAIL_TIME", 1).in(0.01, 10, "s", 2),
};
constexpr ParamRow px4_copter_multicopter_acro_mode[] = {
    real("MC_ACRO_EXPO", 0).in(0, 1, {}, 2),
    real("MC_ACRO_EXPO_Y", 0).in(0, 1, {}, 2),
    real("MC_ACRO_P_MAX", 100).in(0, 1800, "deg/s", 1),
    real("MC_ACRO_R_MAX", 100).in(0, 1800, "deg/s", 1),
    real("MC_ACRO_SUPEXPO", 0).in(0, 0.95, {}, 2),
    real("MC_ACRO_SUPEXPOY", 0).in(0, 0.95, {}, 2),
    real("MC_ACRO_Y_MAX", 100).in(0, 1800, "deg/s", 1),
};
constexpr ParamRow px4_copter_multicopter_attitude_control[] = {
    real("MC_PITCH_P", 4, "Gain of the pitch controller").in(0, 12, {}, 2),
    real("MC_REF_FF", 0).in(0, 1, {}, 2),
    real("MC_REF_FF_MAX", 100).in(0, 1800, "deg/s"),
    real("MC_REF_W_N", 50).in(1, 200, "rad/s"),
    real("MC_ROLL_P", 4, "Gain of the roll controller").in(0, 12, {}, 2),
    real("MC_YAW_P", 2.8, "Gain of the yaw controller").in(0, 5, {}, 2),
    real("MC_YAW_WEIGHT", 0.4).in(0, 1, {}, 2),
    real("MC_{ROLLRATE,PITCHRATE,YAWRATE}_MAX", 220).in(0, 1800, "deg/s", 1),
    real("MPC_YAWRAUTO_ACC", 20).in(5, 360, "deg/s^2"),
    real("MPC_YAWRAUTO_MAX", 60, "Greatest yaw rate in autonomous modes").in(5, 360, "deg/s"),
};
constexpr ParamRow px4_copter_multicopter_position_control[] = {
    real("CP_DELAY", 0.4).in(0, 1, "s"),
    real("CP_DIST", -1, "Distance to keep from obstacles; negative: off").in(-1, 15, "m"),
    int32("CP_GO_NO_DATA", 0).one_of(off_on),
    real("CP_GUIDE_ANG", 30).in(0, 90, "deg"),
    real("MC_MAN_TILT_TAU", 0).in(0, 2, "s", 2),
    int32("MPC_ACC_DECOUPLE", 1).one_of(off_on),
    real("MPC_ACC_DOWN_MAX", 3, "Greatest downward acceleration").in(2, 15, "m/s^2", 1),
    real("MPC_ACC_HOR", 3, "Horizontal acceleration").in(2, 15, "m/s^2", 1),
    real("MPC_ACC_HOR_MAX", 5, "Greatest horizontal acceleration under manual control").in(2, 15, "m/s^2", 2),
    real("MPC_ACC_UP_MAX", 4, "Greatest upward acceleration").in(2, 15, "m/s^2", 1),
    int32("MPC_ALT_MODE", 2).in(0, 2).one_of(mpc_alt_mode_values),
    int32("MPC_AUTO_NUDGING", 0).in(0, 3).bits_of(mpc_auto_nudging_bits),
    real("MPC_HOLD_MAX_XY", 0.8, "Speed below which the vehicle holds its position when sticks are centred")
        .in(0, 3, "m/s", 2),
    real("MPC_HOLD_MAX_Z", 0.6).in(0, 3, "m/s", 2),
    real("MPC_JERK_AUTO", 4, "Greatest jerk in autonomous modes").in(1, 80, "m/s^3", 1),
    real("MPC_JERK_MAX", 8).in(0.5, 500, "m/s^3"),
    real("MPC_LAND_ALT1", 10, "Height below which a landing slows down").in(0, 122, "m", 1),
    real("MPC_LAND_ALT2", 5, "Height below which a landing is slow").in(0, 122, "m", 1),
    real("MPC_LAND_ALT3", 1).in(0, 122, "m", 1),
    real("MPC_LAND_CRWL", 0.3, "Descent rate close to the ground, if its distance is known").from(0.1, "m/s", 1),
    real("MPC_LAND_RADIUS", -1).from(-1, "m"),
    real("MPC_LAND_SPEED", 0.7, "Descent rate of the last part of a landing").from(0.6, "m/s", 1),
    real("MPC_MANTHR_MIN", 0.08).in(0, 1, "norm", 2),
    real("MPC_MAN_TILT_MAX", 35, "Greatest tilt under manual control").in(1, 70, "deg"),
    real("MPC_MAN_Y_MAX", 150).in(0, 400, "deg/s"),
    real("MPC_MAN_Y_TAU", 0.08).in(0, 5, "s", 2),
    int32("MPC_POS_MODE", 4, "How sticks steer in Position mode").one_of(mpc_pos_mode_values),
    int32("MPC_THR_CURVE", 0).one_of(mpc_thr_curve_values),
    real("MPC_THR_HOVER", 0.5, "Thrust that carries the vehicle").in(0.1, 0.8, "norm", 2),
    real("MPC_THR_MAX", 1).in(0, 1, "norm", 2),
    real("MPC_THR_MIN", 0.12).in(0.05, 0.5, "norm", 2),
    real("MPC_THR_XY_MARG", 0.3).in(0, 0.5, "norm", 2),
    real("MPC_TILTMAX_AIR", 45, "Greatest tilt in flight").in(20, 89, "deg"),
    real("MPC_TILTMAX_LND", 12, "Greatest tilt while taking off and landing").in(5, 89, "deg"),
    real("MPC_TKO_RAMP_T", 3, "Time in which the thrust rises at take-off").in(0, 5, "s"),
    real("MPC_TKO_SPEED", 1.5, "Climb rate of a take-off").in(1, 5, "m/s", 2),
    real("MPC_VELD_LP", 5).in(0, 50, "Hz", 1),
    real("MPC_VEL_LP", 0).in(0, 50, "Hz", 1),
    real("MPC_VEL_MANUAL", 10).in(3, 20, "m/s", 1),
    real("MPC_VEL_MAN_BACK", -1).in(-1, 20, "m/s", 1),
    real("MPC_VEL_MAN_SIDE", -1).in(-1, 20, "m/s", 1),
    real("MPC_VEL_NF_BW", 5).in(0, 50, "Hz", 1),
    real("MPC_VEL_NF_FRQ", 0).in(0, 50, "Hz", 1),
    real("MPC_XY_CRUISE", 5, "Horizontal speed in autonomous modes").in(3, 20, "m/s"),
    real("MPC_XY_ERR_MAX", 2).in(0, 10, {}, 1),
    real("MPC_XY_P", 0.95, "Gain of the horizontal position controller").in(0, 2, {}, 2),
    real("MPC_XY_TRAJ_P", 0.5).in(0.1, 1, {}, 1),
    real("MPC_XY_VEL_ALL", -10, "Limits of several axes at once; negative: each for itself").in(-20, 20, {}, 1),
    real("MPC_XY_VEL_D_ACC", 0.2, "Differential gain of the horizontal velocity controller").in(0.1, 2, {}, 2),
    real("MPC_XY_VEL_I_ACC", 0.4, "Integral gain of the horizontal velocity controller").in(0, 60, {}, 2),
    real("MPC_XY_VEL_MAX", 12, "Greatest horizontal speed").in(0, 20, "m/s", 1),
    real("MPC_XY_VEL_P_ACC", 1.8, "Proportional gain of the horizontal velocity controller").in(1.2, 5, {}, 2),
    real("MPC_Z_ERR_MAX", 1).in(0, 10, {}, 1),
    real("MPC_Z_P", 1, "Gain of the altitude controller").in(0.1, 1.5, {}, 2),
    real("MPC_Z_VEL_ALL", -3, "Limits of several axes at once; negative: each for itself").in(-3, 8, {}, 1),
    real("MPC_Z_VEL_D_ACC", 0, "Differential gain of the vertical velocity controller").in(0, 2, {}, 2),
    real("MPC_Z_VEL_I_ACC", 2, "Integral gain of the vertical velocity controller").in(0.2, 3, {}, 2),
    real("MPC_Z_VEL_MAX_DN", 1.5, "Greatest descent rate").in(0.5, 4, "m/s", 1),
    real("MPC_Z_VEL_MAX_UP", 3, "Greatest climb rate").in(0.5, 8, "m/s", 1),
    real("MPC_Z_VEL_P_ACC", 4, "Proportional gain of the vertical velocity controller").in(2, 15, {}, 2),
    real("MPC_Z_V_AUTO_DN", 1.5, "Descent rate in autonomous modes").in(0.5, 4, "m/s", 1),
    real("MPC_Z_V_AUTO_UP", 3, "Climb rate in autonomous modes").in(0.5, 8, "m/s", 1),
};
constexpr ParamRow px4_copter_multicopter_position_slow_mode[] = {
    real("MC_SLOW_DEF_HVEL", 3).from(0.1, "m/s", 2),
    real("MC_SLOW_DEF_VVEL", 1).from(0.1, "m/s", 2),
    real("MC_SLOW_DEF_YAWR", 45).from(1, "deg/s"),
    int32("MC_SLOW_MAP_HVEL", 0).one_of(slow_mode_inputs),
    int32("MC_SLOW_MAP_PTCH", 0).one_of(mc_slow_map_ptch_values),
    int32("MC_SLOW_MAP_VVEL", 0).one_of(slow_mode_inputs),
    int32("MC_SLOW_MAP_YAWR", 0).one_of(slow_mode_inputs),
    real("MC_SLOW_MIN_HVEL", 0.3).from(0.1, "m/s", 2),
    real("MC_SLOW_MIN_VVEL", 0.3).from(0.1, "m/s", 2),
    real("MC_SLOW_MIN_YAWR", 3).from(1, "deg/s"),
};
constexpr ParamRow px4_copter_multicopter_rate_control[] = {
    int32("MC_BAT_SCALE_EN", 0).one_of(off_on),
    real("MC_PITCHRATE_D", 0.003, "Differential gain of the pitch rate controller").from(0, {}, 4),
    real("MC_PITCHRATE_I", 0.2, "Integral gain of the pitch rate controller").from(0, {}, 3),
    real("MC_PITCHRATE_K", 1, "Factor on all gains of the pitch rate controller").in(0.01, 5, {}, 4),
    real("MC_PITCHRATE_P", 0.15, "Proportional gain of the pitch rate controller").in(0.01, 0.6, {}, 3),
    real("MC_PR_INT_LIM", 0.3).from(0, {}, 2),
    real("MC_ROLLRATE_D", 0.003, "Differential gain of the roll rate controller").in(0, 0.01, {}, 4),
    real("MC_ROLLRATE_I", 0.2, "Integral gain of the roll rate controller").from(0, {}, 3),
    real("MC_ROLLRATE_K", 1, "Factor on all gains of the roll rate controller").in(0.01, 5, {}, 4),
    real("MC_ROLLRATE_P", 0.15, "Proportional gain of the roll rate controller").in(0.01, 0.5, {}, 3),
    real("MC_RR_INT_LIM", 0.3).from(0, {}, 2),
    real("MC_YAWRATE_D", 0, "Differential gain of the yaw rate controller").from(0, {}, 4),
    real("MC_YAWRATE_I", 0.1, "Integral gain of the yaw rate controller").from(0, {}, 3),
    real("MC_YAWRATE_K", 1, "Factor on all gains of the yaw rate controller").in(0.01, 5, {}, 4),
    real("MC_YAWRATE_P", 0.2, "Proportional gain of the yaw rate controller").in(0, 0.6, {}, 3),
    real("MC_YAW_TQ_CUTOFF", 2).in(0, 10, "Hz", 3),
    real("MC_YR_INT_LIM", 0.3).from(0, {}, 2),
    real("MC_{ROLLRATE,PITCHRATE,YAWRATE}_FF", 0).from(0, {}, 4),
};

constexpr ParamGroup px4_copter_groups[] = {
    {"Autotune", px4_copter_autotune},
    {"Flight Task Orbit", px4_copter_flight_task_orbit},
    {"Follow target", px4_copter_follow_target},
    {"Hover Thrust Estimator", px4_copter_hover_thrust_estimator},
    {"Land Detector", px4_copter_land_detector},
    {"Mission", px4_copter_mission},
    {"Mixer Output", px4_copter_mixer_output},
    {"Motor Failure", px4_copter_motor_failure},
    {"Multicopter Acro Mode", px4_copter_multicopter_acro_mode},
    {"Multicopter Attitude Control", px4_copter_multicopter_attitude_control},
    {"Multicopter Position Control", px4_copter_multicopter_position_control},
    {"Multicopter Position Slow Mode", px4_copter_multicopter_position_slow_mode},
    {"Multicopter Rate Control", px4_copter_multicopter_rate_control},
};
constexpr ParamPreset px4_copter_presets[] = {
    {"CA_ROTOR0_P{X,Y}", 1}, {"CA_ROTOR1_P{X,Y}", -1}, {"CA_ROTOR2_PX", 1},     {"CA_ROTOR2_PY", -1},
    {"CA_ROTOR3_PX", -1},    {"CA_ROTOR3_PY", 1},      {"CA_ROTOR_COUNT", 4},   {"CA_ROTOR{2,3}_KM", -0.05},
    {"MC_YAWRATE_MAX", 200}, {"PWM_MAIN_FUNC1", 101},  {"PWM_MAIN_FUNC2", 102}, {"PWM_MAIN_FUNC3", 103},
    {"PWM_MAIN_FUNC4", 104}, {"RTL_DESCEND_ALT", 10},  {"RTL_RETURN_ALT", 30}};

constexpr ParamRow px4_plane_airspeed_validator[] = {
    int32("ASPD_DO_CHECKS", 7).in(0, 31).bits_of(aspd_do_checks_bits),
    int32("ASPD_FALLBACK", 0).one_of(aspd_fallback_values),
    real("ASPD_FP_T_WINDOW", 2).from(0, "s", 1),
    real("ASPD_FS_INNOV", 5).in(0.5, 10, "m/s", 1),
    real("ASPD_FS_INTEG", 10).in(0, 50, "m", 1),
    real("ASPD_FS_T_START", -1).from(-1, "s", 1),
    real("ASPD_FS_T_STOP", 1).from(0, "s", 1),
    int32("ASPD_PRIMARY", 1).one_of(aspd_primary_values).at_reboot(),
    int32("ASPD_SCALE_APPLY", 2).one_of(aspd_scale_apply_values),
    real("ASPD_SCALE_{2,3}", 1).in(0.5, 2, {}, 2),
    real("ASPD_TAS_NOISE", 1.4).in(0, 4, "m/s", 1),
    real("ASPD_WERR_THR", 2).in(0.01, 5, "m/s", 2),
    real("ASPD_WIND_NSD", 0.1).in(0, 1, "m/s^2/sqrt(Hz)", 2),
};
constexpr ParamRow px4_plane_autotune[] = {
    int32("FW_AT_APPLY", 2).one_of(fw_at_apply_values),
    int32("FW_AT_AXES", 3).in(1, 7).bits_of(fw_at_axes_bits),
    int32("FW_AT_MAN_AUX", 0).in(0, 6).one_of(fw_at_man_aux_values),
    real("FW_AT_SYSID_F{0,1}", 1).in(0.1, 30, "Hz", 1),
    real("FW_AT_SYSID_TIME", 10).in(5, 120, "s"),
    int32("FW_AT_SYSID_TYPE", 1).one_of(fw_at_sysid_type_values),
};
constexpr ParamRow px4_plane_fw_attitude_control[] = {
    real("FW_MAN_P_MAX", 30).in(0, 90, "deg", 1),
    real("FW_MAN_R_MAX", 45).in(0, 90, "deg", 1),
    real("FW_MAN_YR_MAX", 30).from(0, "deg/s", 1),
    real("FW_P_RMAX_NEG", 60).in(0, 180, "deg/s", 1),
    real("FW_P_RMAX_POS", 60).in(0, 180, "deg/s", 1),
    real("FW_P_TC", 0.4, "Time constant of the pitch controller").in(0.2, 1, "s", 2),
    real("FW_R_RMAX", 70).in(0, 180, "deg/s", 1),
    real("FW_R_TC", 0.4, "Time constant of the roll controller").in(0.2, 1, "s", 2),
    real("FW_WR_FF", 0.2, "Feed forward of the rate controller").in(0, 10, "%/rad/s", 2),
    real("FW_WR_I", 0.1).in(0, 10, "%/rad", 3),
    real("FW_WR_IMAX", 0.4).in(0, 1, {}, 2),
    real("FW_WR_P", 0.5).in(0, 10, "%/rad/s", 3),
    int32("FW_W_EN", 0).one_of(off_on),
    real("FW_W_RMAX", 30).in(0, 90, "deg/s", 1),
    real("FW_Y_RMAX", 50).in(0, 180, "deg/s", 1),
};
constexpr ParamRow px4_plane_fw_auto_landing[] = {
    real("FW_FLAPS_LND_SCL", 1).in(0, 1, "norm", 2),
    int32("FW_LND_ABORT", 3).in(0, 3).bits_of(fw_lnd_abort_bits),
    real("FW_LND_AIRSPD", -1).from(-1, "m/s", 1),
    real("FW_LND_ANG", 5, "Angle of the landing approach").in(1, 45, "deg", 1),
    int32("FW_LND_EARLYCFG", 0).one_of(off_on),
    real("FW_LND_FLALT", 0.5).from(0, "m", 1),
    real("FW_LND_FL_PMAX", 15).in(0, 45, "deg", 1),
    real("FW_LND_FL_PMIN", 2.5).in(-5, 15, "deg", 1),
    real("FW_LND_FL_SINK", 0.25).in(0, 2, "m/s", 2),
    real("FW_LND_FL_TIME", 1).in(0.1, 5, "s", 1),
    int32("FW_LND_NUDGE", 2).in(0, 2).one_of(fw_lnd_nudge_values),
    real("FW_LND_TD_OFF", 3).in(0, 10, "m", 1),
    real("FW_LND_TD_TIME", -1).in(-1, 5, "s", 1),
    real("FW_LND_THRTC_SC", 1).in(0.2, 1, {}, 1),
    int32("FW_LND_USETER", 1).in(0, 2).one_of(fw_lnd_useter_values),
    real("FW_SPOILERS_LND", 0).in(0, 1, "norm", 2),
};
constexpr ParamRow px4_plane_fw_auto_takeoff[] = {
    real("FW_FLAPS_TO_SCL", 0).in(0, 1, "norm", 2),
    real("FW_LAUN_AC_T", 0.05).in(0, 5, "s", 2),
    real("FW_LAUN_AC_THLD", 30).from(0, "m/s^2", 1),
    real("FW_LAUN_CS_LK_DY", 0).from(0, "s", 1),
    int32("FW_LAUN_DETCN_ON", 0).one_of(off_on),
    real("FW_LAUN_MOT_DEL", 0).in(0, 10, "s", 1),
    real("FW_TKO_AIRSPD", -1).from(-1, "m/s", 1),
    real("FW_TKO_PITCH_MIN", 10, "Smallest pitch during take-off").in(-5, 80, "deg", 1),
};
constexpr ParamRow px4_plane_fw_general[] = {
    int32("FW_GPSF_LT", 30).from(0, "s"),
    real("FW_GPSF_R", 15).in(0, 60, "deg", 1),
    int32("FW_POS_STK_CONF", 2).in(0, 3).bits_of(fw_pos_stk_conf_bits),
    real("FW_P_LIM_MAX", 30, "Greatest pitch").in(0, 80, "deg", 1),
    real("FW_P_LIM_MIN", -30, "Smallest pitch").in(-60, 0, "deg", 1),
    real("FW_R_LIM", 50, "Greatest roll").in(35, 75, "deg", 1),
    real("FW_THR_IDLE", 0).in(0, 1, "norm", 2),
    real("FW_THR_MAX", 1, "Greatest throttle").in(0, 1, "norm", 2),
    real("FW_THR_MIN", 0).in(0, 1, "norm", 2),
    real("FW_T_SPDWEIGHT", 1).in(0, 2, {}, 1),
    real("FW_WING_HEIGHT", 0.5).from(0, "m", 1),
    real("FW_WING_SPAN", 3).from(0.1, "m", 1),
};
constexpr ParamRow px4_plane_fw_lateral_control[] = {
    real("FW_PN_R_SLEW_MAX", 90).from(0, "deg/s"),
};
constexpr ParamRow px4_plane_fw_longitudinal_control[] = {
    real("FW_THR_SLEW_MAX", 0).in(0, 1, {}, 2),
    real("FW_T_ALT_TC", 5).from(2, {}, 2),
    real("FW_T_F_ALT_ERR", -1).from(-1),
    real("FW_T_HRATE_FF", 0.5).in(0, 1, {}, 2),
    real("FW_T_I_GAIN_PIT", 0.1).in(0, 2, {}, 2),
    real("FW_T_PTCH_DAMP", 0.1).in(0, 2, {}, 2),
    real("FW_T_RLL2THR", 15).in(0, 20, {}, 1),
    real("FW_T_SEB_R_FF", 1, "Feed forward of the rate controller").in(0.5, 3, {}, 2),
    real("FW_T_SINK_MAX", 5, "Greatest sink rate").in(1, 15, "m/s", 1),
    real("FW_T_STE_R_TC", 0.4).in(0, 2, {}, 2),
    real("FW_T_TAS_TC", 5).from(2, {}, 2),
    real("FW_T_THR_DAMPING", 0.05).in(0, 1, {}, 3),
    real("FW_T_THR_INTEG", 0.02).in(0, 1, {}, 3),
    real("FW_T_THR_LOW_HGT", -1).from(-1, "m"),
    real("FW_T_VERT_ACC", 7).in(1, 10, "m/s^2", 1),
    real("FW_WIND_ARSP_SC", 0).from(0, {}, 2),
};
constexpr ParamRow px4_plane_fw_npfg_control[] = {
    real("FW_WP_RST_DIST", -1).in(-1, 10000, "m"),   real("NPFG_DAMPING", 0.7).in(0.1, 1, {}, 2),
    int32("NPFG_LB_PERIOD", 1).one_of(off_on),       real("NPFG_PERIOD", 10).in(1, 100, "s", 1),
    real("NPFG_PERIOD_SF", 1.5).in(1, 10, {}, 1),    real("NPFG_ROLL_TC", 0.5).in(0, 2, "s", 2),
    real("NPFG_SW_DST_MLT", 0.32).in(0.1, 1, {}, 2), int32("NPFG_UB_PERIOD", 1).one_of(off_on),
};
constexpr ParamRow px4_plane_fw_performance[] = {
    real("FW_AIRSPD_FLP_SC", 1).in(0.5, 1, {}, 2),
    real("FW_AIRSPD_MIN", 10, "Smallest airspeed").from(0.5, "m/s", 1),
    real("FW_AIRSPD_STALL", 7, "Airspeed at which the vehicle stalls").from(0.5, "m/s", 1),
    real("FW_SERVICE_CEIL", -1).from(-1, "m"),
    real("FW_THR_ASPD_MAX", 0).in(0, 1, {}, 2),
    real("FW_THR_ASPD_MIN", 0).in(0, 1, {}, 2),
    real("FW_THR_TRIM", 0.6, "Throttle that keeps the trim airspeed in level flight").in(0, 1, "norm", 2),
    real("FW_T_CLMB_MAX", 5, "Greatest climb rate").from(1, "m/s", 1),
    real("FW_T_SINK_MIN", 2).from(1, "m/s", 1),
};
constexpr ParamRow px4_plane_fw_rate_control[] = {
    int32("FW_ACRO_YAW_EN", 0).one_of(off_on),
    real("FW_ACRO_{X,Y,Z}_MAX", 90).in(10, 720, "deg"),
    int32("FW_ARSP_SCALE_EN", 1).one_of(off_on),
    int32("FW_BAT_SCALE_EN", 0).one_of(off_on),
    real("FW_DTRIM_P_VMAX", 0).in(-0.5, 0.5, {}, 2),
    real("FW_DTRIM_P_VMIN", 0).in(-0.5, 0.5, {}, 2),
    real("FW_DTRIM_R_VMAX", 0).in(-0.5, 0.5, {}, 2),
    real("FW_DTRIM_R_VMIN", 0).in(-0.5, 0.5, {}, 2),
    real("FW_DTRIM_Y_VMAX", 0).in(-0.5, 0.5, {}, 2),
    real("FW_DTRIM_Y_VMIN", 0).in(-0.5, 0.5, {}, 2),
    int32("FW_FLAPS_MAN", 0).one_of(fw_flaps_man_values),
    int32("FW_GC_EN", 1).one_of(off_on),
    real("FW_GC_GAIN_MIN", 0.3).in(0, 1, {}, 2),
    real("FW_MAN_P_SC", 1).from(0, "norm", 2),
    real("FW_MAN_R_SC", 1).in(0, 1, "norm", 2),
    real("FW_MAN_Y_SC", 1).from(0, "norm", 2),
    real("FW_PR_D", 0, "Differential gain of the rate controller").in(0, 10, "%/rad/s", 3),
    real("FW_PR_FF", 0.5, "Feed forward of the rate controller").in(-10, 10, "%/rad/s", 2),
    real("FW_PR_I", 0.1, "Integral gain of the pitch rate controller").in(0, 10, "%/rad", 3),
    real("FW_PR_IMAX", 0.4).in(0, 1, {}, 2),
    real("FW_PR_P", 0.08, "Proportional gain of the pitch rate controller").in(0, 10, "%/rad/s", 3),
    real("FW_RLL_TO_YAW_FF", 0).from(0, {}, 1),
    real("FW_RR_D", 0, "Differential gain of the rate controller").in(0, 10, "%/rad/s", 3),
    real("FW_RR_FF", 0.5, "Feed forward of the rate controller").in(-10, 10, "%/rad/s", 2),
    real("FW_RR_I", 0.1, "Integral gain of the roll rate controller").in(0, 10, "%/rad", 2),
    real("FW_RR_IMAX", 0.2).in(0, 1, {}, 2),
    real("FW_RR_P", 0.05, "Proportional gain of the roll rate controller").in(0, 10, "%/rad/s", 3),
    int32("FW_SPOILERS_MAN", 0).one_of(fw_spoilers_man_values),
    int32("FW_USE_AIRSPD", 1).one_of(off_on),
    real("FW_YR_D", 0, "Differential gain of the rate controller").in(0, 10, "%/rad/s", 3),
    real("FW_YR_FF", 0.3, "Feed forward of the rate controller").in(-10, 10, "%/rad/s", 2),
    real("FW_YR_I", 0.1, "Integral gain of the yaw rate controller").in(0, 10, "%/rad", 1),
    real("FW_YR_IMAX", 0.2).in(0, 1, {}, 2),
    real("FW_YR_P", 0.05, "Proportional gain of the yaw rate controller").in(0, 10, "%/rad/s", 3),
};
constexpr ParamRow px4_plane_geometry[] = {
    int32("CA_CS_LAUN_LK", 0).in(0, 255).bits_of(ca_cs_laun_lk_bits),
    int32("CA_SV_CS_COUNT", 0, "Number of control surfaces").one_of(ca_sv_cs_count_values),
    real("CA_SV_CS{0..7}_FLAP", 0, "Share of the control surface in flaps").in(-1, 1, {}, 2),
    real("CA_SV_CS{0..7}_SPOIL", 0, "Share of the control surface in spoilers").in(-1, 1, {}, 2),
    real("CA_SV_CS{0..7}_TRIM", 0, "Neutral position of the control surface").in(-1, 1, {}, 2),
    real("CA_SV_CS{0..7}_TRQ_P", 0, "Torque of the control surface").unit_of({}, 2),
    real("CA_SV_CS{0..7}_TRQ_R", 0, "Torque of the control surface").unit_of({}, 2),
    real("CA_SV_CS{0..7}_TRQ_Y", 0, "Torque of the control surface").unit_of({}, 2),
    int32("CA_SV_CS{0..7}_TYPE", 0, "Kind of the control surface").one_of(control_surfaces),
};
constexpr ParamRow px4_plane_land_detector[] = {
    real("LNDFW_AIRSPD_MAX", 6).in(2, 30, "m/s", 1),          real("LNDFW_ROT_MAX", 0.5).unit_of("deg/s", 1),
    real("LNDFW_TRIG_TIME", 2).from(0.1, "s", 1).at_reboot(), real("LNDFW_VEL_XY_MAX", 5).in(0.5, 20, "m/s", 1),
    real("LNDFW_VEL_Z_MAX", 1).in(0.1, 20, "m/s", 1),         real("LNDFW_XYACC_MAX", 8).in(2, 30, "m/s^2", 1),
};
constexpr ParamRow px4_plane_runway_takeoff[] = {
    real("RWTO_MAX_THR", 1).in(0, 1, "norm", 2),
    int32("RWTO_NUDGE", 1).one_of(off_on),
    real("RWTO_PSP", 0).in(-10, 20, "deg", 1),
    real("RWTO_RAMP_TIME", 2).in(1, 15, "s", 2),
    real("RWTO_ROT_AIRSPD", -1).from(-1, "m/s", 1),
    real("RWTO_ROT_TIME", 1).from(0.1, "s", 1),
    int32("RWTO_TKOFF", 1, "Take off from a runway").one_of(off_on),
};

constexpr ParamGroup px4_plane_groups[] = {
    {"Airspeed Validator", px4_plane_airspeed_validator},
    {"Autotune", px4_plane_autotune},
    {"FW Attitude Control", px4_plane_fw_attitude_control},
    {"FW Auto Landing", px4_plane_fw_auto_landing},
    {"FW Auto Takeoff", px4_plane_fw_auto_takeoff},
    {"FW General", px4_plane_fw_general},
    {"FW Lateral Control", px4_plane_fw_lateral_control},
    {"FW Longitudinal Control", px4_plane_fw_longitudinal_control},
    {"FW NPFG Control", px4_plane_fw_npfg_control},
    {"FW Performance", px4_plane_fw_performance},
    {"FW Rate Control", px4_plane_fw_rate_control},
    {"Geometry", px4_plane_geometry},
    {"Land Detector", px4_plane_land_detector},
    {"Runway Takeoff", px4_plane_runway_takeoff},
};
constexpr ParamPreset px4_plane_presets[] = {
    {"CA_AIRFRAME", 1},      {"CA_ROTOR0_PX", 0.3},   {"CA_ROTOR_COUNT", 1},   {"CA_SV_CS0_TRQ_R", 1},
    {"CA_SV_CS0_TYPE", 15},  {"CA_SV_CS1_TRQ_P", 1},  {"CA_SV_CS1_TYPE", 3},   {"CA_SV_CS2_TRQ_Y", 1},
    {"CA_SV_CS2_TYPE", 4},   {"CA_SV_CS_COUNT", 3},   {"FW_ACRO_Z_MAX", 45},   {"FW_AT_SYSID_F1", 10},
    {"MAV_TYPE", 1},         {"MIS_TAKEOFF_ALT", 30}, {"PWM_MAIN_FUNC1", 201}, {"PWM_MAIN_FUNC2", 202},
    {"PWM_MAIN_FUNC3", 203}, {"PWM_MAIN_FUNC4", 101}, {"SIH_VEHICLE_TYPE", 1}, {"SYS_AUTOSTART", 10041},
    {"SYS_HAS_NUM_ASPD", 1}};

constexpr ParamRow px4_rover_pure_pursuit[] = {
    real("PP_LOOKAHD_GAIN", 1).in(0.1, 100, {}, 2),
    real("PP_LOOKAHD_MAX", 10).in(0.1, 100, "m", 2),
    real("PP_LOOKAHD_MIN", 1).in(0.1, 100, "m", 2),
};
constexpr ParamRow px4_rover_rover_ackermann[] = {
    real("RA_ACC_RAD_GAIN", 1).in(1, 100, {}, 2),
    real("RA_ACC_RAD_MAX", -1).in(-1, 100, "m", 2),
    real("RA_MAX_STR_ANG", 0.5236, "Greatest steering angle").in(0, 1.5708, "rad", 2),
    real("RA_STR_RATE_LIM", -1).in(-1, 1000, "deg/s", 2),
    real("RA_WHEEL_BASE", 0.5, "Distance of the axles").in(0, 100, "m", 3),
};
constexpr ParamRow px4_rover_rover_attitude_control[] = {
    real("RO_YAW_P", 5, "Gain of the yaw controller").in(0, 100, {}, 3),
};
constexpr ParamRow px4_rover_rover_rate_control[] = {
    real("RO_YAW_ACCEL_LIM", -1).in(-1, 10000, "deg/s^2", 2),
    real("RO_YAW_DECEL_LIM", -1).in(-1, 10000, "deg/s^2", 2),
    real("RO_YAW_EXPO", 0).in(0, 1, {}, 2),
    real("RO_YAW_RATE_CORR", 1).in(0.01, 10000, {}, 2),
    real("RO_YAW_RATE_I", 0).in(0, 100, {}, 3),
    real("RO_YAW_RATE_LIM", 100, "Greatest yaw rate").in(0, 10000, "deg/s", 2),
    real("RO_YAW_RATE_P", 0).in(0, 100, {}, 3),
    real("RO_YAW_RATE_TH", 3).in(0, 100, "deg/s", 2),
    real("RO_YAW_STICK_DZ", 0.1).in(0, 1, {}, 2),
    real("RO_YAW_SUPEXPO", 0).in(0, 0.95, {}, 2),
};
constexpr ParamRow px4_rover_rover_velocity_control[] = {
    real("RO_ACCEL_LIM", 3, "Greatest acceleration").in(-1, 100, "m/s^2", 2),
    real("RO_DECEL_LIM", 6, "Greatest deceleration").in(-1, 100, "m/s^2", 2),
    real("RO_JERK_LIM", 15, "Greatest jerk").in(-1, 100, "m/s^3", 2),
    real("RO_MAX_THR_SPEED", 6, "Speed at full throttle").in(0, 100, "m/s", 2),
    real("RO_SPEED_I", 0.1, "Integral gain of the speed controller").in(0, 100, {}, 3),
    real("RO_SPEED_P", 1, "Proportional gain of the speed controller").in(0, 100, {}, 2),
    real("RO_SPEED_RED", -1).in(-1, 100, {}, 2),
    real("RO_SPEED_TH", 0.1).in(0, 100, "m/s", 2),
};

constexpr ParamGroup px4_rover_groups[] = {
    {"Pure Pursuit", px4_rover_pure_pursuit},
    {"Rover Ackermann", px4_rover_rover_ackermann},
    {"Rover Attitude Control", px4_rover_rover_attitude_control},
    {"Rover Rate Control", px4_rover_rover_rate_control},
    {"Rover Velocity Control", px4_rover_rover_velocity_control},
};
constexpr ParamPreset px4_rover_presets[] = {
    {"CA_AIRFRAME", 5},  {"CA_R_REV", 1},        {"COM_DISARM_LAND", -1}, {"COM_DISARM_PRFLT", -1},
    {"MAV_TYPE", 10},    {"NAV_ACC_RAD", 2},     {"PWM_MAIN_FUNC1", 201}, {"PWM_MAIN_FUNC2", 101},
    {"RO_SPEED_LIM", 5}, {"RTL_LAND_DELAY", -1}, {"SIH_VEHICLE_TYPE", 5}, {"SYS_AUTOSTART", 10045}};

}  // namespace

ParamSource px4_source(Kind kind) noexcept {
    switch (kind) {
        case Kind::plane: return {px4_plane_groups, px4_plane_presets};
        case Kind::rover: return {px4_rover_groups, px4_rover_presets};
        default: return {px4_copter_groups, px4_copter_presets};
    }
}

}  // namespace mavloom::flight
