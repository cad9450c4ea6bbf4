// SPDX-License-Identifier: MIT
// Mixer and motors of a quadrotor in X form. Private to flight; single owner; nothing allocates.
//
//      3   1      front      1 and 2 turn counter-clockwise,
//        x                   3 and 4 clockwise (PX4's order)
//      2   4
#pragma once

#include <array>
#include <cstddef>

namespace mavloom::flight {

// Moments and thrust of the rotors: moments in -1 to 1, thrust in 0 to 1.
struct Moments {
    double roll = 0, pitch = 0, yaw = 0, thrust = 0;
};

class Rotors {
public:
    static constexpr std::size_t count = 4;

    // Advances by one step. Outputs stay within 0 to 1, and the thrusts follow them with the motors' lag. If outputs
    // saturate, yaw is reduced first, then thrust.
    void step(const Moments& wanted, double lag_share) noexcept;
    void reset() noexcept { *this = {}; }

    [[nodiscard]] const std::array<double, count>& outputs() const noexcept { return outputs_; }
    // Moments and thrust after the lag.
    [[nodiscard]] const Moments& given() const noexcept { return given_; }

private:
    std::array<double, count> outputs_{}, thrusts_{};
    Moments given_;
};

}  // namespace mavloom::flight
