// SPDX-License-Identifier: MIT
#include "sim/payload/gimbal_motion.hpp"

#include <algorithm>
#include <cmath>

namespace mavloom::sim {

void GimbalMotion::Axis::order(double to, double at_rate) noexcept {
    if (std::isfinite(to)) {
        target = wrap_pi(to);
        wanted_rate = 0;
    } else if (std::isfinite(at_rate)) {
        target = angle;
        wanted_rate = std::clamp(at_rate, -fastest, fastest);
    }
}

void GimbalMotion::Axis::step(double dt, double lowest, double highest) noexcept {
    constexpr double gain = 8;  // 1/s
    target = std::clamp(target + wanted_rate * dt, lowest, highest);
    rate = std::clamp(gain * wrap_pi(target - angle), -fastest, fastest);
    angle += rate * dt;
}

void GimbalMotion::aim(const GimbalAim& aim, double heading) noexcept {
    lock(aim.locks_yaw, heading);
    double yaw = aim.yaw;
    if (aim.is_yaw_from_north && !locked_) yaw -= heading;
    if (!aim.is_yaw_from_north && locked_) yaw += heading;
    pitch_.order(std::clamp(aim.pitch, pitch_lowest, pitch_highest), aim.pitch_rate);
    yaw_.order(yaw, aim.yaw_rate);
}

void GimbalMotion::center(double heading) noexcept {
    lock(false, heading);
    pitch_.order(0, 0);
    yaw_.order(0, 0);
}

void GimbalMotion::step(double dt) noexcept {
    pitch_.step(dt, pitch_lowest, pitch_highest);
    yaw_.step(dt, -2 * pi, 2 * pi);  // yaw has no stops
    yaw_.target = wrap_pi(yaw_.target);
    yaw_.angle = wrap_pi(yaw_.angle);
}

double GimbalMotion::yaw_in_vehicle(double heading) const noexcept {
    return locked_ ? wrap_pi(yaw_.angle - heading) : yaw_.angle;
}

double GimbalMotion::yaw_from_north(double heading) const noexcept {
    return locked_ ? yaw_.angle : wrap_pi(yaw_.angle + heading);
}

void GimbalMotion::lock(bool locked, double heading) noexcept {
    if (locked == locked_) return;
    locked_ = locked;
    const double turn = locked ? heading : -heading;
    yaw_.angle = wrap_pi(yaw_.angle + turn);
    yaw_.target = wrap_pi(yaw_.target + turn);
}

}  // namespace mavloom::sim
