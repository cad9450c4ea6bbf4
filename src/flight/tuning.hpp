// SPDX-License-Identifier: MIT
// The numbers that drive the vehicle's behaviour, in SI units, read from the parameters of its firmware. Private to
// flight; plain values. The firmware computes them again after each change of a parameter, so changes take effect at
// once.
#pragma once

#include <cstdint>

#include "flight/physics/rotation.hpp"

namespace mavloom::flight {

// The action of a fail-safe.
enum class FailsafeAction : std::uint8_t { none, warn, hold, return_home, land, terminate, disarm };

struct Tuning {
    double cruise_speed = 5, max_speed = 12;                   // m/s, horizontal
    double min_airspeed = 10;                                  // m/s; planes
    double climb_speed = 3, descent_speed = 1.5;               // m/s
    double takeoff_speed = 1.5, land_speed = 0.7;              // m/s
    double land_slow_height = 5, land_ramp_height = 10;        // m; slowing from the second, to land_speed at the first
    double acceleration = 3;                                   // m/s^2
    double max_tilt = to_radians(45);                          // rad
    double max_yaw_rate = to_radians(60);                      // rad/s
    double takeoff_altitude = 2.5;                             // m above home
    double acceptance_radius = 10, altitude_acceptance = 0.8;  // m
    double loiter_radius = 80;                                 // m; planes
    double return_altitude = 30, return_descend_altitude = 10;  // m above home
    double return_land_delay = 0;                               // s; negative: stay there
    double return_min_distance = 10, return_cone = to_radians(45);
    double disarm_after_landing = 2, disarm_without_takeoff = 10;  // s; not positive: never
    double spool_up = 1;                                           // s from arming to climb
    double battery_low = 0.15, battery_critical = 0.07, battery_emergency = 0.05;
    FailsafeAction on_battery_critical = FailsafeAction::return_home, on_battery_emergency = FailsafeAction::land;
    double gcs_loss = 10;  // s without a ground station's heartbeat
    FailsafeAction on_gcs_loss = FailsafeAction::none;
    double offboard_loss = 1;  // s without a set-point
    FailsafeAction on_offboard_loss = FailsafeAction::hold;
    double manual_loss = 0.5;  // s without MANUAL_CONTROL
    FailsafeAction on_manual_loss = FailsafeAction::hold;
    double fence_radius = 0, fence_height = 0;  // m around home; 0: none
    FailsafeAction on_fence = FailsafeAction::hold;
    double follow_distance = 8, follow_height = 8;  // m; from the target, and above home
    double follow_angle = to_radians(180);          // rad; from the target's course to the vehicle
    bool may_inject_failures = true;
    bool needs_position_to_arm = true;
    double rover_turn_radius = 1.5;  // m
};

}  // namespace mavloom::flight
