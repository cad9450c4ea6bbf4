// SPDX-License-Identifier: MIT
// Aerodynamics of a small plane: lift, drag, side force, thrust and moments. Private to flight; pure functions.
//
// Lift is linear up to the stall; beyond it, the wing lifts like a flat plate, and its moment lowers the nose. Rolling
// does not yaw the plane, and slipping does not roll it. Source of the formulas: Beard and McLain, "Small Unmanned
// Aircraft" (2012), chapter 4.
#pragma once

#include "flight/physics/rotation.hpp"
#include "mavloom/flight/body.hpp"

namespace mavloom::flight::wing {

[[nodiscard]] inline Vector3 inertia_of(const PlaneBody& body) {
    return {body.inertia_kg_m2[0], body.inertia_kg_m2[1], body.inertia_kg_m2[2]};
}
// A comfortable airspeed of level flight at sea level, m/s.
[[nodiscard]] double cruise_speed(const PlaneBody& body) noexcept;

// The flow of air past the plane.
struct Airflow {
    Vector3 body = Vector3::Zero();  // velocity relative to the air, body frame
    double speed = 0;                // m/s
    double attack = 0, slip = 0;     // rad; slip positive: the air comes from the right
    double pressure = 0;             // Pa, dynamic
    double head_pressure = 0;        // Pa, of the flow from ahead, which the tail and the ailerons work in
};
[[nodiscard]] Airflow airflow(const Vector3& body_velocity, double density);

[[nodiscard]] double lift_coefficient(const PlaneBody& body, double attack);
[[nodiscard]] double drag_coefficient(const PlaneBody& body, double attack);
// The force in newtons, body frame, without gravity. `motor` is the motor's speed, 0 to 1.
[[nodiscard]] Vector3 force(const PlaneBody& body, const Airflow& air, double motor);
// The moment in newton metres about the body's axes while ailerons, elevator and rudder are centred.
[[nodiscard]] Vector3 natural_moment(const PlaneBody& body, const Airflow& air, const Vector3& rates);
// The further moment by full deflections to the right, up and to the right.
[[nodiscard]] Vector3 control_moment(const PlaneBody& body, const Airflow& air);
// The thrust in newtons at full motor speed.
[[nodiscard]] double full_thrust(const PlaneBody& body, double airspeed) noexcept;

}  // namespace mavloom::flight::wing
