// SPDX-License-Identifier: MIT
#include "flight/pilot/rover_pilot.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"
#include "flight/pilot/path.hpp"

namespace mavloom::flight {

namespace {

constexpr double speed_lag = 0.25;   // s
constexpr double heading_gain = 2;   // 1/s
constexpr double arrived = 0.3;      // m
constexpr double default_speed = 5;  // m/s

// As a share of what the motor can do at rest, so that the rover can also stop.
constexpr double careful = 2.0 / 3;

}  // namespace

SpeedLimits RoverPilot::bounded(const SpeedLimits& given) const noexcept {
    const double most = std::min(10.0, careful * body_.thrust_n / body_.mass_kg);
    SpeedLimits limits = given;
    const double fastest = body_.top_speed_m_s, tightest = body_.turn_radius_m;
    limits.horizontal = finite_or(given.horizontal, std::min(default_speed, fastest), 0.1, fastest);
    limits.acceleration = finite_or(given.acceleration, 3, std::min(0.2, most), most);
    limits.turn_radius = finite_or(given.turn_radius, std::max(1.5, tightest), tightest, 50);
    limits.yaw_rate = finite_or(given.yaw_rate, to_radians(60), 0.1, to_radians(180));
    return limits;
}

void RoverPilot::start(const Kinematics& motion) { targets_ = {.attitude = motion.attitude}; }

const Outputs& RoverPilot::step(const Setpoint& setpoint, bool armed, const Plant& plant, const Surroundings& around) {
    limits_ = bounded(setpoint.limits);
    motion_ = plant.motion();
    heading_ = yaw_of(motion_.attitude);
    speed_ = motion_.velocity.dot(motion_.attitude * Vector3::UnitX());
    const Demand demand = armed ? drive(setpoint) : Demand{};
    report(demand);
    return outputs_ = outputs_for(demand, around.supply);
}

RoverPilot::Demand RoverPilot::drive(const Setpoint& setpoint) const {
    const double thrust = finite_or(setpoint.thrust, 0, -1, 1) * limits_.horizontal;
    switch (setpoint.steering) {
        case Steering::none: return {};
        case Steering::waypoint: return drive_along(setpoint);
        case Steering::circle: return drive_around(setpoint);
        case Steering::trajectory: return drive_with(setpoint);
        case Steering::attitude: return turn_to(finite_or(yaw_of(setpoint.attitude), heading_, -pi, pi), 0, thrust);
        case Steering::rates: return turn(finite_or(setpoint.rates.z(), 0, -4, 4), thrust);
        case Steering::actuators: break;
    }
    return {.speed = finite_or(setpoint.mixer[3], 0, -1, 1) * limits_.horizontal,
            .curvature = finite_or(setpoint.mixer[2], 0, -1, 1) / limits_.turn_radius};
}

RoverPilot::Demand RoverPilot::drive_along(const Setpoint& setpoint) const {
    const Vector3 leg = setpoint.position - setpoint.from;
    if (!has_horizontal(setpoint.from) || horizontal_length(leg) < 0.5) return drive_to(setpoint.position);
    if (!has_horizontal(setpoint.position)) return {};
    const Vector3 rest = setpoint.position - motion_.position;
    const double remaining = (rest.x() * leg.x() + rest.y() * leg.y()) / horizontal_length(leg);
    if (remaining < arrived) return {};
    const double look_ahead = std::max(1.5, std::abs(speed_));
    const Course course = course_on_line(motion_, setpoint.from, setpoint.position, look_ahead);
    return turn_to(course.angle, course.turn_rate, std::min(limits_.horizontal, stopping_speed(remaining - arrived)));
}

// A car cannot reach every place near it: what lies beside it, within its turning circle, counts as reached. To a place
// close behind, it reverses.
RoverPilot::Demand RoverPilot::drive_to(const Vector3& place) const {
    if (!has_horizontal(place)) return {};
    const Vector3 rest = place - motion_.position;
    const double distance = horizontal_length(rest), bearing = direction_of(rest, heading_);
    const double off = std::abs(wrap_pi(bearing - heading_));
    const bool is_beside = off > 0.6 && off < pi - 0.6 && distance < 2 * limits_.turn_radius;
    if (distance < arrived || (is_beside && distance < limits_.turn_radius)) return {};
    const double speed = std::min(limits_.horizontal, stopping_speed(distance - arrived));
    const bool reverses = off > pi / 2 && distance < 4 * limits_.turn_radius;
    return reverses ? turn_to(bearing + pi, 0, -std::min(speed, 1.5)) : turn_to(bearing, 0, speed);
}

RoverPilot::Demand RoverPilot::drive_with(const Setpoint& setpoint) const {
    if (!has_horizontal(setpoint.velocity)) {
        if (has_horizontal(setpoint.position)) return drive_to(setpoint.position);
        return {};
    }
    const Vector3& velocity = setpoint.velocity;
    const auto along = [&](double course) {
        return velocity.x() * math::cos(course) + velocity.y() * math::sin(course);
    };
    if (std::isfinite(setpoint.yaw_rate)) return turn(finite_or(setpoint.yaw_rate, 0, -4, 4), along(heading_));
    if (std::isfinite(setpoint.yaw)) return turn_to(setpoint.yaw, 0, along(setpoint.yaw));
    const double speed = horizontal_length(velocity);
    return speed < 0.05 ? Demand{} : turn_to(direction_of(velocity, heading_), 0, speed);
}

RoverPilot::Demand RoverPilot::drive_around(const Setpoint& setpoint) const {
    if (!has_horizontal(setpoint.position)) return {};
    const double asked = finite_or(setpoint.radius, 0, -1e4, 1e4);
    const double radius = std::copysign(std::max(std::abs(asked), limits_.turn_radius), asked);
    const Course course = course_on_circle(motion_, setpoint.position, radius, std::max(1.5, std::abs(speed_)));
    return turn_to(course.angle, course.turn_rate,
                   std::min(limits_.horizontal, std::sqrt(body_.grip_m_s2 * std::abs(radius))));
}

RoverPilot::Demand RoverPilot::turn(double turn_rate, double speed) const {
    const double bounded_rate = std::clamp(turn_rate, -limits_.yaw_rate, limits_.yaw_rate);
    const double wanted = std::clamp(speed, -limits_.horizontal, limits_.horizontal);
    return {.speed = wanted,
            .curvature = std::copysign(bounded_rate / std::max(std::abs(speed_), 0.5), wanted * bounded_rate)};
}

// The farther the heading is off, the slower, so that the turn is tight.
RoverPilot::Demand RoverPilot::turn_to(double course, double turn_rate, double speed) const {
    const double off = wrap_pi(course - heading_);
    const double slow = std::sqrt(body_.grip_m_s2 * limits_.turn_radius) / 2;
    const double most = std::max(std::abs(speed) * math::cos(off), slow);
    Demand demand = turn(turn_rate + heading_gain * off, std::clamp(speed, -most, most));
    demand.course = course;
    return demand;
}

double RoverPilot::stopping_speed(double distance) const noexcept {
    return std::sqrt(1.4 * limits_.acceleration * std::max(distance, 0.0));
}

// The drive that holds the speed against the motor's own resistance, and what the wanted acceleration needs. A weaker
// battery needs more of it.
Outputs RoverPilot::outputs_for(const Demand& demand, double supply) const {
    const double wanted = (demand.speed - speed_) / speed_lag;
    const double acceleration = std::clamp(wanted, -limits_.acceleration, limits_.acceleration);
    const double drive = speed_ / body_.top_speed_m_s + acceleration / (body_.thrust_n / body_.mass_kg);
    const double curvature = std::clamp(demand.curvature, -1 / limits_.turn_radius, 1 / limits_.turn_radius);
    return {servo_output(drive / std::clamp(supply, 0.5, 1.0)), servo_output(curvature * body_.turn_radius_m)};
}

void RoverPilot::report(const Demand& demand) {
    const double course = finite_or(demand.course, heading_, -1e3, 1e3);
    targets_ = {.attitude = to_quaternion({0, 0, course}),
                .rates = {0, 0, demand.speed * demand.curvature},
                .thrust = std::clamp(demand.speed / limits_.horizontal, -1.0, 1.0),
                .velocity = {demand.speed * math::cos(course), demand.speed * math::sin(course), 0}};
}

}  // namespace mavloom::flight
