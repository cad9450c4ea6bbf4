// SPDX-License-Identifier: MIT
// A small quadrotor: a rigid body with drag, legs, and four motors that lag. Private to flight;
// single owner; nothing allocates. Forces and moments are per mass and per moment of inertia.
#pragma once

#include "flight/physics/multicopter/controller.hpp"

namespace mavloom::flight {

class Multicopter final : public Airframe {
public:
    void step(const Setpoint& setpoint, bool armed, const Surroundings& around) override;
    void place(const Vector3& position, double heading) override;
    void move_origin(const Vector3& by) override;

private:
    [[nodiscard]] Moments control(const Setpoint& setpoint);
    [[nodiscard]] Moments control_path(const Setpoint& setpoint);
    [[nodiscard]] Moments control_on_ground(const Setpoint& setpoint);
    void move(const Surroundings& around);
    // Return the acceleration including the push of the legs, and the body rates that remain after that push.
    [[nodiscard]] Vector3 legs(double push, double depth, const Vector3& acceleration) const;
    [[nodiscard]] Vector3 rates_after(double push) const;
    void report(double supply);

    Trajectory trajectory_;
    Controller controller_;
    Rotors rotors_;
    Steering steering_ = Steering::none;
    double ground_thrust_ = 0;  // share of the full thrust, while the ground carries the vehicle
};

}  // namespace mavloom::flight
