// SPDX-License-Identifier: MIT
// The path that a multicopter's position controller follows. It leads to the goal of a set-point within limits of
// speed, acceleration and jerk, as PX4's does. Private to flight; single owner; nothing allocates.
#pragma once

#include "flight/pilot/pilot.hpp"

namespace mavloom::flight {

// Where the vehicle should be now, and how it should move there. `nan`: not controlled.
struct MotionTarget {
    Vector3 position = no_vector, velocity = no_vector;
    Vector3 acceleration = Vector3::Zero();
    double yaw = 0, yaw_rate = 0;
};

class Trajectory {
public:
    // Continues from a state of motion.
    void start(const Kinematics& motion);
    // Advances by `step_s` towards the goal of a set-point that steers by trajectory, waypoint or circle. If the
    // vehicle cannot follow, the path waits for it. With `limits.jerk` 0, the set-point itself is the target.
    void step(const Setpoint& setpoint, const Kinematics& motion);
    void move_origin(const Vector3& by) { target_.position += by; }

    [[nodiscard]] const MotionTarget& target() const noexcept { return target_; }

private:
    using Vector2 = Eigen::Vector2d;
    struct Demand {
        Vector2 velocity = Vector2::Zero(), acceleration = Vector2::Zero();
    };

    void follow_directly(const Setpoint& setpoint);
    void resume(const Kinematics& motion);
    void step_horizontal(const Setpoint& setpoint);
    void step_vertical(const Setpoint& setpoint);
    void step_yaw(const Setpoint& setpoint);
    void wait_for(const Vector3& vehicle);
    [[nodiscard]] Demand horizontal_demand(const Setpoint& setpoint) const;
    [[nodiscard]] Demand circle_demand(const Setpoint& setpoint) const;
    [[nodiscard]] double vertical_demand(const Setpoint& setpoint) const;

    MotionTarget target_;
};

}  // namespace mavloom::flight
