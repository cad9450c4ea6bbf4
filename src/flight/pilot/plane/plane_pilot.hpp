// SPDX-License-Identifier: MIT
// The pilot of a plane: converts a set-point to an attitude, a throttle and deflections. Private to flight; single
// owner; nothing allocates.
//
// Altitude and airspeed share one budget of energy: the throttle provides the energy that climb and acceleration need,
// and pitch divides it between them. When the airspeed is too low, speed comes first. Source of the idea: PX4 user
// guide, "Fixed-wing altitude/airspeed controller". The deflections follow from the wanted body rates by the plane's
// own aerodynamics (plant/wing.hpp).
#pragma once

#include <optional>

#include "flight/pilot/path.hpp"
#include "flight/pilot/pilot.hpp"
#include "flight/plant/wing.hpp"

namespace mavloom::flight::wing {

// Everything that the pilot knows about the plane.
struct Situation {
    const PlaneBody& body;
    const Kinematics& motion;
    Euler euler;
    Airflow air;
    double height = 0;  // m above the ground
    bool on_ground = false;
    double density = sea_level_density;  // kg/m^3
};

struct Command {
    double roll = 0, pitch = 0;        // rad, wanted
    Vector3 rates = Vector3::Zero();   // rad/s, body frame, wanted
    double throttle = 0;               // motor speed, 0 to 1
    double course = nan, climb = nan;  // wanted, while a path is followed
};

class PlanePilot final : public Pilot {
public:
    explicit PlanePilot(const PlaneBody& body);

    const Outputs& step(const Setpoint& setpoint, bool armed, const Plant& plant, const Surroundings& around) override;
    void start(const Kinematics& motion) override;

private:
    [[nodiscard]] Command command_for(const Setpoint& setpoint, bool armed, const Situation& now);
    [[nodiscard]] Command navigate(const Setpoint& setpoint, const Situation& now);
    [[nodiscard]] Command roll_on_ground(const Setpoint& setpoint, const Situation& now);
    [[nodiscard]] double climb_towards(const Setpoint& setpoint, const SpeedLimits& limits, const Situation& now);
    void forget() noexcept;
    [[nodiscard]] SpeedLimits bounded(const SpeedLimits& given) const noexcept;
    void report(const Command& command, const Situation& now);

    const PlaneBody body_;
    const double speed_scale_;             // of its airspeeds, to those of the standard plane
    std::optional<double> held_altitude_;  // m above the local origin
    std::optional<double> run_heading_;    // rad, of the take-off run or the roll-out
    double climb_ = 0;                     // m/s, wanted, without jumps
};

}  // namespace mavloom::flight::wing
