// SPDX-License-Identifier: MIT
// Steers a vehicle at random around its home, for telemetry without flights (`motion=random`). Private to flight;
// single owner; nothing allocates. The vehicle follows with its own dynamics, so all its values agree with each other.
#pragma once

#include "flight/context.hpp"

namespace mavloom::flight {

class RandomPilot {
public:
    static constexpr double height = 50;  // m above the ground, where the vehicle begins

    explicit RandomPilot(std::uint64_t seed) : random_(seed ^ 0x70696c6f74u) {}

    // Call it 50 times a second. The vehicle stays around `home`.
    [[nodiscard]] Setpoint steer(const Vector3& home, const Vector3& position);

private:
    Random random_;
    Vector3 velocity_ = Vector3::Zero();
    double yaw_ = 0;
    unsigned updates_left_ = 0;  // until it picks another velocity and yaw
};

}  // namespace mavloom::flight
