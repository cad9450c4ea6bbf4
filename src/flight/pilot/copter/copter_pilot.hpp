// SPDX-License-Identifier: MIT
// The pilot of a multicopter. It plans a path, follows it with PX4's cascade of controllers, and mixes. Private to
// flight; single owner; nothing allocates.
#pragma once

#include "flight/pilot/copter/controller.hpp"
#include "flight/pilot/pilot.hpp"

namespace mavloom::flight {

class CopterPilot final : public Pilot {
public:
    explicit CopterPilot(const CopterBody& body) : mixer_(body), controller_(mixer_) {}

    const Outputs& step(const Setpoint& setpoint, bool armed, const Plant& plant, const Surroundings& around) override;
    void start(const Kinematics& motion) override;
    void move_origin(const Vector3& by) override { trajectory_.move_origin(by); }

private:
    [[nodiscard]] Moments control(const Setpoint& setpoint, const Plant& plant);
    [[nodiscard]] Moments control_path(const Setpoint& setpoint, const Plant& plant);
    [[nodiscard]] Moments control_on_ground(const Setpoint& setpoint, const Kinematics& motion);

    Mixer mixer_;
    Trajectory trajectory_;
    Controller controller_;
    Steering steering_ = Steering::none;
    double ground_thrust_ = 0;  // share of the full thrust, while the ground carries the vehicle
};

}  // namespace mavloom::flight
