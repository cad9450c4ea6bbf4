// SPDX-License-Identifier: MIT
// Guidance along lines and circles: the course that brings a vehicle onto a path and keeps it there. Private to flight;
// pure functions. Source: Beard and McLain, "Small Unmanned Aircraft" (2012), chapter 10, vector fields.
#pragma once

#include "flight/pilot/pilot.hpp"

namespace mavloom::flight {

struct Course {
    double angle = 0;        // rad, the direction to move in
    double turn_rate = 0;    // rad/s, positive clockwise: the turn of the path itself at the current velocity
    double cross_track = 0;  // m; positive: right of the line, or outside of the circle
};

// The vehicle joins the path at an angle of 45 degrees when it is `look_ahead` metres off.
//
// Returns the course along the line from `from` to `to`, and beyond. If `from` is not given or equals `to`, the course
// leads straight to `to`.
[[nodiscard]] Course course_on_line(const Kinematics& motion, const Vector3& from, const Vector3& to, double look_ahead);
// `radius` in metres, positive clockwise.
[[nodiscard]] Course course_on_circle(const Kinematics& motion, const Vector3& center, double radius, double look_ahead);

// The direction of a horizontal vector; `fallback` if it is shorter than 0.1.
[[nodiscard]] double direction_of(const Vector3& vector, double fallback);
// True if north and east are given.
[[nodiscard]] bool has_horizontal(const Vector3& vector) noexcept;
// `value` within limits; `fallback` if it is not finite.
[[nodiscard]] double finite_or(double value, double fallback, double low, double high) noexcept;

}  // namespace mavloom::flight
