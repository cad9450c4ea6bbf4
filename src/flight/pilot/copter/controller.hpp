// SPDX-License-Identifier: MIT
// The control loops of a multicopter: position, velocity, attitude, rates. Private to flight; single owner; nothing
// allocates. The structure and most gains are PX4's (PX4 user guide, "Multicopter Control Architecture").
#pragma once

#include "flight/pilot/copter/mixer.hpp"
#include "flight/pilot/copter/trajectory.hpp"

namespace mavloom::flight {

class Controller {
public:
    explicit Controller(const Mixer& mixer) : full_thrust_(mixer.full_thrust()), full_moment_(mixer.full_moment()) {}

    // Forgets what the loops have learned about wind and battery.
    void reset() { learned_ = Vector3::Zero(); }
    // The vehicle leaves the ground at `thrust`; the loops start from that thrust.
    void lift_off(double thrust) { learned_ = {0, 0, gravity - thrust * full_thrust_}; }

    // Each returns the moments and thrust for this step of the rotors.
    [[nodiscard]] Moments follow(const MotionTarget& target, const Setpoint& setpoint, const Kinematics& motion);
    [[nodiscard]] Moments hold(const Quaternion& attitude, double yaw_rate, double thrust, const Kinematics& motion);
    [[nodiscard]] Moments turn(const Vector3& rates, double thrust, const Kinematics& motion);

    [[nodiscard]] const InnerTargets& targets() const noexcept { return targets_; }
    [[nodiscard]] InnerTargets& targets() noexcept { return targets_; }

private:
    [[nodiscard]] Vector3 force_for(const Vector3& acceleration, double tilt) const;
    [[nodiscard]] Vector3 wanted_velocity(const MotionTarget& target, const SpeedLimits& limits,
                                          const Kinematics& motion) const;
    [[nodiscard]] Vector3 wanted_acceleration(const MotionTarget& target, const Vector3& velocity,
                                              const Kinematics& motion);

    const double full_thrust_;           // m/s^2
    const Vector3 full_moment_;          // rad/s^2
    Vector3 learned_ = Vector3::Zero();  // m/s^2 that the loops add against wind and a weak battery
    InnerTargets targets_;
};

}  // namespace mavloom::flight
