// SPDX-License-Identifier: MIT
// The orders that clients can give a vehicle, and its answers. Private to flight and sim; plain values. `nan` means
// "not given": the vehicle then chooses, usually its current value.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "flight/physics/geodesy.hpp"
#include "flight/pilot/pilot.hpp"

namespace mavloom::flight {

// Values of MAV_RESULT.
enum class Result : std::uint8_t {
    accepted = 0,
    temporarily_rejected = 1,
    denied = 2,
    unsupported = 3,
    failed = 4,
    in_progress = 5,
    cancelled = 6,
    command_long_only = 7,
    command_int_only = 8,
    unsupported_frame = 9,
};

// The answer to an order. A refusal has a text for people, which the vehicle has already sent as STATUSTEXT.
struct Outcome {
    Result result = Result::accepted;
    std::string text;

    [[nodiscard]] bool is_accepted() const noexcept { return result == Result::accepted; }
    Outcome() = default;
    Outcome(Result r, std::string why = {}) : result(r), text(std::move(why)) {}  // NOLINT(google-explicit-constructor)
};

// The source of an order, for texts such as "Armed by external command".
enum class OrderedBy : std::uint8_t { client, operator_console, mission, failsafe, vehicle };

struct TakeoffOrder {
    double latitude = nan, longitude = nan;  // degrees
    double altitude = nan;                   // m above mean sea level
    double yaw = nan;                        // rad
};

struct LandOrder {
    double latitude = nan, longitude = nan;
    double yaw = nan;
};

// Fly to a point and stay there.
struct RepositionOrder {
    double latitude = nan, longitude = nan;
    double altitude = nan;  // m above mean sea level
    double speed = nan;     // m/s; not positive: the default
    double radius = nan;    // m; planes; negative counter-clockwise
    double yaw = nan;       // rad
    bool may_change_mode = true;
};

// Values of ORBIT_YAW_BEHAVIOUR.
enum class OrbitYaw : std::uint8_t { to_center = 0, keep = 1, free = 2, along_path = 3, by_sticks = 4, unchanged = 5 };

struct OrbitOrder {
    double latitude = nan, longitude = nan;
    double altitude = nan;
    double radius = nan;  // m; negative counter-clockwise
    double speed = nan;   // m/s
    OrbitYaw yaw = OrbitYaw::to_center;
    double turns = 0;  // 0: until the next order
};

// Sticks in -1 to 1 (pitch forward, roll right, yaw clockwise), throttle in 0 to 1.
struct Sticks {
    double pitch = 0, roll = 0, yaw = 0, throttle = 0.5;
};

// A set-point of an external controller. `steering` decides which of the other members apply.
struct OffboardSetpoint {
    Steering steering = Steering::trajectory;  // trajectory, attitude, rates or actuators
    Vector3 position = no_vector, velocity = no_vector, acceleration = no_vector;  // vehicle's local frame
    double yaw = nan, yaw_rate = nan;
    Quaternion attitude = Quaternion::Identity();
    Vector3 rates = no_vector;
    double thrust = nan;
    std::array<double, 4> mixer{};
};

// Values of SPEED_TYPE.
enum class SpeedKind : std::uint8_t { air = 0, ground = 1, climb = 2, descent = 3 };

}  // namespace mavloom::flight
