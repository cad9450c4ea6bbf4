// SPDX-License-Identifier: MIT
#include "flight/physics/multicopter/rotors.hpp"

#include <algorithm>

namespace mavloom::flight {

namespace {

// Signs with which each motor's thrust turns the vehicle: to the right, nose up, clockwise.
constexpr std::array<double, Rotors::count> rolls{-1, 1, 1, -1}, pitches{1, -1, 1, -1}, yaws{1, 1, -1, -1};
constexpr double max_yaw = 0.15;  // share of the outputs that yaw may take

}  // namespace

void Rotors::step(const Moments& wanted, double lag_share) noexcept {
    const double yaw = std::clamp(wanted.yaw, -max_yaw, max_yaw);
    for (std::size_t i = 0; i < count; ++i)
        outputs_[i] = wanted.thrust + rolls[i] * wanted.roll + pitches[i] * wanted.pitch + yaws[i] * yaw;
    const double shift = std::min(1 - std::ranges::max(outputs_), 0.0);
    given_ = {};
    for (std::size_t i = 0; i < count; ++i) {
        outputs_[i] = std::clamp(outputs_[i] + shift, 0.0, 1.0);
        thrusts_[i] += (outputs_[i] - thrusts_[i]) * lag_share;
        given_.thrust += thrusts_[i] / count;
        given_.roll += rolls[i] * thrusts_[i] / count;
        given_.pitch += pitches[i] * thrusts_[i] / count;
        given_.yaw += yaws[i] * thrusts_[i] / count;
    }
}

}  // namespace mavloom::flight
