// SPDX-License-Identifier: MIT
#include "flight/plant/wing.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight::wing {

namespace {

constexpr double pitch_of_stall = -0.6;  // moment coefficient, per rad beyond the stall
constexpr double stall_width_deg = 7;    // from the stall to a wing that acts as a flat plate

double fully_stalled(const PlaneBody& body) noexcept { return to_radians(body.stall_deg + stall_width_deg); }

// 0 while the flow is attached, 1 when the wing acts as a flat plate.
double stalled_share(const PlaneBody& body, double attack) noexcept {
    const double stall_angle = to_radians(body.stall_deg);
    const double x = std::clamp((std::abs(attack) - stall_angle) / (fully_stalled(body) - stall_angle), 0.0, 1.0);
    return x * x * (3 - 2 * x);
}

}  // namespace

double cruise_speed(const PlaneBody& body) noexcept {
    constexpr double standard = 15;  // m/s
    return standard * (stall_speed(body) / stall_speed(PlaneBody{}));
}

Airflow airflow(const Vector3& body_velocity, double density) {
    const double speed = body_velocity.norm(), ahead = std::max(body_velocity.x(), 0.0);
    return {.body = body_velocity,
            .speed = speed,
            .attack = math::atan2(body_velocity.z(), body_velocity.x()),
            .slip = speed < 0.1 ? 0 : math::asin(std::clamp(body_velocity.y() / speed, -1.0, 1.0)),
            .pressure = 0.5 * density * speed * speed,
            .head_pressure = 0.5 * density * ahead * ahead};
}

double lift_coefficient(const PlaneBody& body, double attack) {
    const double stalled = stalled_share(body, attack);
    const double sine = math::sin(attack), cosine = math::cos(attack);
    const double plate = 2 * std::copysign(sine * sine, attack) * cosine;
    return (1 - stalled) * (body.lift_zero + body.lift_slope * attack) + stalled * plate;
}

double drag_coefficient(const PlaneBody& body, double attack) {
    const double stalled = stalled_share(body, attack), most = fully_stalled(body);
    const double lift = body.lift_zero + body.lift_slope * std::clamp(attack, -most, most);
    const double sine = math::sin(attack);
    return body.drag_zero + body.induced * lift * lift + stalled * 2 * sine * sine;
}

Vector3 force(const PlaneBody& body, const Airflow& air, double motor) {
    Vector3 sum{motor * motor * full_thrust(body, air.speed), 0, 0};
    if (air.speed < 0.1) return sum;
    const double scale = air.pressure * body.area_m2;
    const Vector3 up{math::sin(air.attack), 0, -math::cos(air.attack)};
    sum += scale * lift_coefficient(body, air.attack) * up;
    sum -= scale * drag_coefficient(body, air.attack) / air.speed * air.body;
    sum.y() -= scale * body.side_slope * air.body.y() / air.speed;
    return sum;
}

Vector3 natural_moment(const PlaneBody& body, const Airflow& air, const Vector3& rates) {
    const double turn_scale = 0.5 / std::max(air.speed, 1.0);
    const double stall_angle = to_radians(body.stall_deg);
    const double beyond = air.attack - std::clamp(air.attack, -stall_angle, stall_angle);
    const double roll = -body.roll_damping * body.span_m * turn_scale * rates.x();
    const double pitch = -body.pitch_stiffness * (air.attack - to_radians(body.trim_deg)) + pitch_of_stall * beyond -
                         body.pitch_damping * body.chord_m * turn_scale * rates.y();
    const double yaw = body.yaw_stiffness * air.slip - body.yaw_damping * body.span_m * turn_scale * rates.z();
    return air.head_pressure * body.area_m2 * Vector3(body.span_m * roll, body.chord_m * pitch, body.span_m * yaw);
}

Vector3 control_moment(const PlaneBody& body, const Airflow& air) {
    const Vector3 arms(body.span_m * body.full_ailerons, body.chord_m * body.full_elevator,
                       body.span_m * body.full_rudder);
    return air.head_pressure * body.area_m2 * arms;
}

double full_thrust(const PlaneBody& body, double airspeed) noexcept {
    return body.thrust_n * std::clamp(1 - airspeed / body.pitch_speed_m_s, 0.0, 1.0);
}

}  // namespace mavloom::flight::wing
