// SPDX-License-Identifier: MIT
// Aerodynamics of a small plane: lift, drag, side force, thrust and moments. Private to flight; pure functions.
//
// The numbers describe a model plane of 1.5 kg with 0.4 m^2 of wing: it stalls at 7 m/s and cruises at 15. Lift is
// linear up to the stall; beyond it, the wing lifts like a flat plate, and its moment lowers the nose. Rolling does not
// yaw the plane, and slipping does not roll it. Source of the formulas: Beard and McLain, "Small Unmanned Aircraft"
// (2012), chapter 4.
#pragma once

#include "flight/physics/rotation.hpp"

namespace mavloom::flight::wing {

inline constexpr double mass = 1.5;              // kg
inline constexpr double area = 0.4;              // m^2
inline const Vector3 inertia{0.09, 0.07, 0.15};  // kg m^2
inline constexpr double lift_zero = 0.15;        // lift coefficient at no angle of attack
inline constexpr double lift_slope = 4.5;        // per rad
inline constexpr double stall_angle = to_radians(13);
inline constexpr double cruise_speed = 15;  // m/s, airspeed

// The flow of air past the plane.
struct Airflow {
    Vector3 body = Vector3::Zero();  // velocity relative to the air, body frame
    double speed = 0;                // m/s
    double attack = 0, slip = 0;     // rad; slip positive: the air comes from the right
    double pressure = 0;             // Pa, dynamic
    double head_pressure = 0;        // Pa, of the flow from ahead, which the tail and the ailerons work in
};
[[nodiscard]] Airflow airflow(const Vector3& body_velocity, double density);

[[nodiscard]] double lift_coefficient(double attack);
[[nodiscard]] double drag_coefficient(double attack);
// The force in newtons, body frame, without gravity. `motor` is the motor's speed, 0 to 1.
[[nodiscard]] Vector3 force(const Airflow& air, double motor);
// The moment in newton metres about the body's axes while ailerons, elevator and rudder are centred.
[[nodiscard]] Vector3 natural_moment(const Airflow& air, const Vector3& rates);
// The further moment by full deflections to the right, up and to the right.
[[nodiscard]] Vector3 control_moment(const Airflow& air);
// The thrust in newtons at full motor speed.
[[nodiscard]] double full_thrust(double airspeed) noexcept;

}  // namespace mavloom::flight::wing
