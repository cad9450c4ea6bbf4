// SPDX-License-Identifier: MIT
// A multicopter: a rigid body with rotors, drag and legs. Private to flight; single owner; nothing allocates.
//
//   m dv/dt = m g + R (0, 0, -sum T) - drag          T: thrust of each rotor, R: body to local frame
//   I dw/dt = sum (r x T) + sum turn k T - w x I w   k: moment ratio; turn: +1 for counter-clockwise rotors
//
// Source: Beard and McLain, "Small Unmanned Aircraft" (2012), chapter 3; Mahony, Kumar and Corke, "Multirotor Aerial
// Vehicles" (2012). The battery's voltage scales all thrusts.
#pragma once

#include "flight/plant/plant.hpp"

namespace mavloom::flight {

class Multicopter final : public Plant {
public:
    explicit Multicopter(const CopterBody& body);

    void step(const Outputs& outputs, const Surroundings& around, double dt) override;
    void place(const Vector3& position, double heading) override;
    void set_mass(double kg) override { body_.mass_kg = kg; }

private:
    void spin(const Outputs& outputs, double dt);
    [[nodiscard]] double speed_for(double output) const noexcept;
    [[nodiscard]] double thrust_at(double speed) const noexcept;
    [[nodiscard]] Vector3 acceleration(const Surroundings& around) const;
    [[nodiscard]] Vector3 air_drag(double relative_density) const;
    [[nodiscard]] Vector3 rotor_drag() const;
    [[nodiscard]] Vector3 moment(double supply) const;
    [[nodiscard]] Vector3 turned(const Vector3& moment, double dt) const;
    // Return the acceleration including the push of the legs, and the body rates that remain after that push.
    [[nodiscard]] Vector3 legs(double push, double depth, const Vector3& acceleration, bool may_rest, double dt) const;
    [[nodiscard]] Vector3 rates_after() const;
    void report(double supply);

    CopterBody body_;
    const Vector3 inertia_;
    std::array<double, CopterBody::max_rotors> speeds_{}, thrusts_{};  // share of the full speed; N
    double total_ = 0;                                                 // N, of all rotors with a full battery
    double dt_ = 0, up_share_ = 0, down_share_ = 0;                    // how far the motors follow in a step of `dt_`
};

}  // namespace mavloom::flight
