// SPDX-License-Identifier: MIT
#include "flight/physics/wing/model.hpp"

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

// 0 while the flow is attached, 1 when the wing acts as a flat plate.
double stalled_share(double attack) noexcept {
    const double x = std::clamp((std::abs(attack) - stall_angle) / (fully_stalled - stall_angle), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

}  // namespace

Airflow airflow(const Vector3& body_velocity, double density) {
    const double speed = body_velocity.norm();
    return {.body = body_velocity,
            .speed = speed,
            .attack = std::atan2(body_velocity.z(), body_velocity.x()),
            .slip = speed < 0.1 ? 0 : std::asin(std::clamp(body_velocity.y() / speed, -1.0, 1.0)),
            .pressure = 0.5 * density * speed * speed};
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

double full_thrust(double airspeed) noexcept {
    return static_thrust * std::clamp(1 - airspeed / pitch_speed, 0.0, 1.0);
}

}  // namespace mavloom::flight::wing
