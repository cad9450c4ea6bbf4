// SPDX-License-Identifier: MIT
#include "flight/navigation/manual_control.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

constexpr double interval = 5 * step_s;  // s between two calls
constexpr double stick_tilt = to_radians(35), stick_bank = to_radians(45), pitch_limit = to_radians(25);
constexpr double stick_turn_rate = to_radians(150);  // rad/s
constexpr double acro_rate = to_radians(220), acro_yaw_rate = to_radians(100);
constexpr double stick_speed = 10;  // m/s
constexpr double stick_jerk = 8;    // m/s^3
constexpr double dead_zone = 0.1;

// A stick in -1 to 1 without its dead zone.
double beyond_dead_zone(double stick) noexcept {
    const double rest = std::max(std::abs(stick) - dead_zone, 0.0) / (1 - dead_zone);
    return std::copysign(rest, stick);
}
// From a throttle stick in 0 to 1: up is positive.
double climb_of(const Sticks& sticks) noexcept { return beyond_dead_zone(2 * sticks.throttle - 1); }

// Forward and right, rotated by the yaw.
Vector3 rotated(double forward, double right, double yaw) {
    const double c = math::cos(yaw), s = math::sin(yaw);
    return {forward * c - right * s, forward * s + right * c, nan};
}

}  // namespace

SpeedLimits ManualControl::limits() const noexcept {
    const Tuning& tuning = context_.tuning;
    return {.horizontal = std::min(stick_speed, tuning.max_speed),
            .up = tuning.climb_speed,
            .down = tuning.descent_speed,
            .acceleration = std::max(tuning.acceleration, 5.0),
            .tilt = tuning.max_tilt,
            .yaw_rate = stick_turn_rate,
            .air_minimum = tuning.min_airspeed,
            .air_maximum = std::max(tuning.max_speed, tuning.cruise_speed + 1),
            .turn_radius = tuning.rover_turn_radius,
            .jerk = stick_jerk};
}

Setpoint ManualControl::steer(Behaviour behaviour, const Sticks& sticks) {
    if (context_.kind() == Kind::quad) return steer_quad(behaviour, sticks);
    return context_.kind() == Kind::plane ? steer_plane(behaviour, sticks) : steer_rover(behaviour, sticks);
}

Setpoint ManualControl::steer_quad(Behaviour behaviour, const Sticks& sticks) {
    Setpoint setpoint{.thrust = sticks.throttle, .limits = limits()};
    const double yaw_rate = stick_turn_rate * beyond_dead_zone(sticks.yaw);
    if (behaviour == Behaviour::acro) {
        setpoint.steering = Steering::rates;
        setpoint.rates = {acro_rate * sticks.roll, -acro_rate * sticks.pitch, acro_yaw_rate * sticks.yaw};
        return setpoint;
    }
    const bool is_parked = context_.is_on_ground();
    yaw_ = is_parked ? context_.craft.estimate().euler.yaw : wrap_pi(yaw_ + yaw_rate * interval);
    setpoint.yaw = yaw_;
    setpoint.yaw_rate = is_parked ? 0 : yaw_rate;
    if (behaviour == Behaviour::manual || behaviour == Behaviour::stabilized) {
        setpoint.steering = Steering::attitude;
        setpoint.attitude = to_quaternion({stick_tilt * sticks.roll, -stick_tilt * sticks.pitch, yaw_});
        return setpoint;
    }
    const double up = climb_of(sticks);
    setpoint.steering = is_parked && up <= 0 ? Steering::none : Steering::trajectory;
    const double forward = beyond_dead_zone(sticks.pitch), right = beyond_dead_zone(sticks.roll);
    const double heading = context_.craft.estimate().euler.yaw;
    if (behaviour == Behaviour::altitude) {
        setpoint.acceleration = rotated(forward, right, heading) * (gravity * math::tan(stick_tilt));
    } else {
        setpoint.velocity = rotated(forward, right, heading) * setpoint.limits.horizontal;
    }
    setpoint.velocity.z() = up > 0 ? -up * setpoint.limits.up : -up * setpoint.limits.down;
    return setpoint;
}

// With assistance, the roll stick turns and the pitch stick climbs.
Setpoint ManualControl::steer_plane(Behaviour behaviour, const Sticks& sticks) const {
    Setpoint setpoint{.thrust = sticks.throttle, .limits = limits()};
    setpoint.limits.horizontal = context_.tuning.cruise_speed;
    setpoint.limits.tilt = context_.tuning.max_tilt;
    switch (behaviour) {
        case Behaviour::manual:
            setpoint.steering = Steering::actuators;
            setpoint.mixer = {sticks.roll, -sticks.pitch, sticks.yaw, sticks.throttle};
            return setpoint;
        case Behaviour::acro:
            setpoint.steering = Steering::rates;
            setpoint.rates = {acro_rate * sticks.roll, -acro_rate / 2 * sticks.pitch, acro_yaw_rate / 2 * sticks.yaw};
            return setpoint;
        case Behaviour::stabilized:
            setpoint.steering = Steering::attitude;
            setpoint.attitude = to_quaternion(
                {stick_bank * sticks.roll, -pitch_limit * sticks.pitch, context_.craft.estimate().euler.yaw});
            return setpoint;
        default: break;
    }
    const double up = beyond_dead_zone(-sticks.pitch), turn = beyond_dead_zone(sticks.roll);
    setpoint.steering = Steering::trajectory;
    if (turn != 0) setpoint.yaw_rate = gravity * math::tan(stick_bank * turn) / setpoint.limits.horizontal;
    if (up != 0) setpoint.velocity.z() = up > 0 ? -up * setpoint.limits.up : -up * setpoint.limits.down;
    if (context_.is_on_ground() && sticks.throttle > 0.5) setpoint.velocity.z() = -setpoint.limits.up;
    return setpoint;
}

// The throttle stick's middle is standstill; with assistance it sets the speed.
Setpoint ManualControl::steer_rover(Behaviour behaviour, const Sticks& sticks) const {
    Setpoint setpoint{.limits = limits()};
    setpoint.limits.horizontal = context_.tuning.max_speed;
    const double forward = climb_of(sticks), right = beyond_dead_zone(sticks.roll);
    if (behaviour == Behaviour::manual) {
        setpoint.steering = Steering::actuators;
        setpoint.mixer = {0, 0, right, forward};
        return setpoint;
    }
    setpoint.steering = Steering::trajectory;
    setpoint.velocity = rotated(forward * setpoint.limits.horizontal, 0, context_.craft.estimate().euler.yaw);
    setpoint.velocity.z() = 0;
    setpoint.yaw_rate = right * context_.tuning.max_yaw_rate;
    return setpoint;
}

}  // namespace mavloom::flight
