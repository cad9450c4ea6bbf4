// SPDX-License-Identifier: MIT
#include "flight/plant/fixed_wing.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr double cruise_motor = 0.5;  // motor speed of the standard plane in level flight at cruise speed
constexpr double gear_travel = 0.02;  // m that the gear gives under the plane's weight
constexpr double gear_damping = 30;   // N/(m/s) for each kg of the plane
constexpr double gear_lag = 0.08;     // s, with which the wheels turn the body
constexpr double deepest = -0.15;     // m: height at which the hull carries what the gear cannot
constexpr double rolling = 0.04, braking = 0.3, sideways = 0.7;  // coefficients of friction
constexpr double standing = 0.01;                                // m/s: slower counts as standing while the brakes hold

}  // namespace

FixedWing::FixedWing(const PlaneBody& body)
    : body_(body), inertia_(wing::inertia_of(body)), cruise_speed_(wing::cruise_speed(body)) {
    channels_.used = 4;
    channels_.is_motor[2] = true;
}

void FixedWing::place(const Vector3& position, double heading) {
    rest_at(position, heading);
    motor_ = 0;
}

void FixedWing::step(const Outputs& outputs, const Surroundings& around, double dt) {
    const double throttle = motor_output(outputs[2]);
    motor_ += (throttle - motor_) * (dt / body_.spin_s);
    if (motor_ < 1e-3 && throttle == 0) motor_ = 0;
    const Vector3 air = motion_.attitude.conjugate() * (motion_.velocity - around.wind);
    const Now now{.air = wing::airflow(air, around.air_density),
                  .euler = to_euler(motion_.attitude),
                  .height = around.ground - motion_.position.z(),
                  .brakes = throttle == 0,
                  .controls = {servo_output(outputs[0]), servo_output(outputs[1]), servo_output(outputs[3])}};
    move(now, around, dt);
    air_velocity_ = motion_.velocity - around.wind;
    thrust_ = motor_;
    load_ = motor_ * motor_ / (cruise_motor * cruise_motor);
}

void FixedWing::move(const Now& now, const Surroundings& around, double dt) {
    const double supplied = motor_ * std::sqrt(std::clamp(around.supply, 0.0, 1.2));
    const Vector3 force = motion_.attitude * wing::force(body_, now.air, supplied);
    const double carried = gear_force(now.height);
    Vector3 acceleration = force / body_.mass_kg + around.push;
    acceleration.z() += gravity - carried / body_.mass_kg;
    Vector3 velocity = motion_.velocity + acceleration * dt;
    touches_ground_ = carried > 0;
    const bool stands = touches_ground_ && now.brakes && motor_ == 0 && !around.lift() &&
                        horizontal_length(motion_.velocity) < standing;
    if (stands) {
        velocity = {0, 0, std::abs(now.height) < 1e-6 ? 0 : std::clamp(now.height / 0.1, -1.0, 1.0)};
    } else if (touches_ground_) {
        velocity = with_wheels(velocity, carried, now, dt);
    }
    if (now.height < deepest) velocity.z() = std::min(velocity.z(), 0.0);
    Vector3 rates = touches_ground_ ? turned_on_wheels(now, dt) : turned_by_air(now, dt);
    rates += around.turn * dt;
    if (stands && rates.norm() < 1e-5) rates.setZero();
    integrate_step((velocity - motion_.velocity) / dt, rates, dt);
}

double FixedWing::gear_force(double height) const {
    if (height > gear_travel) return 0;
    const double weight = body_.mass_kg * gravity, stiffness = weight / gear_travel;
    return std::max(0.0, weight - stiffness * height + gear_damping * body_.mass_kg * motion_.velocity.z());
}

Vector3 FixedWing::with_wheels(const Vector3& velocity, double load, const Now& now, double dt) const {
    const double yaw = now.euler.yaw;
    const Vector3 forward{math::cos(yaw), math::sin(yaw), 0}, right{-forward.y(), forward.x(), 0};
    const auto slowed = [&](double speed, double friction) {
        return std::copysign(std::max(std::abs(speed) - friction * load / body_.mass_kg * dt, 0.0), speed);
    };
    const double along = slowed(velocity.dot(forward), now.brakes ? braking : rolling);
    return along * forward + slowed(velocity.dot(right), sideways) * right + Vector3{0, 0, velocity.z()};
}

// Euler's equation.
Vector3 FixedWing::turned_by_air(const Now& now, double dt) const {
    const Vector3& rates = motion_.rates;
    const Vector3 moment = wing::natural_moment(body_, now.air, rates) +
                           wing::control_moment(body_, now.air).cwiseProduct(now.controls) -
                           rates.cross(inertia_.cwiseProduct(rates));
    return rates + moment.cwiseQuotient(inertia_) * dt;
}

// Wheels keep the wings level. They carry the nose until the elevator lifts it: the faster the plane, the more the air
// decides.
Vector3 FixedWing::turned_on_wheels(const Now& now, double dt) const {
    constexpr double levelling = 4;  // 1/s
    constexpr double tail_strike = to_radians(14);
    const double airborne = std::clamp(now.air.speed / cruise_speed_, 0.0, 1.0);
    const double turn = horizontal_length(motion_.velocity) / body_.turn_radius_m * now.controls.z();
    const Vector3 wheels = Vector3(-levelling * now.euler.roll, -levelling * now.euler.pitch, turn);
    Vector3 rates = motion_.rates + (wheels - motion_.rates) * (dt / gear_lag);
    rates.y() += airborne * (turned_by_air(now, dt).y() - rates.y());
    if (now.euler.pitch <= 0) rates.y() = std::max(rates.y(), wheels.y());
    if (now.euler.pitch > tail_strike) rates.y() = std::min(rates.y(), 0.0);
    return rates;
}

}  // namespace mavloom::flight
