// SPDX-License-Identifier: MIT
// Steers a vehicle at random around its home, for telemetry without flights (`motion=random`). Private to flight;
// single owner; nothing allocates. The vehicle follows by its own dynamics, so that all its values agree.
#pragma once

#include "flight/context.hpp"

namespace mavloom::flight {

class RandomPilot {
public:
    static constexpr double height = 50;  // m above the ground, where the vehicle begins

    explicit RandomPilot(std::uint64_t seed) : random_(seed ^ 0x70696c6f74u) {}

    // 50 times a second. `home` is the middle of the motion.
    [[nodiscard]] Setpoint steer(const Vector3& home, const Vector3& position);

private:
    Random random_;
    Vector3 velocity_ = Vector3::Zero();
    double yaw_ = 0;
    unsigned updates_left_ = 0;  // until it changes its mind
};

}  // namespace mavloom::flight
