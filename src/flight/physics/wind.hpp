// SPDX-License-Identifier: MIT
// The wind: a steady part with gusts. Private to flight; single owner; nothing allocates.
#pragma once

#include <array>

#include "flight/physics/math.hpp"
#include "flight/physics/noise.hpp"
#include "flight/plant/plant.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

class WindField {
public:
    explicit WindField(const Wind& options, std::uint64_t seed, double dt = step_s)
        : random_(seed),
          steady_(options.speed_m_s * math::cos(to_radians(options.direction_deg)),
                  options.speed_m_s * math::sin(to_radians(options.direction_deg)), 0),
          velocity_(steady_),
          gusts_{SmoothWander(options.gust_m_s, gust_time, dt), SmoothWander(options.gust_m_s, gust_time, dt),
                 SmoothWander(options.gust_m_s / 3, gust_time, dt)},
          has_gusts_(options.gust_m_s > 0) {}

    void step() {
        if (!has_gusts_) return;
        for (std::size_t axis = 0; axis < gusts_.size(); ++axis) {
            gusts_[axis].next(random_);
            velocity_[static_cast<int>(axis)] = steady_[static_cast<int>(axis)] + gusts_[axis].value();
        }
    }
    // m/s, in the direction in which the air moves.
    [[nodiscard]] const Vector3& velocity() const noexcept { return velocity_; }

private:
    static constexpr double gust_time = 2;  // s

    Random random_;
    Vector3 steady_, velocity_;
    std::array<SmoothWander, 3> gusts_;
    bool has_gusts_;
};

}  // namespace mavloom::flight
