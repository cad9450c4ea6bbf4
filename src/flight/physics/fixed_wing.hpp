// SPDX-License-Identifier: MIT
// A small plane with wheels. Private to flight; single owner; nothing allocates.
//
// Forces follow from the airflow (wing/model.hpp), but moments are not computed. Instead, the body rates follow the
// rates that the autopilot wants, with a lag, as far as the airflow gives the control surfaces authority. A stalled
// plane drops its nose, and the fin turns the plane into the wind. On the ground, a sprung gear carries the plane, and
// wheels keep it from sliding sideways.
#pragma once

#include "flight/physics/airframe.hpp"
#include "flight/physics/wing/pilot.hpp"

namespace mavloom::flight {

class FixedWing final : public Airframe {
public:
    void step(const Setpoint& setpoint, bool armed, const Surroundings& around) override;
    void place(const Vector3& position, double heading) override;

private:
    [[nodiscard]] wing::Situation look(const Surroundings& around) const;
    void move(const wing::Command& command, const wing::Situation& now, double supply);
    // The upward force of the gear, in newtons.
    [[nodiscard]] double gear_force(double height) const;
    // The velocity after wheels and brakes have acted on its horizontal part for one step.
    [[nodiscard]] Vector3 with_wheels(const Vector3& velocity, double load, bool brakes, double yaw) const;
    [[nodiscard]] Vector3 rates_in_air(const wing::Command& command, const wing::Airflow& air) const;
    [[nodiscard]] Vector3 rates_on_ground(const wing::Command& command, const wing::Situation& now) const;
    void report(const wing::Command& command, const wing::Situation& now);

    wing::Pilot pilot_;
    double motor_ = 0;  // speed, 0 to 1
};

}  // namespace mavloom::flight
