// SPDX-License-Identifier: MIT
// Aerodynamics of a small plane: lift, drag, side force and thrust. Private to flight; pure functions.
//
// The numbers describe a model plane of 1.5 kg with 0.4 m^2 of wing: it stalls at 7 m/s and cruises at 15. Lift is
// linear up to the stall; beyond it, the wing lifts like a flat plate. Source of the formulas: Beard and McLain, "Small
// Unmanned Aircraft" (2012), chapter 4.
#pragma once

#include "flight/physics/rotation.hpp"

namespace mavloom::flight::wing {

inline constexpr double mass = 1.5;        // kg
inline constexpr double area = 0.4;        // m^2
inline constexpr double lift_zero = 0.15;  // lift coefficient at no angle of attack
inline constexpr double lift_slope = 4.5;  // per rad
inline constexpr double stall_angle = to_radians(13);
// The greatest angle of attack that the autopilot asks for.
inline constexpr double safe_angle = to_radians(10);
inline constexpr double cruise_speed = 15;  // m/s, airspeed

// The flow of air past the plane.
struct Airflow {
    Vector3 body = Vector3::Zero();  // velocity relative to the air, body frame
    double speed = 0;                // m/s
    double attack = 0, slip = 0;     // rad; slip positive: the air comes from the right
    double pressure = 0;             // Pa, dynamic
};
[[nodiscard]] Airflow airflow(const Vector3& body_velocity, double density);

[[nodiscard]] double lift_coefficient(double attack);
[[nodiscard]] double drag_coefficient(double attack);
// The force in newtons, body frame, without gravity. `motor` is the motor's speed, 0 to 1.
[[nodiscard]] Vector3 force(const Airflow& air, double motor);
// The thrust in newtons at full motor speed.
[[nodiscard]] double full_thrust(double airspeed) noexcept;

}  // namespace mavloom::flight::wing
