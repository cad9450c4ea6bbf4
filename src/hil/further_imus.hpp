// SPDX-License-Identifier: MIT
// The second and the third IMU of a vehicle: they feel the same motion as the first, with noise of their own, and do
// not fail. Private to hil; single owner; nothing allocates after construction.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "flight/physics/random.hpp"
#include "flight/plant/plant.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::hil {

class FurtherImus {
public:
    struct Sample {
        flight::Vector3 acceleration = flight::Vector3::Zero();  // specific force, m/s^2, body frame
        flight::Vector3 rates = flight::Vector3::Zero();         // rad/s
    };

    // `imus` with the first one.
    FurtherImus(const flight::VehicleOptions& options, unsigned imus);

    void step(const flight::Kinematics& truth);
    [[nodiscard]] std::span<const Sample> samples() const noexcept { return samples_; }

private:
    [[nodiscard]] flight::Vector3 shaken(const flight::Vector3& value, double sigma);

    std::optional<flight::NoiseOptions> noise_;
    flight::Random random_;
    std::vector<Sample> samples_;
};

}  // namespace mavloom::hil
