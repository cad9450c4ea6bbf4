// SPDX-License-Identifier: MIT
// What Flight reports: events, and the parts of its state. Private to flight and sim.
#pragma once

#include <cstdint>
#include <string_view>

#include "flight/plan.hpp"
#include "mavloom/flight/status.hpp"

namespace mavloom::flight {

// MAV_SEVERITY.
enum class Severity : std::uint8_t { emergency, alert, critical, error, warning, notice, info, debug };

// Events of a flight. Called during `step` and orders. Implementations must not call Flight back.
class FlightObserver {
public:
    virtual ~FlightObserver() = default;
    virtual void on_text(Severity severity, std::string_view text) = 0;
    // Armed flag, mode, system status or landed state changed: HEARTBEAT and related messages are out of date.
    virtual void on_state_changed() = 0;
    virtual void on_home_changed() = 0;
    virtual void on_mission_progress() = 0;
    virtual void on_item_reached(std::uint16_t seq) = 0;
    // The mission reached an item that does not move the vehicle: gimbal, camera, gripper, relay, actuator and others.
    virtual void on_payload_item(const PlanItem& /*item*/) {}
};

// MAV_STATE.
enum class SystemStatus : std::uint8_t {
    uninitialised = 0,
    boot = 1,
    calibrating = 2,
    standby = 3,
    active = 4,
    critical = 5,
    emergency = 6,
    powered_off = 7,
    terminated = 8,
};

// MISSION_STATE of MISSION_CURRENT.
enum class MissionState : std::uint8_t {
    unknown = 0,
    no_mission = 1,
    not_started = 2,
    active = 3,
    paused = 4,
    complete = 5
};

// The vehicle's progress in its mission.
struct MissionProgress {
    std::uint16_t current = 0;
    MissionState state = MissionState::no_mission;
};

// The point that the vehicle navigates to, for NAV_CONTROLLER_OUTPUT and POSITION_TARGET_GLOBAL_INT.
struct NavigationTarget {
    Vector3 position = no_vector;  // vehicle's local frame
    double cross_track = 0;        // m
};

struct OrbitStatus {
    GeoPoint center;
    double radius = 0;
};

// Reasons that keep the vehicle from arming, as bits.
enum Unready : std::uint32_t {
    unready_booting = 1u << 0,
    unready_position = 1u << 1,
    unready_home = 1u << 2,
    unready_battery = 1u << 3,
    unready_sensors = 1u << 4,
    unready_calibrating = 1u << 5,
    unready_mode = 1u << 6,
    unready_terminated = 1u << 7,
    unready_compass_calibrated = 1u << 8,  // and not rebooted since then; ArduPilot
    unready_accelerometer_calibrated = 1u << 9,
};

}  // namespace mavloom::flight
