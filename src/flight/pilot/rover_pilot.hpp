// SPDX-License-Identifier: MIT
// The pilot of a rover: converts a set-point to a speed and a curvature, and these to drive and steering. Private to
// flight; single owner; nothing allocates.
//
// Speed follows its wanted value with a lag and within a limit of acceleration.
#pragma once

#include "flight/pilot/pilot.hpp"

namespace mavloom::flight {

class RoverPilot final : public Pilot {
public:
    explicit RoverPilot(const RoverBody& body) : body_(body) {}

    const Outputs& step(const Setpoint& setpoint, bool armed, const Plant& plant, const Surroundings& around) override;
    void start(const Kinematics& motion) override;

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
    [[nodiscard]] Outputs outputs_for(const Demand& demand, double supply) const;
    void report(const Demand& demand);

    [[nodiscard]] SpeedLimits bounded(const SpeedLimits& given) const noexcept;

    const RoverBody body_;
    SpeedLimits limits_;  // of the current set-point, bounded
    // Of the rover at this step: place, heading (rad) and speed along it (m/s).
    Kinematics motion_;
    double heading_ = 0, speed_ = 0;
};

}  // namespace mavloom::flight
