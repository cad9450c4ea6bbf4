// SPDX-License-Identifier: MIT
// The motion of one kind of vehicle: its dynamics, with the inner control loops that follow a set-point. Private to
// flight. Single owner; nothing allocates.
//
// The owner calls `step` at a fixed rate. Positions are in metres north, east, down from the start; velocities in m/s,
// angles in radians. `nan` in a set-point means "not given".
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "flight/physics/random.hpp"
#include "flight/physics/rotation.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline const Vector3 no_vector{nan, nan, nan};
// True if an axis is given.
[[nodiscard]] inline bool has_any(const Vector3& vector) noexcept { return !vector.array().isNaN().all(); }
[[nodiscard]] inline double horizontal_length(const Vector3& vector) noexcept {
    return std::hypot(vector.x(), vector.y());
}

// Steps of a vehicle: 250 Hz.
inline constexpr Nanoseconds step_time = std::chrono::milliseconds{4};
inline constexpr double step_s = 0.004;

// True motion. `position` is exactly the sum of `velocity` times the step, and `velocity` the sum of `acceleration`
// times the step. `attitude` is exactly the integral of `rates`.
struct Kinematics {
    Vector3 position = Vector3::Zero();
    Vector3 velocity = Vector3::Zero();
    Vector3 acceleration = Vector3::Zero();  // dv/dt; 0 at rest, unlike an accelerometer
    Quaternion attitude = Quaternion::Identity();
    Vector3 rates = Vector3::Zero();  // rad/s, body frame
};

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

// Air, ground and supply around the vehicle during one step.
struct Surroundings {
    Vector3 wind = Vector3::Zero();  // m/s, in the direction in which the air moves
    double ground = 0;               // `position.z` of the ground below
    double air_density = 1.225;      // kg/m^3
    double supply = 1;               // battery voltage relative to full; scales the thrust
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

struct Actuators {
    static constexpr std::size_t count = 8;
    std::array<double, count> outputs{};  // of each channel in use: 0 to 1 for motors, -1 to 1 for servos
    std::array<bool, count> is_motor{};
    std::uint8_t used = 0;
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
class Airframe {
public:
    Airframe() = default;
    Airframe(const Airframe&) = delete;
    Airframe& operator=(const Airframe&) = delete;
    virtual ~Airframe() = default;

    // Advances by `step_s`.
    virtual void step(const Setpoint& setpoint, bool armed, const Surroundings& around) = 0;
    // Puts the vehicle at rest, usually on the ground.
    virtual void place(const Vector3& position, double heading) = 0;
    // The origin of the local frame moved: `by` is added to every position. The motion continues.
    virtual void move_origin(const Vector3& by) { motion_.position += by; }

    [[nodiscard]] const Kinematics& motion() const noexcept { return motion_; }
    [[nodiscard]] const InnerTargets& targets() const noexcept { return targets_; }
    [[nodiscard]] const Actuators& actuators() const noexcept { return actuators_; }
    [[nodiscard]] bool touches_ground() const noexcept { return touches_ground_; }
    // Thrust as a share of the maximum, 0 to 1.
    [[nodiscard]] double thrust() const noexcept { return thrust_; }
    // Electrical power that the motors draw now, relative to hover or cruise. 0 while the motors stand still.
    [[nodiscard]] double load() const noexcept { return load_; }
    // Velocity relative to the air, m/s in the local frame.
    [[nodiscard]] const Vector3& air_velocity() const noexcept { return air_velocity_; }

protected:
    // Ends a step with constant acceleration (local frame) and constant rates (body frame). No other function moves the
    // vehicle, so the rules of Kinematics hold for all kinds.
    void integrate_step(const Vector3& acceleration, const Vector3& rates);

    Kinematics motion_;
    InnerTargets targets_;
    Actuators actuators_;
    bool touches_ground_ = true;
    double thrust_ = 0, load_ = 0;
    Vector3 air_velocity_ = Vector3::Zero();
};

[[nodiscard]] std::unique_ptr<Airframe> make_airframe(Kind kind);

}  // namespace mavloom::flight
