// SPDX-License-Identifier: MIT
// The control loops that make a plant follow a set-point. Private to flight. Single owner; nothing allocates.
//
// A pilot reads the true motion of its plant, and returns outputs for motors and servos. A foreign autopilot that
// brings outputs of its own takes its place: see Craft. `nan` in a set-point means "not given".
#pragma once

#include "flight/plant/plant.hpp"

namespace mavloom::flight {

// How the vehicle reaches or holds its goal.
enum class Steering : std::uint8_t {
    none,        // motors at rest, or idle if armed
    trajectory,  // position, velocity and acceleration; each axis may be left out
    waypoint,    // along the line from `from` to `position`
    circle,      // around `position` with `radius`
    attitude,    // attitude and thrust
    rates,       // body rates and thrust
    actuators,   // roll, pitch, yaw and thrust of the mixer, directly
};

// True if the vehicle steers itself to positions, velocities or accelerations.
[[nodiscard]] constexpr bool steers_by_path(Steering steering) noexcept {
    return steering == Steering::trajectory || steering == Steering::waypoint || steering == Steering::circle;
}

struct SpeedLimits {
    double horizontal = 5, up = 3, down = 1.5;  // m/s; for planes `horizontal` is the airspeed to hold
    double acceleration = 3;                    // m/s^2, horizontal; for rovers along the track
    double tilt = to_radians(45);               // rad; tilt of multicopters, bank of planes
    double yaw_rate = to_radians(60);           // rad/s
    double air_minimum = 12, air_maximum = 25;  // m/s, airspeed; planes
    double turn_radius = 1.5;                   // m, smallest; rovers
    double jerk = 4;                            // m/s^3; multicopters; 0: follow the set-point itself, without a ramp
};

struct Setpoint {
    Steering steering = Steering::none;
    Vector3 position = no_vector, velocity = no_vector, acceleration = no_vector;
    double yaw = nan, yaw_rate = nan;
    Vector3 from = no_vector;  // start of a leg
    double radius = 0;         // of a circle; positive clockwise
    Quaternion attitude = Quaternion::Identity();
    Vector3 rates = no_vector;
    double thrust = nan;            // 0 to 1; rovers: -1 (full reverse) to 1
    std::array<double, 4> mixer{};  // roll, pitch, yaw -1 to 1; thrust as above
    bool touch_down = false;        // keep descending until the ground carries the vehicle
    SpeedLimits limits{};
};

// Targets of the inner loops, for ATTITUDE_TARGET and POSITION_TARGET_LOCAL_NED. `nan`: not controlled.
struct InnerTargets {
    Quaternion attitude = Quaternion::Identity();
    Vector3 rates = Vector3::Zero();
    double thrust = 0;
    Vector3 velocity = Vector3::Zero(), acceleration = Vector3::Zero();
    Vector3 position = no_vector;  // the point on the way to the goal where the vehicle should be now
    double yaw = nan, yaw_rate = nan;
};

// How the kinds of vehicles read a Setpoint, beyond what its comments state:
//
// Plane, in trajectory, waypoint and circle:
// - On the ground, an armed plane with a target above the ground starts a take-off run: full throttle along the current
//   heading until the wings carry. It then climbs at `limits.up`, with little bank near the ground. Without such a
//   target, it brakes.
// - `touch_down`: the plane descends along the leg to `position` (or by `limits.down` in a circle or trajectory),
//   flares, rolls out and stops.
// - trajectory with a horizontal position: the plane flies there and circles around it with `radius` (0: 50 m).
//   With a horizontal velocity: its direction is the course, its length the ground speed. With `yaw`: a course only.
//   With `yaw_rate`: a turn. With none of these: wings level. Without altitude and climb rate: the altitude is held.
// - attitude ignores yaw: the plane coordinates its turns.
//
// Rover:
// - trajectory with a horizontal position: it drives there and stops. With a velocity: it turns to that course and
//   drives. With velocity and `yaw` or `yaw_rate`: that heading or turn; the velocity's share along the heading is the
//   speed, and may be negative.
// - waypoint: it stops at `position` unless the next leg comes first.
class Pilot {
public:
    Pilot() = default;
    Pilot(const Pilot&) = delete;
    Pilot& operator=(const Pilot&) = delete;
    virtual ~Pilot() = default;

    // Returns the outputs for the plant's next step. Call it once before each step of `step_s`.
    [[nodiscard]] virtual const Outputs& step(const Setpoint& setpoint, bool armed, const Plant& plant,
                                              const Surroundings& around) = 0;
    // Forgets what it learned: the plant was placed anew.
    virtual void start(const Kinematics& motion) = 0;
    // Like Plant::move_origin.
    virtual void move_origin(const Vector3& /*by*/) {}

    [[nodiscard]] const InnerTargets& targets() const noexcept { return targets_; }

protected:
    InnerTargets targets_;
    Outputs outputs_{};
};

[[nodiscard]] std::unique_ptr<Pilot> make_pilot(Kind kind, const Body& body);

}  // namespace mavloom::flight
