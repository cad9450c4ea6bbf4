// SPDX-License-Identifier: MIT
// A car-like rover on flat ground. Private to flight; single owner; nothing allocates.
//
// Speed and steering follow their wanted values with a lag and within limits of acceleration. The turn rate is the
// speed times the curvature that the front wheels set (kinematic bicycle), and the wheels do not slide.
#pragma once

#include "flight/physics/airframe.hpp"

namespace mavloom::flight {

class Rover final : public Airframe {
public:
    void step(const Setpoint& setpoint, bool armed, const Surroundings& around) override;
    void place(const Vector3& position, double heading) override;

private:
    // Orders of the driver to motor and front wheels.
    struct Demand {
        double speed = 0;      // m/s along the heading; negative: reverse
        double curvature = 0;  // 1/m, positive to the right
        double course = nan;   // rad, if a path is followed
    };
    [[nodiscard]] Demand drive(const Setpoint& setpoint) const;
    [[nodiscard]] Demand drive_along(const Setpoint& setpoint) const;
    [[nodiscard]] Demand drive_to(const Vector3& place) const;
    [[nodiscard]] Demand drive_with(const Setpoint& setpoint) const;
    [[nodiscard]] Demand drive_around(const Setpoint& setpoint) const;
    [[nodiscard]] Demand turn(double turn_rate, double speed) const;
    [[nodiscard]] Demand turn_to(double course, double turn_rate, double speed) const;
    // The greatest speed from which the rover can still stop within this distance.
    [[nodiscard]] double stopping_speed(double distance) const noexcept;
    void move(const Demand& demand, double ground);
    void report(const Demand& demand);

    SpeedLimits limits_;  // of the current set-point, bounded
    double heading_ = 0, speed_ = 0, curvature_ = 0;
};

}  // namespace mavloom::flight
