// SPDX-License-Identifier: MIT
#include "flight/pilot/path.hpp"

#include <algorithm>
#include <cmath>

#include "flight/physics/math.hpp"

namespace mavloom::flight {

namespace {

// Beyond this distance the numbers of a path lose their meaning, and clients may send any number.
constexpr double farthest = 1e7;

bool is_near(double value) noexcept { return std::abs(value) < farthest; }

// The rate at which atan(offset / look_ahead) changes.
double closing_rate(double offset, double speed, double look_ahead) noexcept {
    const double ratio = offset / look_ahead;
    return speed / (look_ahead * (1 + ratio * ratio));
}

}  // namespace

bool has_horizontal(const Vector3& vector) noexcept { return is_near(vector.x()) && is_near(vector.y()); }

double finite_or(double value, double fallback, double low, double high) noexcept {
    return std::isfinite(value) ? std::clamp(value, low, high) : fallback;
}

double direction_of(const Vector3& vector, double fallback) {
    const bool is_long = math::hypot(vector.x(), vector.y()) > 0.1;
    return is_long ? math::atan2(vector.y(), vector.x()) : fallback;
}

Course course_on_line(const Kinematics& motion, const Vector3& from, const Vector3& to, double look_ahead) {
    const double north = to.x() - from.x(), east = to.y() - from.y();
    const double length = math::hypot(north, east);
    if (!has_horizontal(from) || length < 0.5)
        return {.angle = math::atan2(to.y() - motion.position.y(), to.x() - motion.position.x())};
    const auto to_the_right = [&](double x, double y) { return (north * y - east * x) / length; };
    const double offset = to_the_right(motion.position.x() - from.x(), motion.position.y() - from.y());
    const double speed = to_the_right(motion.velocity.x(), motion.velocity.y());
    return {.angle = math::atan2(east, north) - math::atan(offset / look_ahead),
            .turn_rate = -closing_rate(offset, speed, look_ahead),
            .cross_track = offset};
}

Course course_on_circle(const Kinematics& motion, const Vector3& center, double radius, double look_ahead) {
    const double north = motion.position.x() - center.x(), east = motion.position.y() - center.y();
    const double distance = math::hypot(north, east), side = radius < 0 ? -1 : 1;
    const double offset = distance - std::abs(radius);
    // Within half of the radius the true rates grow without bound; there the course alone leads outwards.
    const double floor = std::max({distance, std::abs(radius) / 2, 1.0});
    const double around = (north * motion.velocity.y() - east * motion.velocity.x()) / (floor * floor);
    const double outwards = (north * motion.velocity.x() + east * motion.velocity.y()) / floor;
    const double bearing = math::atan2(east, north);
    return {.angle = bearing + side * (pi / 2 + math::atan(offset / look_ahead)),
            .turn_rate = around + side * closing_rate(offset, outwards, look_ahead),
            .cross_track = offset};
}

}  // namespace mavloom::flight
