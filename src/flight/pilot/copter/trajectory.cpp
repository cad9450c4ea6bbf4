// SPDX-License-Identifier: MIT
#include "flight/pilot/copter/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "flight/pilot/copter/shaping.hpp"
#include "flight/pilot/path.hpp"

namespace mavloom::flight {

namespace {

constexpr double position_gain = 0.95, height_gain = 1.0;          // 1/s; MPC_XY_P and MPC_Z_P of PX4
constexpr double velocity_gain = 4;                                // 1/s
constexpr double braking_share = 0.5;                              // of the acceleration; the jerk takes the rest
constexpr double up_acceleration = 4, down_acceleration = 3;       // m/s^2; MPC_ACC_UP_MAX and MPC_ACC_DOWN_MAX
constexpr double yaw_gain = 2, yaw_acceleration = to_radians(90);  // 1/s, rad/s^2
constexpr double patience = 2;                                     // m that the path may be ahead of the vehicle

bool accelerates_only(const Setpoint& setpoint) noexcept {
    return has_horizontal(setpoint.acceleration) && !has_horizontal(setpoint.velocity) &&
           !has_horizontal(setpoint.position);
}

}  // namespace

void Trajectory::start(const Kinematics& motion) {
    target_ = {.position = motion.position, .velocity = motion.velocity, .yaw = yaw_of(motion.attitude)};
}

void Trajectory::step(const Setpoint& setpoint, const Kinematics& motion) {
    step_yaw(setpoint);
    if (setpoint.limits.jerk <= 0 && setpoint.steering == Steering::trajectory) return follow_directly(setpoint);
    resume(motion);
    step_horizontal(setpoint);
    step_vertical(setpoint);
    wait_for(motion.position);
}

void Trajectory::follow_directly(const Setpoint& setpoint) {
    const SpeedLimits& limits = setpoint.limits;
    target_.position = setpoint.position;
    target_.velocity = setpoint.velocity;
    target_.velocity.head<2>() = limited(Vector2(setpoint.velocity.head<2>()), limits.horizontal);
    target_.velocity.z() = std::clamp(setpoint.velocity.z(), -limits.up, limits.down);
    for (int axis = 0; axis < 3; ++axis)
        target_.acceleration[axis] = std::isfinite(setpoint.acceleration[axis]) ? setpoint.acceleration[axis] : 0;
}

// Where the last set-point did not control an axis, its path begins at the vehicle.
void Trajectory::resume(const Kinematics& motion) {
    if (std::isfinite(target_.position.sum() + target_.velocity.sum())) return;
    for (int axis = 0; axis < 3; ++axis) {
        if (std::isfinite(target_.position[axis] + target_.velocity[axis])) continue;
        target_.position[axis] = motion.position[axis];
        target_.velocity[axis] = motion.velocity[axis];
    }
}

void Trajectory::step_horizontal(const Setpoint& setpoint) {
    const double jerk = std::max(setpoint.limits.jerk, 0.5);
    if (setpoint.steering == Steering::trajectory && accelerates_only(setpoint)) {
        const Vector2 change = setpoint.acceleration.head<2>() - target_.acceleration.head<2>();
        target_.acceleration.head<2>() += limited(change, jerk * step_s);
        target_.velocity.head<2>().setConstant(nan);
        target_.position.head<2>().setConstant(nan);
        return;
    }
    const Demand demand = horizontal_demand(setpoint);
    const Vector2 error = demand.velocity - target_.velocity.head<2>();
    const double size = error.norm();
    Vector2 acceleration = demand.acceleration;
    if (size > 1e-9) acceleration += error * (closing_speed(size, velocity_gain, jerk) / size);
    acceleration = limited(acceleration, setpoint.limits.acceleration);
    const Vector2 change = acceleration - target_.acceleration.head<2>();
    target_.acceleration.head<2>() += limited(change, jerk * step_s);
    target_.velocity.head<2>() += target_.acceleration.head<2>() * step_s;
    target_.position.head<2>() += target_.velocity.head<2>() * step_s;
}

Trajectory::Demand Trajectory::horizontal_demand(const Setpoint& setpoint) const {
    const SpeedLimits& limits = setpoint.limits;
    if (has_horizontal(setpoint.position)) {
        if (setpoint.steering == Steering::circle) return circle_demand(setpoint);
        const Vector2 way = setpoint.position.head<2>() - target_.position.head<2>();
        const double distance = way.norm();
        if (distance < 1e-6) return {};
        const double deceleration = braking_share * limits.acceleration;
        const double speed = std::min(closing_speed(distance, position_gain, deceleration), limits.horizontal);
        return {.velocity = way * (speed / distance)};
    }
    if (has_horizontal(setpoint.velocity))
        return {.velocity = limited(Vector2(setpoint.velocity.head<2>()), limits.horizontal)};
    return {};
}

// Straight to the circle, then around it: the speed that the way to the circle does not need goes around.
Trajectory::Demand Trajectory::circle_demand(const Setpoint& setpoint) const {
    const SpeedLimits& limits = setpoint.limits;
    const double radius = std::max(std::abs(setpoint.radius), 0.5), side = setpoint.radius < 0 ? -1 : 1;
    const Vector2 offset = target_.position.head<2>() - setpoint.position.head<2>();
    const double distance = offset.norm();
    const Vector2 outwards = distance > 1e-3 ? Vector2(offset / distance) : Vector2(1, 0);
    const Vector2 around = Vector2(-outwards.y(), outwards.x()) * side;
    const double fastest = std::min(limits.horizontal, std::sqrt(0.8 * limits.acceleration * radius));
    const double deceleration = braking_share * limits.acceleration;
    const double out = std::clamp(closing_speed(radius - distance, position_gain, deceleration), -fastest, fastest);
    const double along = std::sqrt(std::max(fastest * fastest - out * out, 0.0));
    const double moves = target_.velocity.head<2>().dot(around);
    return {.velocity = outwards * out + around * along,
            .acceleration = outwards * (-moves * moves / std::max(distance, 0.5 * radius))};
}

void Trajectory::step_vertical(const Setpoint& setpoint) {
    const double jerk = std::max(setpoint.limits.jerk, 0.5);
    const double error = vertical_demand(setpoint) - target_.velocity.z();
    const double acceleration = std::clamp(closing_speed(error, velocity_gain, jerk), -up_acceleration,
                                           down_acceleration);
    target_.acceleration.z() = moved_towards(target_.acceleration.z(), acceleration, jerk * step_s);
    target_.velocity.z() += target_.acceleration.z() * step_s;
    target_.position.z() += target_.velocity.z() * step_s;
}

double Trajectory::vertical_demand(const Setpoint& setpoint) const {
    const SpeedLimits& limits = setpoint.limits;
    double speed = 0;
    if (std::isfinite(setpoint.position.z())) {
        const double way = setpoint.position.z() - target_.position.z();
        speed = closing_speed(way, height_gain, braking_share * down_acceleration);
    } else if (std::isfinite(setpoint.velocity.z())) {
        speed = setpoint.velocity.z();
    }
    return std::clamp(speed, -limits.up, limits.down);
}

void Trajectory::step_yaw(const Setpoint& setpoint) {
    const double fastest = setpoint.limits.yaw_rate;
    double rate = std::isfinite(setpoint.yaw_rate) ? setpoint.yaw_rate : 0;
    if (std::isfinite(setpoint.yaw))
        rate += closing_speed(wrap_pi(setpoint.yaw - target_.yaw), yaw_gain, yaw_acceleration);
    rate = std::clamp(rate, -fastest, fastest);
    target_.yaw_rate = moved_towards(target_.yaw_rate, rate, yaw_acceleration * step_s);
    target_.yaw = wrap_pi(target_.yaw + target_.yaw_rate * step_s);
}

void Trajectory::wait_for(const Vector3& vehicle) {
    const Vector3 ahead = target_.position - vehicle;
    if (ahead.squaredNorm() > patience * patience) target_.position = vehicle + limited(ahead, patience);
}

}  // namespace mavloom::flight
