// SPDX-License-Identifier: MIT
#include "flight/pilot/copter/copter_pilot.hpp"

#include <algorithm>
#include <cmath>

#include "flight/pilot/copter/plain_setpoint.hpp"

namespace mavloom::flight {

namespace {

constexpr double ramp_up = 3, ramp_down = 1;  // s from no thrust to full thrust, and back; MPC_TKO_RAMP_T

// True if the set-point leads away from the ground.
bool leads_up(const Setpoint& setpoint, double z) noexcept {
    if (std::isfinite(setpoint.position.z())) return setpoint.position.z() < z - 0.15;
    if (std::isfinite(setpoint.velocity.z())) return setpoint.velocity.z() < -0.1;
    return setpoint.acceleration.z() < -0.5;
}

}  // namespace

void CopterPilot::start(const Kinematics& motion) {
    controller_.reset();
    trajectory_.start(motion);
    targets_ = {.attitude = motion.attitude};
    ground_thrust_ = 0;
}

const Outputs& CopterPilot::step(const Setpoint& setpoint, bool armed, const Plant& plant, const Surroundings& around) {
    const bool has_power = armed && around.supply > 0;
    const Outputs& outputs = has_power ? mixer_.mix(control(is_plain(setpoint) ? setpoint : made_plain(setpoint), plant))
                                       : mixer_.stop();
    if (!has_power) ground_thrust_ = 0;
    steering_ = setpoint.steering;
    targets_ = controller_.targets();
    return outputs;
}

Moments CopterPilot::control(const Setpoint& setpoint, const Plant& plant) {
    const Kinematics& motion = plant.motion();
    controller_.targets() = {.attitude = motion.attitude};
    if (steers_by_path(setpoint.steering))
        return plant.touches_ground() ? control_on_ground(setpoint, motion) : control_path(setpoint, plant);
    ground_thrust_ = plant.thrust();
    controller_.reset();
    const double thrust = std::isfinite(setpoint.thrust) ? setpoint.thrust : 0;
    switch (setpoint.steering) {
        case Steering::attitude:
            return controller_.hold(setpoint.attitude, std::isfinite(setpoint.yaw_rate) ? setpoint.yaw_rate : 0, thrust,
                                    motion);
        case Steering::rates: return controller_.turn(setpoint.rates, thrust, motion);
        case Steering::actuators:
            return {setpoint.mixer[0] / 2, setpoint.mixer[1] / 2, setpoint.mixer[2] / 2, setpoint.mixer[3]};
        default: return {};
    }
}

Moments CopterPilot::control_path(const Setpoint& setpoint, const Plant& plant) {
    if (!steers_by_path(steering_)) trajectory_.start(plant.motion());
    ground_thrust_ = plant.thrust();
    trajectory_.step(setpoint, plant.motion());
    return controller_.follow(trajectory_.target(), setpoint, plant.motion());
}

// The thrust rises slowly until the vehicle lifts, and falls when it shall stay.
Moments CopterPilot::control_on_ground(const Setpoint& setpoint, const Kinematics& motion) {
    const bool lifts = !setpoint.touch_down && leads_up(setpoint, motion.position.z());
    ground_thrust_ = std::clamp(ground_thrust_ + (lifts ? step_s / ramp_up : -step_s / ramp_down), 0.0, 0.9);
    trajectory_.start(motion);
    controller_.lift_off(ground_thrust_);
    const Quaternion level = to_quaternion({0, 0, trajectory_.target().yaw});
    return controller_.hold(level, 0, ground_thrust_, motion);
}

}  // namespace mavloom::flight
