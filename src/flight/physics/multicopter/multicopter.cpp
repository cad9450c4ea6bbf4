// SPDX-License-Identifier: MIT
#include "flight/physics/multicopter/multicopter.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/multicopter/plain_setpoint.hpp"
#include "flight/physics/multicopter/shaping.hpp"

namespace mavloom::flight {

namespace {

constexpr double rotor_lag = 0.03;  // s
constexpr double rotor_lag_share = step_s / rotor_lag;
constexpr double body_drag = 0.2;  // 1/s at sea level
constexpr double sea_level_density = 1.225;

// Legs: a spring with damping that carries the weight at height 0, and friction.
constexpr double leg_stiffness = 40 * 40;               // 1/s^2
constexpr double leg_damping = 2 * 0.7 * 40;            // 1/s
constexpr double leg_travel = gravity / leg_stiffness;  // m
constexpr double hardest_impact = 1.5;                  // m/s; a faster fall ends at once
constexpr double friction = 20, levelling = 10;         // 1/s
constexpr double firm = 0.3 * gravity;                  // push of the legs that keeps the vehicle from sliding

constexpr double ramp_up = 3, ramp_down = 1;  // s from no thrust to full thrust, and back; MPC_TKO_RAMP_T

// True if the set-point leads away from the ground.
bool leads_up(const Setpoint& setpoint, double z) noexcept {
    if (std::isfinite(setpoint.position.z())) return setpoint.position.z() < z - 0.15;
    if (std::isfinite(setpoint.velocity.z())) return setpoint.velocity.z() < -0.1;
    return setpoint.acceleration.z() < -0.5;
}

}  // namespace

void Multicopter::place(const Vector3& position, double heading) {
    motion_ = {.position = position, .attitude = to_quaternion({0, 0, heading})};
    rotors_.reset();
    controller_.reset();
    trajectory_.start(motion_);
    targets_ = {.attitude = motion_.attitude};
    air_velocity_ = Vector3::Zero();
    touches_ground_ = true;
    thrust_ = load_ = ground_thrust_ = 0;
}

void Multicopter::move_origin(const Vector3& by) {
    Airframe::move_origin(by);
    trajectory_.move_origin(by);
}

void Multicopter::step(const Setpoint& setpoint, bool armed, const Surroundings& around) {
    air_velocity_ = motion_.velocity - around.wind;
    const bool has_power = armed && around.supply > 0;
    rotors_.step(has_power ? control(is_plain(setpoint) ? setpoint : made_plain(setpoint)) : Moments{}, rotor_lag_share);
    if (!has_power) ground_thrust_ = 0;
    steering_ = setpoint.steering;
    move(around);
    report(around.supply);
}

Moments Multicopter::control(const Setpoint& setpoint) {
    controller_.targets() = {.attitude = motion_.attitude};
    if (steers_by_path(setpoint.steering))
        return touches_ground_ ? control_on_ground(setpoint) : control_path(setpoint);
    ground_thrust_ = rotors_.given().thrust;
    controller_.reset();
    const double thrust = std::isfinite(setpoint.thrust) ? setpoint.thrust : 0;
    switch (setpoint.steering) {
        case Steering::attitude:
            return controller_.hold(setpoint.attitude, std::isfinite(setpoint.yaw_rate) ? setpoint.yaw_rate : 0, thrust,
                                    motion_);
        case Steering::rates: return controller_.turn(setpoint.rates, thrust, motion_);
        case Steering::actuators:
            return {setpoint.mixer[0] / 2, setpoint.mixer[1] / 2, setpoint.mixer[2] / 2, setpoint.mixer[3]};
        default: return {};
    }
}

Moments Multicopter::control_path(const Setpoint& setpoint) {
    if (!steers_by_path(steering_)) trajectory_.start(motion_);
    ground_thrust_ = rotors_.given().thrust;
    trajectory_.step(setpoint, motion_);
    return controller_.follow(trajectory_.target(), setpoint, motion_);
}

// The thrust rises slowly until the vehicle lifts, and falls when it shall stay.
Moments Multicopter::control_on_ground(const Setpoint& setpoint) {
    const bool lifts = !setpoint.touch_down && leads_up(setpoint, motion_.position.z());
    ground_thrust_ = std::clamp(ground_thrust_ + (lifts ? step_s / ramp_up : -step_s / ramp_down), 0.0, 0.9);
    trajectory_.start(motion_);
    controller_.lift_off(ground_thrust_);
    const Quaternion level = to_quaternion({0, 0, trajectory_.target().yaw});
    return controller_.hold(level, 0, ground_thrust_, motion_);
}

void Multicopter::move(const Surroundings& around) {
    const Moments& given = rotors_.given();
    Vector3 acceleration = motion_.attitude * Vector3(0, 0, -full_thrust * around.supply * given.thrust);
    acceleration -= air_velocity_ * (body_drag * around.air_density / sea_level_density);
    acceleration.z() += gravity;
    const Vector3 moments = Vector3(given.roll, given.pitch, given.yaw).cwiseProduct(full_moment) * around.supply;
    const Vector3 rates = motion_.rates + moments * step_s;

    const double depth = motion_.position.z() - around.ground;
    const double push = depth < -leg_travel
                            ? 0
                            : std::max(0.0, leg_stiffness * (depth + leg_travel) + leg_damping * motion_.velocity.z());
    touches_ground_ = push > 0;
    if (!touches_ground_) return integrate_step(acceleration, rates);
    integrate_step(legs(push, depth, acceleration), push < firm ? rates : rates_after(push));
}

Vector3 Multicopter::legs(double push, double depth, const Vector3& acceleration) const {
    Vector3 result = acceleration;
    result.z() -= push;
    if (motion_.velocity.z() > hardest_impact) result.z() = (hardest_impact - motion_.velocity.z()) / step_s;
    if (push >= firm) result.head<2>() = -friction * motion_.velocity.head<2>();
    // Close to rest, the last motion ends exactly, so that a parked vehicle reports no velocity.
    const bool is_close = std::abs(depth) < 2e-4 && motion_.velocity.squaredNorm() < 4e-4;
    if (is_close && rotors_.given().thrust < 0.05) {
        const double rise = std::abs(depth) < 1e-7 ? 0 : -20 * depth;
        result = (Vector3(0, 0, rise) - motion_.velocity) / step_s;
    }
    return result;
}

// The vehicle stands up on its legs and does not turn.
Vector3 Multicopter::rates_after(double push) const {
    const Vector3 down = motion_.attitude.conjugate() * Vector3::UnitZ();
    const Vector3 tilt(down.y(), -down.x(), 0);
    if (push < firm || tilt.squaredNorm() < 1e-20) return Vector3::Zero();
    return -levelling * tilt;
}

void Multicopter::report(double supply) {
    const Moments& given = rotors_.given();
    const double hover_share = given.thrust * supply * full_thrust / gravity;
    thrust_ = given.thrust;
    load_ = hover_share * std::sqrt(std::max(hover_share, 0.0));
    targets_ = controller_.targets();
    std::ranges::copy(rotors_.outputs(), actuators_.outputs.begin());
    std::fill_n(actuators_.is_motor.begin(), Rotors::count, true);
    actuators_.used = Rotors::count;
}

}  // namespace mavloom::flight
