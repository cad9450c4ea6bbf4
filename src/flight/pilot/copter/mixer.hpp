// SPDX-License-Identifier: MIT
// The mixer of a multicopter: divides moments and thrust among its motors. Private to flight; single owner; nothing
// allocates.
//
// The factors are the pseudo-inverse of the body's geometry, scaled until the largest factor of each row is 1, as
// PX4's control allocation has them. For a quadrotor in X form every factor is 1 or -1:
//
//      3   1      front      1 and 2 turn counter-clockwise,
//        x                   3 and 4 clockwise
//      2   4
#pragma once

#include "flight/plant/plant.hpp"

namespace mavloom::flight {

// Moments and thrust: moments in -1 to 1, thrust in 0 to 1.
struct Moments {
    double roll = 0, pitch = 0, yaw = 0, thrust = 0;
};

class Mixer {
public:
    explicit Mixer(const CopterBody& body);

    // Outputs within 0 to 1. If outputs saturate, yaw is reduced first, then thrust.
    [[nodiscard]] const Outputs& mix(const Moments& wanted) noexcept;
    [[nodiscard]] const Outputs& stop() noexcept { return outputs_ = {}; }

    // Acceleration by full thrust, m/s^2.
    [[nodiscard]] double full_thrust() const noexcept { return full_thrust_; }
    // Angular acceleration by a full moment about each axis, rad/s^2.
    [[nodiscard]] const Vector3& full_moment() const noexcept { return full_moment_; }

private:
    [[nodiscard]] double output_for(double thrust) const noexcept;

    std::size_t count_;
    double curve_, idle_;
    std::array<Moments, CopterBody::max_rotors> factors_;
    double full_thrust_ = 0;
    Vector3 full_moment_;
    Outputs outputs_{};
};

}  // namespace mavloom::flight
