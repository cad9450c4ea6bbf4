// SPDX-License-Identifier: MIT
// What the parameters of each firmware mean for the vehicle's behaviour, in SI units.
#include <algorithm>
#include <cmath>

#include "flight/firmware/tables.hpp"
#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

// Clients may store any value, NaN and infinity included. The vehicle then flies by the nearest one that makes sense.
class Reader {
public:
    explicit Reader(const Parameters& parameters) noexcept : parameters_(parameters) {}

    // In [low, high]; `fallback` if the firmware has no such parameter, or it is not a number.
    [[nodiscard]] double number(std::string_view name, double fallback, double low, double high) const noexcept {
        const double value = parameters_.get(name, fallback);
        return std::isnan(value) ? fallback : std::clamp(value, low, high);
    }
    [[nodiscard]] double centi(std::string_view name, double fallback, double low, double high) const noexcept {
        return number(name, 100 * fallback, 100 * low, 100 * high) / 100;
    }
    [[nodiscard]] int choice(std::string_view name, int fallback) const noexcept {
        return static_cast<int>(number(name, fallback, -1e6, 1e6));
    }

private:
    const Parameters& parameters_;
};

constexpr double top_speed = 60, no_limit = 1e6;  // m/s; s or m

FailsafeAction px4_gcs_loss(int value) noexcept {
    using enum FailsafeAction;
    switch (value) {
        case 1: return hold;
        case 2: return return_home;
        case 3: return land;
        case 5: return terminate;
        case 6: return disarm;
        default: return none;
    }
}

// The vehicle holds first. 2 (Return) is the default; without a remote control, PX4 stays in Hold.
FailsafeAction px4_manual_loss(int value) noexcept {
    using enum FailsafeAction;
    switch (value) {
        case 3: return land;
        case 5: return terminate;
        case 6: return disarm;
        default: return hold;
    }
}

// The modes 0 to 2 need a remote control. Without one, PX4 returns.
FailsafeAction px4_offboard_loss(int value) noexcept {
    using enum FailsafeAction;
    switch (value) {
        case 4: return land;
        case 5: return hold;
        case 6: return terminate;
        case 7: return disarm;
        default: return return_home;
    }
}

FailsafeAction px4_fence(int value) noexcept {
    using enum FailsafeAction;
    switch (value) {
        case 0: return none;
        case 1: return warn;
        case 3: return return_home;
        case 4: return terminate;
        case 5: return land;
        default: return hold;
    }
}

void read_px4_battery(const Reader& read, Tuning& t) {
    using enum FailsafeAction;
    t.battery_low = read.number("BAT_LOW_THR", t.battery_low, 0, 1);
    t.battery_critical = read.number("BAT_CRIT_THR", t.battery_critical, 0, 1);
    t.battery_emergency = read.number("BAT_EMERGEN_THR", t.battery_emergency, 0, 1);
    const int action = read.choice("COM_LOW_BAT_ACT", 3);
    t.on_battery_critical = action == 2 ? land : action == 3 || action == 4 ? return_home : warn;
    t.on_battery_emergency = action == 2 || action == 3 ? land : action == 4 ? terminate : warn;
}

void read_px4_safety(const Reader& read, Tuning& t) {
    t.disarm_after_landing = read.number("COM_DISARM_LAND", t.disarm_after_landing, -1, no_limit);
    t.disarm_without_takeoff = read.number("COM_DISARM_PRFLT", t.disarm_without_takeoff, -1, no_limit);
    t.spool_up = read.number("COM_SPOOLUP_TIME", t.spool_up, 0, 30);
    t.gcs_loss = read.number("COM_DL_LOSS_T", t.gcs_loss, 1, no_limit);
    t.on_gcs_loss = px4_gcs_loss(read.choice("NAV_DLL_ACT", 0));
    t.offboard_loss = read.number("COM_OF_LOSS_T", t.offboard_loss, 0, 60);
    t.on_offboard_loss = px4_offboard_loss(read.choice("COM_OBL_RC_ACT", 0));
    t.manual_loss = read.number("COM_RC_LOSS_T", t.manual_loss, 0.1, 35);
    t.on_manual_loss = px4_manual_loss(read.choice("NAV_RCL_ACT", 2));
    t.fence_radius = read.number("GF_MAX_HOR_DIST", 0, 0, no_limit);
    t.fence_height = read.number("GF_MAX_VER_DIST", 0, 0, no_limit);
    t.on_fence = px4_fence(read.choice("GF_ACTION", 2));
    t.may_inject_failures = read.choice("SYS_FAILURE_EN", 0) == 1;
    t.needs_position_to_arm = read.choice("COM_ARM_WO_GPS", 1) != 2;
}

void read_px4_navigation(const Reader& read, Tuning& t) {
    t.takeoff_altitude = read.number("MIS_TAKEOFF_ALT", t.takeoff_altitude, 0.5, no_limit);
    t.acceptance_radius = read.number("NAV_ACC_RAD", t.acceptance_radius, 0.05, no_limit);
    t.loiter_radius = read.number("NAV_LOITER_RAD", t.loiter_radius, -10000, 10000);
    t.return_altitude = read.number("RTL_RETURN_ALT", t.return_altitude, 0, no_limit);
    t.return_descend_altitude = read.number("RTL_DESCEND_ALT", t.return_descend_altitude, 0, no_limit);
    t.return_land_delay = read.number("RTL_LAND_DELAY", 0, -1, no_limit);
    t.return_min_distance = read.number("RTL_MIN_DIST", t.return_min_distance, 0.5, no_limit);
    t.return_cone = to_radians(read.number("RTL_CONE_ANG", 45, 0, 90));
    t.follow_distance = read.number("FLW_TGT_DST", t.follow_distance, 1, 1000);
    t.follow_height = read.number("FLW_TGT_HT", t.follow_height, 1, 1000);
    t.follow_angle = to_radians(read.number("FLW_TGT_FA", 180, -180, 180));
}

void read_px4_copter(const Reader& read, Tuning& t) {
    t.max_speed = read.number("MPC_XY_VEL_MAX", t.max_speed, 0.1, top_speed);
    t.cruise_speed = std::min(read.number("MPC_XY_CRUISE", t.cruise_speed, 0.1, top_speed), t.max_speed);
    t.climb_speed = std::min(read.number("MPC_Z_V_AUTO_UP", t.climb_speed, 0.1, top_speed),
                             read.number("MPC_Z_VEL_MAX_UP", t.climb_speed, 0.1, top_speed));
    t.descent_speed = std::min(read.number("MPC_Z_V_AUTO_DN", t.descent_speed, 0.1, top_speed),
                               read.number("MPC_Z_VEL_MAX_DN", t.descent_speed, 0.1, top_speed));
    t.takeoff_speed = read.number("MPC_TKO_SPEED", t.takeoff_speed, 0.1, top_speed);
    t.land_speed = read.number("MPC_LAND_SPEED", t.land_speed, 0.1, top_speed);
    t.land_ramp_height = read.number("MPC_LAND_ALT1", t.land_ramp_height, 0, 122);
    t.land_slow_height = std::min(read.number("MPC_LAND_ALT2", t.land_slow_height, 0, 122), t.land_ramp_height);
    t.acceleration = read.number("MPC_ACC_HOR", t.acceleration, 0.5, 15);
    t.max_tilt = to_radians(read.number("MPC_TILTMAX_AIR", 45, 5, 85));
    t.max_yaw_rate = to_radians(read.number("MPC_YAWRAUTO_MAX", 60, 5, 360));
    t.altitude_acceptance = read.number("NAV_MC_ALT_RAD", t.altitude_acceptance, 0.05, 200);
}

void read_px4_plane(const Reader& read, Tuning& t) {
    t.min_airspeed = read.number("FW_AIRSPD_MIN", 10, 5, top_speed);
    t.max_speed = read.number("FW_AIRSPD_MAX", 20, 5, top_speed);
    t.cruise_speed = std::min(read.number("FW_AIRSPD_TRIM", 15, 5, top_speed), t.max_speed);
    t.climb_speed = read.number("FW_T_CLMB_R_SP", 3, 0.5, top_speed);
    t.descent_speed = read.number("FW_T_SINK_R_SP", 2, 0.5, top_speed);
    t.takeoff_speed = read.number("FW_T_CLMB_MAX", 5, 0.5, top_speed);
    t.max_tilt = to_radians(read.number("FW_R_LIM", 50, 10, 80));
    t.altitude_acceptance = read.number("NAV_FW_ALT_RAD", 10, 0.05, 200);
}

void read_px4_rover(const Reader& read, Tuning& t) {
    const double full = read.number("RO_MAX_THR_SPEED", 6, 0.1, top_speed);
    const double limit = read.number("RO_SPEED_LIM", 5, -1, top_speed);
    t.max_speed = limit > 0 ? std::min(limit, full) : full;
    t.cruise_speed = t.max_speed;
    t.acceleration = std::max(0.1, read.number("RO_ACCEL_LIM", 3, -1, 100));
    t.max_yaw_rate = to_radians(read.number("RO_YAW_RATE_LIM", 100, 5, 720));
    t.rover_turn_radius = read.number("RA_WHEEL_BASE", 0.5, 0.05, 100) /
                          math::tan(read.number("RA_MAX_STR_ANG", 0.5236, 0.05, 1.5));
}

// ArduPilot has two levels, with an action each. Without thresholds in mAh the vehicle only warns, at the first.
FailsafeAction ardupilot_battery_action(int value) noexcept {
    using enum FailsafeAction;
    switch (value) {
        case 1: return land;
        case 2:
        case 3: return return_home;
        case 4: return land;
        case 5: return terminate;
        default: return warn;
    }
}

void read_ardupilot_battery(const Reader& read, Tuning& t) {
    const double capacity = read.number("BATT_CAPACITY", 3300, 1, 1e6);
    const double low = read.number("BATT_LOW_MAH", 0, 0, capacity) / capacity;
    const double critical = read.number("BATT_CRT_MAH", 0, 0, capacity) / capacity;
    if (low > 0) t.battery_low = low;
    t.battery_critical = t.battery_low;
    t.battery_emergency = critical;
    t.on_battery_critical = ardupilot_battery_action(low > 0 ? read.choice("BATT_FS_LOW_ACT", 0) : 0);
    t.on_battery_emergency = ardupilot_battery_action(critical > 0 ? read.choice("BATT_FS_CRT_ACT", 0) : 0);
}

FailsafeAction ardupilot_gcs_loss(Kind kind, int enabled, int action) noexcept {
    using enum FailsafeAction;
    if (enabled == 0) return none;
    if (kind == Kind::quad) return enabled == 5 ? land : return_home;
    if (kind == Kind::plane) return action == 0 ? warn : return_home;
    return action == 0 ? warn : action == 2 ? hold : return_home;
}

// The bits of FENCE_TYPE: 1 greatest altitude, 2 circle around home, 4 polygons.
void read_ardupilot_fence(const Reader& read, Kind kind, Tuning& t) {
    using enum FailsafeAction;
    const int type = read.choice("FENCE_ENABLE", 0) == 1 ? read.choice("FENCE_TYPE", 7) : 0;
    if ((type & 1) != 0 && kind != Kind::rover) t.fence_height = read.number("FENCE_ALT_MAX", 100, 0, no_limit);
    if ((type & 2) != 0) t.fence_radius = read.number("FENCE_RADIUS", 300, 0, no_limit);
    switch (read.choice("FENCE_ACTION", 1)) {
        case 0: t.on_fence = warn; break;
        case 2: t.on_fence = kind == Kind::quad ? land : hold; break;
        case 4: t.on_fence = hold; break;
        default: t.on_fence = return_home; break;
    }
}

// In Guided, ArduPilot does not leave the mode when set-points end: the vehicle stops.
void read_ardupilot_safety(const Reader& read, Kind kind, Tuning& t) {
    using enum FailsafeAction;
    t.gcs_loss = kind == Kind::plane ? read.number("FS_LONG_TIMEOUT", 5, 1, no_limit)
                                     : read.number("FS_GCS_TIMEOUT", 5, 1, no_limit);
    const int enabled = kind == Kind::plane ? read.choice("FS_GCS_ENABL", 0) : read.choice("FS_GCS_ENABLE", 0);
    const int action = kind == Kind::plane ? read.choice("FS_LONG_ACTN", 0) : read.choice("FS_ACTION", 2);
    t.on_gcs_loss = ardupilot_gcs_loss(kind, enabled, action);
    t.offboard_loss = read.number("GUID_TIMEOUT", 3, 0.1, 60);
    t.on_offboard_loss = none;
    t.manual_loss = read.number("RC_OVERRIDE_TIME", 3, 0.1, 120);
    t.on_manual_loss = read.choice("FS_THR_ENABLE", 0) == 0 ? none : return_home;
    t.needs_position_to_arm = read.choice("ARMING_CHECK", 1) != 0;
}

// RTL_ALT_FINAL 0 lands; another height is where the vehicle stays.
void read_ardupilot_return(const Reader& read, Tuning& t) {
    t.return_altitude = read.centi("RTL_ALT", 15, 0, 10000);
    t.return_min_distance = t.return_altitude / std::max(0.5, read.number("RTL_CONE_SLOPE", 3, 0, 10));
    t.return_cone = math::atan(1 / std::max(0.5, read.number("RTL_CONE_SLOPE", 3, 0, 10)));
    const double last_height = read.centi("RTL_ALT_FINAL", 0, 0, 10000);
    t.return_descend_altitude = last_height > 0 ? last_height : t.land_slow_height;
    t.return_land_delay = last_height > 0 ? -1 : read.number("RTL_LOIT_TIME", 5000, 0, 60000) / 1000;
}

void read_ardupilot_copter(const Reader& read, Tuning& t) {
    t.cruise_speed = read.centi("WPNAV_SPEED", 10, 0.2, 20);
    t.max_speed = std::max(t.cruise_speed, read.centi("LOIT_SPEED", 12.5, 0.2, 35));
    t.climb_speed = t.takeoff_speed = read.centi("WPNAV_SPEED_UP", 2.5, 0.1, 10);
    t.descent_speed = read.centi("WPNAV_SPEED_DN", 1.5, 0.1, 5);
    t.land_speed = read.centi("LAND_SPEED", 0.5, 0.3, 2);
    t.land_slow_height = read.centi("LAND_ALT_LOW", 10, 1, 100);
    t.land_ramp_height = t.land_slow_height + 2;
    t.acceleration = read.centi("WPNAV_ACCEL", 2.5, 0.5, 5);
    t.max_tilt = to_radians(read.centi("ANGLE_MAX", 30, 10, 80));
    t.max_yaw_rate = to_radians(read.centi("ATC_SLEW_YAW", 60, 5, 180));
    t.takeoff_altitude = std::max(2.5, read.centi("PILOT_TKOFF_ALT", 0, 0, 10));
    t.acceptance_radius = t.altitude_acceptance = read.centi("WPNAV_RADIUS", 2, 0.05, 10);
    t.loiter_radius = read.centi("CIRCLE_RADIUS", 10, 0, 2000);
    t.disarm_after_landing = 1;
    const double delay = read.number("DISARM_DELAY", 10, 0, 127);
    t.disarm_without_takeoff = delay > 0 ? delay : -1;
    t.spool_up = read.number("MOT_SPOOL_TIME", 0.5, 0, 2);
    read_ardupilot_return(read, t);
}

void read_ardupilot_plane(const Reader& read, Tuning& t) {
    t.min_airspeed = read.number("AIRSPEED_MIN", 9, 5, top_speed);
    t.max_speed = read.number("AIRSPEED_MAX", 22, 5, top_speed);
    t.cruise_speed = std::min(read.number("AIRSPEED_CRUISE", 15, 5, top_speed), t.max_speed);
    t.climb_speed = t.takeoff_speed = read.number("TECS_CLMB_MAX", 5, 0.5, top_speed);
    t.descent_speed = read.number("TECS_SINK_MIN", 2, 0.5, top_speed);
    t.max_tilt = to_radians(read.number("ROLL_LIMIT_DEG", 45, 10, 80));
    t.takeoff_altitude = read.number("TKOFF_ALT", 50, 1, no_limit);
    t.acceptance_radius = read.number("WP_RADIUS", 90, 1, 32767);
    t.altitude_acceptance = 10;
    t.loiter_radius = read.number("WP_LOITER_RAD", 60, -32767, 32767);
    t.return_altitude = t.return_descend_altitude = read.number("RTL_ALTITUDE", 100, 0, no_limit);
    t.return_land_delay = -1;
    t.disarm_after_landing = read.number("LAND_DISARMDELAY", 20, 0, 127);
    t.disarm_without_takeoff = -1;
    t.spool_up = 0;
}

void read_ardupilot_rover(const Reader& read, Tuning& t) {
    t.cruise_speed = read.number("WP_SPEED", 2, 0.1, top_speed);
    t.max_speed = std::max(t.cruise_speed, read.number("CRUISE_SPEED", 2, 0.1, top_speed));
    t.acceleration = std::max(0.1, read.number("ATC_ACCEL_MAX", 1, 0, 10));
    t.max_yaw_rate = to_radians(read.number("ATC_STR_RAT_MAX", 120, 5, 1000));
    t.rover_turn_radius = read.number("TURN_RADIUS", 0.9, 0.1, 10);
    t.acceptance_radius = read.number("WP_RADIUS", 2, 0.1, 100);
    t.loiter_radius = read.number("CIRC_RADIUS", 20, 0, 1000);
    t.return_land_delay = t.disarm_after_landing = t.disarm_without_takeoff = -1;
    t.spool_up = 0;
}

}  // namespace

Tuning px4_tuning(Kind kind, const Parameters& parameters) {
    const Reader read(parameters);
    Tuning t;
    read_px4_battery(read, t);
    read_px4_safety(read, t);
    read_px4_navigation(read, t);
    if (kind == Kind::quad) read_px4_copter(read, t);
    if (kind == Kind::plane) read_px4_plane(read, t);
    if (kind == Kind::rover) read_px4_rover(read, t);
    return t;
}

Tuning ardupilot_tuning(Kind kind, const Parameters& parameters) {
    const Reader read(parameters);
    Tuning t;
    read_ardupilot_battery(read, t);
    read_ardupilot_safety(read, kind, t);
    read_ardupilot_fence(read, kind, t);
    if (kind == Kind::quad) read_ardupilot_copter(read, t);
    if (kind == Kind::plane) read_ardupilot_plane(read, t);
    if (kind == Kind::rover) read_ardupilot_rover(read, t);
    return t;
}

}  // namespace mavloom::flight
