// SPDX-License-Identifier: MIT
#include "flight/plant/rover.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr double stiction = 0.01;        // share of the drive output that does not move a resting rover
constexpr double standing_speed = 0.01;  // m/s
constexpr double load_speed = 5;         // m/s, at which the load is 1
constexpr double load_pull = 3;          // m/s^2, that adds 1 to the load

}  // namespace

Rover::Rover(const RoverBody& body) : body_(body) { channels_.used = 2; }

void Rover::place(const Vector3& position, double heading) {
    rest_at(position, heading);
    heading_ = heading;
    speed_ = curvature_ = 0;
}

void Rover::step(const Outputs& outputs, const Surroundings& around, double dt) {
    const double before = speed_;
    drive(servo_output(outputs[0]) * std::min(around.supply, 1.0), dt);
    steer(servo_output(outputs[1]), dt);
    speed_ += (around.push.x() * math::cos(heading_) + around.push.y() * math::sin(heading_)) * dt;
    const Vector3 rates{0, 0, speed_ * curvature_};
    heading_ += rates.z() * dt;
    const double sinking = std::clamp((around.ground - motion_.position.z()) / dt, -2.0, 2.0);
    const Vector3 velocity{speed_ * math::cos(heading_), speed_ * math::sin(heading_), sinking};
    integrate_step((velocity - motion_.velocity) / dt, rates, dt);
    air_velocity_ = motion_.velocity - around.wind;
    thrust_ = std::abs(servo_output(outputs[0]));
    const double pulls = (std::abs(speed_) - std::abs(before)) / dt;
    load_ = std::abs(speed_) / load_speed + std::clamp(pulls / load_pull, 0.0, 1.0);
}

void Rover::drive(double output, double dt) {
    speed_ += body_.thrust_n / body_.mass_kg * (output - speed_ / body_.top_speed_m_s) * dt;
    if (std::abs(output) < stiction && std::abs(speed_) < standing_speed) speed_ = 0;
}

void Rover::steer(double output, double dt) {
    const double tightest = std::min(1 / body_.turn_radius_m, body_.grip_m_s2 / std::max(speed_ * speed_, 0.01));
    const double wanted = std::clamp(output / body_.turn_radius_m, -tightest, tightest);
    curvature_ += (wanted - curvature_) * (dt / body_.steering_lag_s);
    if (std::abs(curvature_) < 1e-9) curvature_ = 0;
}

}  // namespace mavloom::flight
