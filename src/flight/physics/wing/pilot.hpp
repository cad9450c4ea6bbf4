// SPDX-License-Identifier: MIT
// The autopilot of a plane: converts a set-point to an attitude and a throttle. Private to flight; single owner;
// nothing allocates.
//
// Altitude and airspeed share one budget of energy: the throttle provides the energy that climb and acceleration need,
// and pitch divides it between them. When the airspeed is too low, speed comes first. Source of the idea: PX4 user
// guide, "Fixed-wing altitude/airspeed controller".
#pragma once

#include <optional>

#include "flight/physics/airframe.hpp"
#include "flight/physics/path.hpp"
#include "flight/physics/wing/model.hpp"

namespace mavloom::flight::wing {

// Everything that the pilot knows about the plane.
struct Situation {
    const Kinematics& motion;
    Euler euler;
    Airflow air;
    double height = 0;  // m above the ground
    bool on_ground = false;
    double density = 1.225;  // kg/m^3
};

struct Command {
    double roll = 0, pitch = 0;       // rad, wanted
    Vector3 rates = Vector3::Zero();  // rad/s, body frame, wanted
    double throttle = 0;              // motor speed, 0 to 1
    bool brakes = false;
    double course = nan, climb = nan;  // wanted, while a path is followed
};

class Pilot {
public:
    [[nodiscard]] Command step(const Setpoint& setpoint, bool armed, const Situation& now);
    void reset() noexcept { *this = {}; }

private:
    [[nodiscard]] Command navigate(const Setpoint& setpoint, const Situation& now);
    [[nodiscard]] Command roll_on_ground(const Setpoint& setpoint, const Situation& now);
    [[nodiscard]] double climb_towards(const Setpoint& setpoint, const SpeedLimits& limits, const Situation& now);

    std::optional<double> held_altitude_;  // m above the local origin
    std::optional<double> run_heading_;    // rad, of the take-off run or the roll-out
    double climb_ = 0;                     // m/s, wanted, without jumps
};

}  // namespace mavloom::flight::wing
