// SPDX-License-Identifier: MIT
// The flying half of a vehicle: it moves, and it obeys or refuses orders. Private to flight and sim.
//
// Flight knows no MAVLink messages, links or clients. Services translate messages into its orders, and telemetry reads
// its state. It reports what happens to a FlightObserver. The owner steps it at 250 Hz. Single owner thread; `step`
// allocates nothing unless something is announced.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "flight/mode.hpp"
#include "flight/orders.hpp"
#include "flight/physics/battery.hpp"
#include "flight/physics/sensors.hpp"
#include "flight/plan.hpp"
#include "flight/tuning.hpp"
#include "mavloom/flight/options.hpp"
#include "mavloom/flight/status.hpp"

namespace mavloom::flight {

class Firmware;
class Parameters;

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
};

class Flight {
public:
    // `firmware`, `parameters` and `observer` must outlive the object. The vehicle stands at its home, disarmed.
    Flight(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
           FlightObserver& observer);
    ~Flight();
    Flight(const Flight&) = delete;
    Flight& operator=(const Flight&) = delete;

    // Advances by one step of 4 ms.
    void step();
    // Sets the real time of the steps and inputs that follow. Time-outs of repeated inputs use it. Without this call,
    // they use the flight time.
    void set_real_time(MonoTime now) noexcept;
    // Boots again where the vehicle stands: disarmed, not ready, default mode. Plans stay.
    void reboot();
    // Call it after a parameter changed.
    void retune();

    // --- Orders. Each is carried out at once, or refused and announced.
    Outcome arm(bool force, OrderedBy by);
    Outcome disarm(bool force, OrderedBy by);
    Outcome set_mode(const ModeInfo& mode, OrderedBy by);
    Outcome take_off(const TakeoffOrder& order);
    Outcome land(const LandOrder& order);
    Outcome return_home();
    Outcome reposition(const RepositionOrder& order);
    Outcome orbit(const OrbitOrder& order);
    Outcome pause();
    Outcome resume();
    Outcome change_altitude(double altitude);  // m above mean sea level
    Outcome change_speed(SpeedKind kind, double speed);
    // Turns the nose to `yaw`, clockwise from north or relative to the current heading. A `nan` angle ends the order.
    Outcome turn_to(double yaw, double yaw_rate, bool relative);
    Outcome look_at(const std::optional<GeoPoint>& point);  // region of interest; empty: none
    Outcome start_mission(std::optional<std::uint16_t> first);
    // Without `seq`, restarts the current item.
    Outcome set_current_item(std::optional<std::uint16_t> seq, bool resets);
    Outcome set_home(const std::optional<GeoPoint>& point, double yaw);  // empty: the current position
    Outcome set_origin(const GeoPoint& origin);
    Outcome terminate();
    Outcome enable_fence(bool enabled);
    Outcome inject_failures(const SensorFailures& failures);
    Outcome set_battery(double share);

    // --- Inputs that must be repeated; see Tuning for their time-outs.
    void on_sticks(const Sticks& sticks);
    void on_offboard(const OffboardSetpoint& setpoint);
    // In a follow mode the vehicle keeps its place relative to the target; see Tuning. The altitude of the target does
    // not matter. `velocity` gives the target's course.
    void on_target(const GeoPoint& target, const Vector3& velocity);
    void on_ground_station_heard();
    // A plan was replaced.
    void on_plan_changed(PlanType type);
    // While a calibration runs, the vehicle is not ready.
    void set_calibrating(bool calibrating);
    [[nodiscard]] bool is_calibrating() const noexcept { return (unready() & unready_calibrating) != 0; }

    // --- State. References stay valid for the life of the object.
    [[nodiscard]] FlightTime since_boot() const noexcept;
    [[nodiscard]] bool armed() const noexcept;
    [[nodiscard]] const ModeInfo& mode() const noexcept;
    [[nodiscard]] const ModeInfo& intended_mode() const noexcept;  // what the client asked for, before a fail-safe
    [[nodiscard]] SystemStatus system_status() const noexcept;
    [[nodiscard]] LandedState landed() const noexcept;
    [[nodiscard]] std::uint32_t unready() const noexcept;  // bits of Unready; 0: can be armed
    [[nodiscard]] bool has_failsafe() const noexcept;
    [[nodiscard]] bool has_sticks() const noexcept;
    [[nodiscard]] Sticks sticks() const noexcept;
    [[nodiscard]] const Tuning& tuning() const noexcept;

    [[nodiscard]] const Kinematics& truth() const noexcept;
    [[nodiscard]] const Estimate& estimate() const noexcept;
    [[nodiscard]] const Sensors& sensors() const noexcept;
    [[nodiscard]] const Airframe& airframe() const noexcept;
    [[nodiscard]] const Battery& battery() const noexcept;
    [[nodiscard]] const Vector3& wind() const noexcept;
    [[nodiscard]] const Setpoint& setpoint() const noexcept;

    // The frame of every local position in this class. SET_GPS_GLOBAL_ORIGIN and a boot replace it.
    [[nodiscard]] const LocalFrame& frame() const noexcept;
    [[nodiscard]] bool has_origin() const noexcept;
    [[nodiscard]] const std::optional<GeoPoint>& home() const noexcept;
    [[nodiscard]] double home_yaw() const noexcept;
    // The estimated position at this step.
    [[nodiscard]] const GeoPoint& position() const;
    [[nodiscard]] double ground_altitude() const noexcept;  // m above mean sea level

    [[nodiscard]] Plans& plans() noexcept;
    [[nodiscard]] const Plans& plans() const noexcept;
    [[nodiscard]] MissionProgress mission() const noexcept;
    [[nodiscard]] const std::optional<NavigationTarget>& target() const noexcept;
    [[nodiscard]] std::optional<OrbitStatus> orbit_status() const;
    // The point at which nose and gimbal look; empty: none.
    [[nodiscard]] const std::optional<GeoPoint>& region_of_interest() const noexcept;
    [[nodiscard]] FlightTime armed_at() const noexcept;     // since boot; 0 if disarmed
    [[nodiscard]] FlightTime took_off_at() const noexcept;  // since boot; 0 if on the ground
    [[nodiscard]] std::uint32_t flights() const noexcept;

    class Impl;

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace mavloom::flight
