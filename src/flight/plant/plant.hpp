// SPDX-License-Identifier: MIT
// The body of a vehicle: forces, moments, motion. A plant makes no decisions: a pilot (flight/pilot/pilot.hpp) or a
// foreign autopilot sets the outputs for its motors and servos. Private to flight. Single owner; nothing allocates.
//
// Positions are in metres north, east, down from the start; velocities in m/s, angles in radians.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "flight/physics/math.hpp"
#include "flight/physics/rotation.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

// In vectors and set-points: "not given".
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline const Vector3 no_vector{nan, nan, nan};
// True if an axis is given.
[[nodiscard]] inline bool has_any(const Vector3& vector) noexcept { return !vector.array().isNaN().all(); }
[[nodiscard]] inline double horizontal_length(const Vector3& vector) noexcept {
    return math::hypot(vector.x(), vector.y());
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

// An accelerometer measures it: m/s^2, body frame.
[[nodiscard]] inline Vector3 specific_force(const Kinematics& truth) {
    return truth.attitude.conjugate() * (truth.acceleration - Vector3(0, 0, gravity));
}

// Air, ground and supply around the vehicle during one step.
struct Surroundings {
    Vector3 wind = Vector3::Zero();          // m/s, in the direction in which the air moves
    double ground = 0;                       // `position.z` of the ground below
    double air_density = sea_level_density;  // kg/m^3
    double supply = 1;                       // battery voltage relative to full; scales the thrust
    // Pushes and turns the vehicle from outside: m/s^2 in the local frame, rad/s^2 in the body frame. A rover's wheels
    // hold it sideways, and against turns.
    Vector3 push = Vector3::Zero(), turn = Vector3::Zero();

    // Whether the push may move a vehicle that rests on the ground.
    [[nodiscard]] bool lift() const noexcept { return push.z() < 0; }
};

// The commands to motors and servos, by channel: 0 to 1 for motors, -1 to 1 for servos and motors that can reverse.
inline constexpr std::size_t max_outputs = 16;  // as HIL_ACTUATOR_CONTROLS has
using Outputs = std::array<double, max_outputs>;
// The channels that a plant has.
struct Channels {
    std::array<bool, max_outputs> is_motor{};
    std::uint8_t used = 0;
};

// Return an output within its range. NaN counts as 0.
[[nodiscard]] inline double motor_output(double value) noexcept { return value > 0 ? std::fmin(value, 1) : 0; }
[[nodiscard]] inline double servo_output(double value) noexcept {
    return std::isnan(value) ? 0 : std::fmax(-1, std::fmin(value, 1));
}

// The channels of each kind:
//   multicopter   its motors, in PX4's order
//   plane         aileron (positive rolls right), elevator (positive: nose up), motor, rudder (positive: nose right)
//   rover         drive (negative: reverse), steering (positive: right)
class Plant {
public:
    Plant() = default;
    Plant(const Plant&) = delete;
    Plant& operator=(const Plant&) = delete;
    virtual ~Plant() = default;

    // Advances by `dt` seconds, at most 0.01. Outputs beyond their range count as its limits.
    virtual void step(const Outputs& outputs, const Surroundings& around, double dt) = 0;
    // Puts the vehicle at rest, usually on the ground.
    virtual void place(const Vector3& position, double heading) = 0;
    // The load changed. The inertia stays.
    virtual void set_mass(double kg) = 0;
    // The origin of the local frame moved: `by` is added to every position. The motion continues.
    void move_origin(const Vector3& by) { motion_.position += by; }

    [[nodiscard]] const Kinematics& motion() const noexcept { return motion_; }
    // False if forces beyond all measure have made the motion NaN, infinite, or as fast as no vehicle: `place` is the
    // only way out.
    [[nodiscard]] bool is_finite() const;
    [[nodiscard]] const Channels& channels() const noexcept { return channels_; }
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
    void integrate_step(const Vector3& acceleration, const Vector3& rates, double dt);
    // The vehicle stands still at a place.
    void rest_at(const Vector3& position, double heading);

    Kinematics motion_;
    Channels channels_;
    bool touches_ground_ = true;
    double thrust_ = 0, load_ = 0;
    Vector3 air_velocity_ = Vector3::Zero();
};

[[nodiscard]] std::unique_ptr<Plant> make_plant(Kind kind, const Body& body);

}  // namespace mavloom::flight
