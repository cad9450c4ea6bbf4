// SPDX-License-Identifier: MIT
#include "flight/navigation/random_pilot.hpp"

namespace mavloom::flight {

namespace {

constexpr double whim_speed = 8, whim_climb = 2;        // m/s
constexpr double wide = 200, tall = 30;                 // m; from here on, the way leads back
constexpr double max_updates = 500, min_updates = 100;  // between two changes

}  // namespace

Setpoint RandomPilot::steer(const Vector3& home, const Vector3& position) {
    if (updates_left_ == 0) {
        updates_left_ = static_cast<unsigned>(random_.uniform(min_updates, max_updates));
        const Vector3 away = (position - home + Vector3(0, 0, height)).cwiseQuotient(Vector3(wide, wide, tall));
        const Vector3 whim(random_.uniform(-1, 1), random_.uniform(-1, 1), random_.uniform(-1, 1));
        velocity_ = (whim - away).cwiseProduct(Vector3(whim_speed, whim_speed, whim_climb));
        yaw_ = random_.uniform(-pi, pi);
    }
    --updates_left_;
    Setpoint setpoint{.steering = Steering::trajectory, .velocity = velocity_, .yaw = yaw_};
    setpoint.limits.horizontal = whim_speed;
    setpoint.limits.up = setpoint.limits.down = whim_climb;
    return setpoint;
}

}  // namespace mavloom::flight
