// SPDX-License-Identifier: MIT
// A small plane with wheels. Private to flight; single owner; nothing allocates.
//
//   m dv/dt = m g + R F - gear          F, M: forces and moments by the air (wing.hpp), with deflected controls
//   I dw/dt = M - w x I w
//
// On the ground, a sprung gear carries the plane, and wheels keep it from sliding sideways. The rudder steers the nose
// wheel. The wheels brake while the motor's output is 0.
#pragma once

#include "flight/plant/plant.hpp"
#include "flight/plant/wing.hpp"

namespace mavloom::flight {

class FixedWing final : public Plant {
public:
    explicit FixedWing(const PlaneBody& body);

    void step(const Outputs& outputs, const Surroundings& around, double dt) override;
    void place(const Vector3& position, double heading) override;
    void set_mass(double kg) override { body_.mass_kg = kg; }

private:
    // The plane at the start of a step.
    struct Now {
        wing::Airflow air;
        Euler euler;
        double height = 0;  // m above the ground
        bool brakes = false;
        Vector3 controls = Vector3::Zero();  // ailerons, elevator, rudder
    };
    void move(const Now& now, const Surroundings& around, double dt);
    // The upward force of the gear, in newtons.
    [[nodiscard]] double gear_force(double height) const;
    // The velocity after wheels and brakes have acted on its horizontal part for one step.
    [[nodiscard]] Vector3 with_wheels(const Vector3& velocity, double load, const Now& now, double dt) const;
    // Return the body rates after `dt`.
    [[nodiscard]] Vector3 turned_by_air(const Now& now, double dt) const;
    [[nodiscard]] Vector3 turned_on_wheels(const Now& now, double dt) const;

    PlaneBody body_;
    const Vector3 inertia_;
    const double cruise_speed_;  // m/s, airspeed
    double motor_ = 0;           // speed, 0 to 1
};

}  // namespace mavloom::flight
