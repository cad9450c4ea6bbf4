// SPDX-License-Identifier: MIT
#include "flight/navigation/offboard_control.hpp"

#include <algorithm>
#include <utility>

namespace mavloom::flight {

void OffboardControl::begin() {
    follows_ = false;
    guidance_.stop();
}

// While no set-point is fresh, the manoeuvre of an order such as a take-off continues. If the set-points end, the
// vehicle stops. If an order replaced them, they are forgotten.
void OffboardControl::update() {
    if (inputs_.offboard.is_fresh(context_.input_time(), context_.tuning.offboard_loss)) {
        follows_ = true;
        return guidance_.follow(followed(*inputs_.offboard.value()));
    }
    if (std::exchange(follows_, false) && inputs_.offboard.was_heard()) guidance_.stop();
}

Setpoint OffboardControl::followed(const OffboardSetpoint& given) const {
    const Tuning& tuning = context_.tuning;
    Setpoint setpoint{.steering = given.steering,
                      .position = given.position,
                      .velocity = given.velocity,
                      .acceleration = given.acceleration,
                      .yaw = given.yaw,
                      .yaw_rate = given.yaw_rate,
                      .attitude = given.attitude,
                      .rates = given.rates,
                      .thrust = given.thrust,
                      .mixer = given.mixer};
    const bool is_quad = context_.kind() == Kind::quad;
    if (is_quad) setpoint.thrust = std::max(setpoint.thrust, 0.0);
    setpoint.limits = {.horizontal = is_quad ? tuning.max_speed : tuning.cruise_speed,
                       .up = tuning.climb_speed,
                       .down = tuning.descent_speed,
                       .acceleration = tuning.acceleration,
                       .tilt = tuning.max_tilt,
                       .yaw_rate = 2 * tuning.max_yaw_rate,
                       .air_minimum = tuning.min_airspeed,
                       .air_maximum = std::max(tuning.max_speed, tuning.cruise_speed + 1),
                       .turn_radius = tuning.rover_turn_radius,
                       .jerk = 0};
    // ArduPilot flies to a position along a path; PX4 takes the position at once.
    const bool is_goal = !setpoint.position.array().isNaN().any() && setpoint.velocity.array().isNaN().all();
    if (!context_.firmware.is_px4() && is_goal) {
        setpoint.limits.horizontal = tuning.cruise_speed;
        setpoint.limits.jerk = 4;
    }
    return setpoint;
}

}  // namespace mavloom::flight
