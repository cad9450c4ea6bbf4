// SPDX-License-Identifier: MIT
#include "flight/plant/wing.hpp"

#include <algorithm>
#include <cmath>

namespace mavloom::flight::wing {

namespace {

constexpr double drag_zero = 0.03;
constexpr double induced = 1 / (pi * 0.8 * 7);  // of an aspect ratio of 7
constexpr double side_slope = 0.6;              // per rad
constexpr double static_thrust = 12;            // N
constexpr double pitch_speed = 40;              // m/s, at which the propeller has no thrust left
constexpr double fully_stalled = to_radians(20);

constexpr double span = 1.67, chord = 0.24;  // m
// Coefficients of the moments: by the rates, the angles (per rad) and full deflections. The plane is in trim, with its
// elevator centred, at 2.5 degrees of attack: in level flight at cruise speed.
constexpr double roll_damping = -0.5, pitch_damping = -15, yaw_damping = -0.12;
constexpr double pitch_stiffness = -0.6, yaw_stiffness = 0.05;
constexpr double pitch_of_stall = -0.6;  // per rad beyond the stall
constexpr double trim_attack = to_radians(2.5);
constexpr double full_ailerons = 0.088, full_elevator = 0.3, full_rudder = 0.03;

// 0 while the flow is attached, 1 when the wing acts as a flat plate.
double stalled_share(double attack) noexcept {
    const double x = std::clamp((std::abs(attack) - stall_angle) / (fully_stalled - stall_angle), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

}  // namespace

Airflow airflow(const Vector3& body_velocity, double density) {
    const double speed = body_velocity.norm(), ahead = std::max(body_velocity.x(), 0.0);
    return {.body = body_velocity,
            .speed = speed,
            .attack = std::atan2(body_velocity.z(), body_velocity.x()),
            .slip = speed < 0.1 ? 0 : std::asin(std::clamp(body_velocity.y() / speed, -1.0, 1.0)),
            .pressure = 0.5 * density * speed * speed,
            .head_pressure = 0.5 * density * ahead * ahead};
}

double lift_coefficient(double attack) {
    const double stalled = stalled_share(attack);
    const double sine = std::sin(attack), cosine = std::cos(attack);
    const double plate = 2 * std::copysign(sine * sine, attack) * cosine;
    return (1 - stalled) * (lift_zero + lift_slope * attack) + stalled * plate;
}

double drag_coefficient(double attack) {
    const double stalled = stalled_share(attack);
    const double lift = lift_zero + lift_slope * std::clamp(attack, -fully_stalled, fully_stalled);
    const double sine = std::sin(attack);
    return drag_zero + induced * lift * lift + stalled * 2 * sine * sine;
}

Vector3 force(const Airflow& air, double motor) {
    Vector3 sum{motor * motor * full_thrust(air.speed), 0, 0};
    if (air.speed < 0.1) return sum;
    const double scale = air.pressure * area;
    const Vector3 up{std::sin(air.attack), 0, -std::cos(air.attack)};
    sum += scale * lift_coefficient(air.attack) * up;
    sum -= scale * drag_coefficient(air.attack) / air.speed * air.body;
    sum.y() -= scale * side_slope * air.body.y() / air.speed;
    return sum;
}

Vector3 natural_moment(const Airflow& air, const Vector3& rates) {
    const double turn_scale = 0.5 / std::max(air.speed, 1.0);
    const double beyond = air.attack - std::clamp(air.attack, -stall_angle, stall_angle);
    const double roll = roll_damping * span * turn_scale * rates.x();
    const double pitch = pitch_stiffness * (air.attack - trim_attack) + pitch_of_stall * beyond +
                         pitch_damping * chord * turn_scale * rates.y();
    const double yaw = yaw_stiffness * air.slip + yaw_damping * span * turn_scale * rates.z();
    return air.head_pressure * area * Vector3(span * roll, chord * pitch, span * yaw);
}

Vector3 control_moment(const Airflow& air) {
    return air.head_pressure * area * Vector3(span * full_ailerons, chord * full_elevator, span * full_rudder);
}

double full_thrust(double airspeed) noexcept {
    return static_thrust * std::clamp(1 - airspeed / pitch_speed, 0.0, 1.0);
}

}  // namespace mavloom::flight::wing
