// SPDX-License-Identifier: MIT
#include "flight/physics/fixed_wing.hpp"

#include <algorithm>
#include <cmath>

namespace mavloom::flight {

namespace {

using wing::mass;

constexpr double motor_lag = 0.15, rate_lag = 0.08;       // s
constexpr double cruise_motor = 0.5;                      // motor speed of level flight at wing::cruise_speed
constexpr double gear_stiffness = mass * gravity / 0.02;  // N/m: the gear gives 2 cm under the plane's weight
constexpr double gear_damping = 45;                       // N/(m/s)
constexpr double gear_travel = 0.02;                      // m
constexpr double deepest = -0.15;                         // m: height at which the hull carries what the gear cannot
constexpr double rolling = 0.04, braking = 0.3, sideways = 0.7;  // coefficients of friction
constexpr double standing = 0.01;                                // m/s: slower counts as standing while the brakes hold
const Vector3 greatest_rates{to_radians(180), to_radians(90), to_radians(60)};

}  // namespace

void FixedWing::place(const Vector3& position, double heading) {
    motion_ = {};
    motion_.position = position;
    motion_.attitude = to_quaternion({0, 0, heading});
    pilot_.reset();
    motor_ = thrust_ = load_ = 0;
    touches_ground_ = true;
}

void FixedWing::step(const Setpoint& setpoint, bool armed, const Surroundings& around) {
    const wing::Situation now = look(around);
    const wing::Command command = pilot_.step(setpoint, armed, now);
    motor_ += (command.throttle - motor_) * (step_s / motor_lag);
    if (motor_ < 1e-3 && command.throttle == 0) motor_ = 0;
    report(command, now);
    move(command, now, around.supply);
    air_velocity_ = motion_.velocity - around.wind;
}

wing::Situation FixedWing::look(const Surroundings& around) const {
    const Vector3 air = motion_.attitude.conjugate() * (motion_.velocity - around.wind);
    return {.motion = motion_,
            .euler = to_euler(motion_.attitude),
            .air = wing::airflow(air, around.air_density),
            .height = around.ground - motion_.position.z(),
            .on_ground = touches_ground_,
            .density = around.air_density};
}

void FixedWing::move(const wing::Command& command, const wing::Situation& now, double supply) {
    const Vector3 force = motion_.attitude * wing::force(now.air, motor_ * std::sqrt(std::clamp(supply, 0.0, 1.2)));
    const double carried = gear_force(now.height);
    Vector3 acceleration = force / mass;
    acceleration.z() += gravity - carried / mass;
    Vector3 velocity = motion_.velocity + acceleration * step_s;
    touches_ground_ = carried > 0;
    const bool stands = touches_ground_ && command.brakes && motor_ == 0 && motion_.velocity.head<2>().norm() < standing;
    if (stands) {
        velocity = {0, 0, std::abs(now.height) < 1e-6 ? 0 : std::clamp(now.height / 0.1, -1.0, 1.0)};
    } else if (touches_ground_) {
        velocity = with_wheels(velocity, carried, command.brakes, now.euler.yaw);
    }
    if (now.height < deepest) velocity.z() = std::min(velocity.z(), 0.0);
    const Vector3 wanted = touches_ground_ ? rates_on_ground(command, now) : rates_in_air(command, now.air);
    Vector3 rates = motion_.rates + (wanted - motion_.rates) * (step_s / rate_lag);
    if (stands && rates.norm() < 1e-5) rates.setZero();
    integrate_step((velocity - motion_.velocity) / step_s, rates);
}

double FixedWing::gear_force(double height) const {
    if (height > gear_travel) return 0;
    return std::max(0.0, mass * gravity - gear_stiffness * height + gear_damping * motion_.velocity.z());
}

Vector3 FixedWing::with_wheels(const Vector3& velocity, double load, bool brakes, double yaw) const {
    const Vector3 forward{std::cos(yaw), std::sin(yaw), 0}, right{-forward.y(), forward.x(), 0};
    const auto slowed = [&](double speed, double friction) {
        return std::copysign(std::max(std::abs(speed) - friction * load / mass * step_s, 0.0), speed);
    };
    const double along = slowed(velocity.dot(forward), brakes ? braking : rolling);
    return along * forward + slowed(velocity.dot(right), sideways) * right + Vector3{0, 0, velocity.z()};
}

// The rudders work by the air that flows over them.
Vector3 FixedWing::rates_in_air(const wing::Command& command, const wing::Airflow& air) const {
    const double authority = std::clamp(air.speed / wing::cruise_speed, 0.0, 1.5);
    const Vector3 limit = authority * greatest_rates;
    Vector3 rates = command.rates.cwiseMin(limit).cwiseMax(-limit);
    const double stalled = std::max(0.0, std::abs(air.attack) - wing::stall_angle);
    rates.y() -= std::copysign(3 * stalled, air.attack) * std::min(authority, 1.0);
    rates.z() += 2 * air.slip * std::min(authority, 1.0);
    return rates;
}

// Wheels keep the wings level and carry the nose until the elevator lifts it. The nose wheel steers.
Vector3 FixedWing::rates_on_ground(const wing::Command& command, const wing::Situation& now) const {
    constexpr double levelling = 4;  // 1/s
    constexpr double tightest = 5;   // m, radius
    constexpr double tail_strike = to_radians(14);
    const double share = std::clamp(now.air.speed / wing::cruise_speed, 0.0, 1.0);
    const double level = -levelling * now.euler.pitch;
    double pitch_rate = share * command.rates.y() + (1 - share) * level;
    if (now.euler.pitch < 0) pitch_rate = std::max(pitch_rate, level);
    if (now.euler.pitch > tail_strike) pitch_rate = std::min(pitch_rate, 0.0);
    const double turn = motion_.velocity.head<2>().norm() / tightest;
    return {-levelling * now.euler.roll, pitch_rate, std::clamp(command.rates.z(), -turn, turn)};
}

void FixedWing::report(const wing::Command& command, const wing::Situation& now) {
    const Vector3 full{to_radians(150), to_radians(75), to_radians(40)};  // rates at full deflection
    const double course = std::isnan(command.course) ? now.euler.yaw : command.course;
    const double speed = motion_.velocity.head<2>().norm();
    thrust_ = motor_;
    load_ = motor_ * motor_ / (cruise_motor * cruise_motor);
    targets_ = {.attitude = to_quaternion({command.roll, command.pitch, now.euler.yaw}),
                .rates = command.rates,
                .thrust = command.throttle,
                .velocity = {speed * std::cos(course), speed * std::sin(course), -finite_or(command.climb, 0, -50, 50)}};
    const auto deflection = [&](int axis) { return std::clamp(command.rates[axis] / full[axis], -1.0, 1.0); };
    actuators_.outputs = {deflection(0), deflection(1), motor_, deflection(2)};
    actuators_.is_motor = {false, false, true, false};
    actuators_.used = 4;
}

}  // namespace mavloom::flight
