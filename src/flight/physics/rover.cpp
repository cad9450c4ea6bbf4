// SPDX-License-Identifier: MIT
#include "flight/physics/rover.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/path.hpp"

namespace mavloom::flight {

namespace {

constexpr double speed_lag = 0.25, steering_lag = 0.15;  // s
constexpr double heading_gain = 2;                       // 1/s
constexpr double tyre_grip = 4;                          // m/s^2 that the tyres hold
constexpr double arrived = 0.3;                          // m
constexpr double cruise_speed = 5;                       // m/s, at which the load is 1

SpeedLimits bounded(const SpeedLimits& given) noexcept {
    SpeedLimits limits = given;
    limits.horizontal = finite_or(given.horizontal, cruise_speed, 0.1, 20);
    limits.acceleration = finite_or(given.acceleration, 3, 0.2, 10);
    limits.turn_radius = finite_or(given.turn_radius, 1.5, 0.3, 50);
    limits.yaw_rate = finite_or(given.yaw_rate, to_radians(60), 0.1, to_radians(180));
    return limits;
}

}  // namespace

void Rover::place(const Vector3& position, double heading) {
    motion_ = {};
    motion_.position = position;
    motion_.attitude = to_quaternion({0, 0, heading});
    heading_ = heading;
    speed_ = curvature_ = thrust_ = load_ = 0;
    touches_ground_ = true;
}

void Rover::step(const Setpoint& setpoint, bool armed, const Surroundings& around) {
    limits_ = bounded(setpoint.limits);
    heading_ = yaw_of(motion_.attitude);
    const Demand demand = armed ? drive(setpoint) : Demand{};
    move(demand, around.ground);
    report(demand);
    air_velocity_ = motion_.velocity - around.wind;
}

Rover::Demand Rover::drive(const Setpoint& setpoint) const {
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

Rover::Demand Rover::drive_along(const Setpoint& setpoint) const {
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
Rover::Demand Rover::drive_to(const Vector3& place) const {
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

Rover::Demand Rover::drive_with(const Setpoint& setpoint) const {
    if (!has_horizontal(setpoint.velocity)) {
        if (has_horizontal(setpoint.position)) return drive_to(setpoint.position);
        return {};
    }
    const Vector3& velocity = setpoint.velocity;
    const auto along = [&](double course) { return velocity.x() * std::cos(course) + velocity.y() * std::sin(course); };
    if (std::isfinite(setpoint.yaw_rate)) return turn(finite_or(setpoint.yaw_rate, 0, -4, 4), along(heading_));
    if (std::isfinite(setpoint.yaw)) return turn_to(setpoint.yaw, 0, along(setpoint.yaw));
    const double speed = horizontal_length(velocity);
    return speed < 0.05 ? Demand{} : turn_to(direction_of(velocity, heading_), 0, speed);
}

Rover::Demand Rover::drive_around(const Setpoint& setpoint) const {
    if (!has_horizontal(setpoint.position)) return {};
    const double asked = finite_or(setpoint.radius, 0, -1e4, 1e4);
    const double radius = std::copysign(std::max(std::abs(asked), limits_.turn_radius), asked);
    const Course course = course_on_circle(motion_, setpoint.position, radius, std::max(1.5, std::abs(speed_)));
    return turn_to(course.angle, course.turn_rate,
                   std::min(limits_.horizontal, std::sqrt(tyre_grip * std::abs(radius))));
}

Rover::Demand Rover::turn(double turn_rate, double speed) const {
    const double bounded_rate = std::clamp(turn_rate, -limits_.yaw_rate, limits_.yaw_rate);
    const double wanted = std::clamp(speed, -limits_.horizontal, limits_.horizontal);
    return {.speed = wanted,
            .curvature = std::copysign(bounded_rate / std::max(std::abs(speed_), 0.5), wanted * bounded_rate)};
}

// The farther the heading is off, the slower, so that the turn is tight.
Rover::Demand Rover::turn_to(double course, double turn_rate, double speed) const {
    const double off = wrap_pi(course - heading_);
    const double slow = std::sqrt(tyre_grip * limits_.turn_radius) / 2;
    const double most = std::max(std::abs(speed) * std::cos(off), slow);
    Demand demand = turn(turn_rate + heading_gain * off, std::clamp(speed, -most, most));
    demand.course = course;
    return demand;
}

double Rover::stopping_speed(double distance) const noexcept {
    return std::sqrt(1.4 * limits_.acceleration * std::max(distance, 0.0));
}

void Rover::move(const Demand& demand, double ground) {
    const double most = limits_.acceleration * step_s;
    speed_ += std::clamp((demand.speed - speed_) * (step_s / speed_lag), -most, most);
    if (demand.speed == 0 && std::abs(speed_) < 0.01) speed_ = 0;
    const double tightest = std::min(1 / limits_.turn_radius, tyre_grip / std::max(speed_ * speed_, 0.01));
    curvature_ += (std::clamp(demand.curvature, -tightest, tightest) - curvature_) * (step_s / steering_lag);
    if (std::abs(curvature_) < 1e-9) curvature_ = 0;
    const Vector3 rates{0, 0, speed_ * curvature_};
    const double heading = heading_ + rates.z() * step_s;
    const double sinking = std::clamp((ground - motion_.position.z()) / step_s, -2.0, 2.0);
    const Vector3 velocity{speed_ * std::cos(heading), speed_ * std::sin(heading), sinking};
    integrate_step((velocity - motion_.velocity) / step_s, rates);
}

void Rover::report(const Demand& demand) {
    const double course = finite_or(demand.course, heading_, -1e3, 1e3);
    const double drive = std::clamp(demand.speed / limits_.horizontal, -1.0, 1.0);
    const double pull = std::max(0.0, demand.speed == 0 ? 0.0 : (demand.speed - speed_) / demand.speed);
    thrust_ = std::abs(drive);
    load_ = std::abs(speed_) / cruise_speed + std::min(pull, 1.0);
    targets_ = {.attitude = to_quaternion({0, 0, course}),
                .rates = {0, 0, demand.speed * demand.curvature},
                .thrust = drive,
                .velocity = {demand.speed * std::cos(course), demand.speed * std::sin(course), 0}};
    actuators_.outputs = {drive, std::clamp(curvature_ * limits_.turn_radius, -1.0, 1.0)};
    actuators_.is_motor = {};
    actuators_.used = 2;
}

}  // namespace mavloom::flight
