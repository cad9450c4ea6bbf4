// SPDX-License-Identifier: MIT
// The control loops of a multicopter: position, velocity, attitude, rates. Private to flight; single owner; nothing
// allocates. The structure and most gains are PX4's (PX4 user guide, "Multicopter Control Architecture").
#pragma once

#include "flight/physics/multicopter/rotors.hpp"
#include "flight/physics/multicopter/trajectory.hpp"

namespace mavloom::flight {

// Acceleration by full thrust: the vehicle hovers at half thrust.
inline constexpr double full_thrust = 2 * gravity;  // m/s^2
// Angular acceleration by a full moment about each axis, rad/s^2.
inline const Vector3 full_moment{120, 120, 20};

class Controller {
public:
    // Forgets what the loops have learned about wind and battery.
    void reset() { learned_ = Vector3::Zero(); }
    // The vehicle leaves the ground at `thrust`; the loops start from that thrust.
    void lift_off(double thrust) { learned_ = {0, 0, gravity - thrust * full_thrust}; }

    // Each returns the moments and thrust for this step of the rotors.
    [[nodiscard]] Moments follow(const MotionTarget& target, const Setpoint& setpoint, const Kinematics& motion);
    [[nodiscard]] Moments hold(const Quaternion& attitude, double yaw_rate, double thrust, const Kinematics& motion);
    [[nodiscard]] Moments turn(const Vector3& rates, double thrust, const Kinematics& motion);

    [[nodiscard]] const InnerTargets& targets() const noexcept { return targets_; }
    [[nodiscard]] InnerTargets& targets() noexcept { return targets_; }

private:
    [[nodiscard]] Vector3 wanted_velocity(const MotionTarget& target, const SpeedLimits& limits,
                                          const Kinematics& motion) const;
    [[nodiscard]] Vector3 wanted_acceleration(const MotionTarget& target, const Vector3& velocity,
                                              const Kinematics& motion);

    Vector3 learned_ = Vector3::Zero();  // m/s^2 that the loops add against wind and a weak battery
    InnerTargets targets_;
};

}  // namespace mavloom::flight
