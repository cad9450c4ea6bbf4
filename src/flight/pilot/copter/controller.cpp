// SPDX-License-Identifier: MIT
#include "flight/pilot/copter/controller.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"
#include "flight/pilot/copter/shaping.hpp"

namespace mavloom::flight {

namespace {

const Vector3 position_gains{0.95, 0.95, 1.0};  // 1/s
const Vector3 velocity_gains{1.8, 1.8, 4.0};    // 1/s
const Vector3 learning_gains{0.4, 0.4, 2.0};    // 1/s^2
const Vector3 attitude_gains{6.5, 6.5, 2.8};    // 1/s
const Vector3 rate_gains{20, 20, 14};           // 1/s
const Vector3 fastest_rates{3.84, 3.84, 3.49};  // rad/s; MC_ROLLRATE_MAX 220 deg/s, MC_YAWRATE_MAX 200 deg/s
constexpr double max_learned = 4;               // m/s^2
constexpr double min_thrust = 0.1;              // of gravity: the vehicle keeps some thrust, so that it can steer
constexpr double max_thrust = 0.95;             // of the full thrust

Vector3 clamped(const Vector3& value, const Vector3& limit) { return value.cwiseMax(-limit).cwiseMin(limit); }

// The attitude whose thrust has this direction and whose nose points to `yaw`.
Quaternion attitude_for(const Vector3& force, double yaw) {
    const Vector3 z = -force.normalized();
    const Vector3 x = Vector3(-math::sin(yaw), math::cos(yaw), 0).cross(z).normalized();
    Eigen::Matrix3d axes;
    axes << x, z.cross(x), z;
    return Quaternion(axes);
}

}  // namespace

Moments Controller::follow(const MotionTarget& target, const Setpoint& setpoint, const Kinematics& motion) {
    const Vector3 velocity = wanted_velocity(target, setpoint.limits, motion);
    const Vector3 acceleration = wanted_acceleration(target, velocity, motion);
    const Vector3 force = force_for(acceleration, setpoint.limits.tilt);
    targets_.position = target.position;
    targets_.velocity = velocity;
    targets_.acceleration = acceleration;
    targets_.yaw = target.yaw;
    targets_.yaw_rate = target.yaw_rate;
    const Vector3 up = motion.attitude * Vector3(0, 0, -1);
    return hold(attitude_for(force, target.yaw), target.yaw_rate, force.dot(up) / full_thrust_, motion);
}

// The specific force (m/s^2) that accelerates so, within the limits of tilt and thrust. Height comes first.
Vector3 Controller::force_for(const Vector3& acceleration, double tilt) const {
    Vector3 force = acceleration - Vector3(0, 0, gravity);
    force.z() = std::clamp(force.z(), -max_thrust * full_thrust_, -min_thrust * gravity);
    const double most = max_thrust * full_thrust_;
    const double max_sideways = std::sqrt(most * most - force.z() * force.z());
    force.head<2>() = limited(Eigen::Vector2d(force.head<2>()), std::min(-force.z() * math::tan(tilt), max_sideways));
    return force;
}

Vector3 Controller::wanted_velocity(const MotionTarget& target, const SpeedLimits& limits,
                                    const Kinematics& motion) const {
    Vector3 velocity = target.velocity;
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(target.position[axis])) continue;
        const double forward = std::isfinite(velocity[axis]) ? velocity[axis] : 0;
        velocity[axis] = forward + position_gains[axis] * (target.position[axis] - motion.position[axis]);
    }
    // The loops may exceed the limits a little, to catch up with the path.
    velocity.head<2>() = limited(Eigen::Vector2d(velocity.head<2>()), 1.2 * limits.horizontal + 0.5);
    if (std::isfinite(velocity.z())) velocity.z() = std::clamp(velocity.z(), -1.2 * limits.up, 1.2 * limits.down);
    return velocity;
}

Vector3 Controller::wanted_acceleration(const MotionTarget& target, const Vector3& velocity, const Kinematics& motion) {
    Vector3 acceleration = target.acceleration;
    for (int axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(velocity[axis])) continue;
        const double error = velocity[axis] - motion.velocity[axis];
        const double learned = learned_[axis] + learning_gains[axis] * error * step_s;
        learned_[axis] = std::clamp(learned, -max_learned, max_learned);
        acceleration[axis] += velocity_gains[axis] * error + learned_[axis];
    }
    return acceleration;
}

Moments Controller::hold(const Quaternion& attitude, double yaw_rate, double thrust, const Kinematics& motion) {
    const Quaternion error = motion.attitude.conjugate() * attitude;
    Vector3 rates = attitude_gains.cwiseProduct(error.vec()) * (error.w() < 0 ? -2 : 2);
    rates += motion.attitude.conjugate() * Vector3(0, 0, yaw_rate);
    targets_.attitude = attitude;
    return turn(clamped(rates, fastest_rates), thrust, motion);
}

Moments Controller::turn(const Vector3& rates, double thrust, const Kinematics& motion) {
    targets_.rates = rates;
    targets_.thrust = std::clamp(thrust, 0.0, 1.0);
    const Vector3 moments = rate_gains.cwiseProduct(rates - motion.rates).cwiseQuotient(full_moment_);
    const Vector3 bounded = clamped(moments, Vector3::Constant(0.5));
    return {bounded.x(), bounded.y(), bounded.z(), targets_.thrust};
}

}  // namespace mavloom::flight
