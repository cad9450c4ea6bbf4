// SPDX-License-Identifier: MIT
// The flying half of a vehicle: it moves, and it obeys or refuses orders. Private to flight and sim.
//
// Flight knows no MAVLink messages, links or clients. Services translate messages into its orders, and telemetry reads
// its state. It reports what happens to a FlightObserver. The owner steps it at 250 Hz. Single owner thread; `step`
// allocates nothing unless something is announced.
//
// Its parts, in the order in which they work:
//
//   Craft           moves: plant, pilot, battery, sensors, wind       250 Hz
//   Navigator       set-points for the current behaviour           50 Hz, like the parts below
//   LandedDetector  on the ground or not
//   CrashDetector   hit the ground too hard, so that the Commander disarms
//   Commander       armed or not, and in which mode
//   Failsafes       make the Commander act; a breached Fence is one reason
#pragma once

#include <cstdint>
#include <optional>

#include "flight/context.hpp"
#include "flight/faults.hpp"
#include "flight/inputs.hpp"
#include "flight/mode.hpp"
#include "flight/navigation/navigator.hpp"
#include "flight/navigation/random_pilot.hpp"
#include "flight/orders.hpp"
#include "flight/plan.hpp"
#include "flight/state.hpp"
#include "flight/supervision/commander.hpp"
#include "flight/supervision/crash_detector.hpp"
#include "flight/supervision/failsafes.hpp"
#include "flight/supervision/fence.hpp"
#include "flight/supervision/landed_detector.hpp"
#include "flight/tuning.hpp"
#include "mavloom/flight/options.hpp"

namespace mavloom::flight {

class Flight {
public:
    // `firmware`, `parameters` and `observer` must outlive the object. The vehicle stands at its home, disarmed.
    Flight(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
           FlightObserver& observer);
    Flight(const Flight&) = delete;
    Flight& operator=(const Flight&) = delete;

    // Advances by one step of 4 ms.
    void step();
    // How many steps from now, at least 1, the next one that may change modes, landed state and texts will be over.
    [[nodiscard]] unsigned steps_to_change() const noexcept;
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
    Outcome set_roi(const std::optional<GeoPoint>& point);  // region of interest; empty: none
    Outcome start_mission(std::optional<std::uint16_t> first);
    // Without `seq`, restarts the current item.
    Outcome set_current_item(std::optional<std::uint16_t> seq, bool resets);
    Outcome set_home(const std::optional<GeoPoint>& point, double yaw);  // empty: the current position
    Outcome set_origin(const GeoPoint& origin);
    Outcome terminate();
    Outcome enable_fence(bool enabled);
    // Replaces the failures that clients injected. They end with a boot.
    Outcome inject_failures(const Failures& failures);
    // A fault by the simulator's operator. Those of the heartbeat and the radio are kept for `is_off`. "all ok" also
    // ends the failures that clients injected.
    Outcome set_fault(const Fault& fault);
    Outcome set_battery(double share);
    Outcome restore_battery();  // to its charge at the start

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
    // Keeps the vehicle from arming until it reboots.
    void require_reboot(Unready reason);
    [[nodiscard]] bool is_calibrating() const noexcept { return (unready() & unready_calibrating) != 0; }

    // --- State. References stay valid for the life of the object.
    [[nodiscard]] FlightTime since_boot() const noexcept { return context_.now(); }
    [[nodiscard]] bool armed() const noexcept { return context_.armed; }
    [[nodiscard]] const ModeInfo& mode() const noexcept { return commander_.mode(); }
    // The mode that the client asked for, before a fail-safe.
    [[nodiscard]] const ModeInfo& intended_mode() const noexcept { return commander_.intended_mode(); }
    [[nodiscard]] SystemStatus system_status() const noexcept { return commander_.status(); }
    [[nodiscard]] LandedState landed() const noexcept { return context_.landed; }
    // Bits of Unready; 0: can be armed.
    [[nodiscard]] std::uint32_t unready() const noexcept { return commander_.unready(); }
    [[nodiscard]] bool has_failsafe() const noexcept { return commander_.has_failsafe(); }
    [[nodiscard]] bool has_sticks() const noexcept;
    [[nodiscard]] Sticks sticks() const noexcept { return inputs_.sticks.value().value_or(Sticks{}); }
    [[nodiscard]] const Tuning& tuning() const noexcept { return context_.tuning; }

    [[nodiscard]] const Kinematics& truth() const noexcept { return context_.craft.truth(); }
    [[nodiscard]] const Estimate& estimate() const noexcept { return context_.craft.estimate(); }
    [[nodiscard]] const Sensors& sensors() const noexcept { return context_.craft.sensors(); }
    [[nodiscard]] const Plant& plant() const noexcept { return context_.craft.plant(); }
    [[nodiscard]] const Outputs& outputs() const noexcept { return context_.craft.outputs(); }
    [[nodiscard]] InnerTargets inner_targets() const { return context_.craft.targets(); }
    [[nodiscard]] double last_range() const noexcept { return context_.craft.last_range(); }
    // Those that the operator set, in that order.
    [[nodiscard]] std::span<const Fault> faults() const noexcept { return faults_.list(); }
    // How often the motion was no longer finite, so that the vehicle was put back at its home.
    [[nodiscard]] unsigned not_finite() const noexcept { return not_finite_; }
    // True if the operator switched this part off.
    [[nodiscard]] bool is_off(FaultPart part) const noexcept { return faults_.has(part); }
    [[nodiscard]] const Battery& battery() const noexcept { return context_.craft.battery(); }
    [[nodiscard]] const Vector3& wind() const noexcept { return context_.craft.wind(); }
    [[nodiscard]] const Setpoint& setpoint() const noexcept { return navigator_.guidance().setpoint(); }

    // The frame of every local position in this class. SET_GPS_GLOBAL_ORIGIN and a boot replace it.
    [[nodiscard]] const LocalFrame& frame() const noexcept { return context_.craft.frame(); }
    [[nodiscard]] bool has_origin() const noexcept { return context_.craft.has_origin(); }
    [[nodiscard]] const std::optional<GeoPoint>& home() const noexcept { return context_.craft.home(); }
    [[nodiscard]] double home_yaw() const noexcept { return context_.craft.home_yaw(); }
    // The estimated position at this step.
    [[nodiscard]] const GeoPoint& position() const { return context_.craft.position(); }
    // In metres above mean sea level. Until home is set, `home_altitude` is that of the ground.
    [[nodiscard]] double ground_altitude() const noexcept { return context_.craft.ground_altitude(); }
    [[nodiscard]] double home_altitude() const noexcept { return home() ? home()->altitude : ground_altitude(); }

    [[nodiscard]] Plans& plans() noexcept { return context_.plans; }
    [[nodiscard]] const Plans& plans() const noexcept { return context_.plans; }
    [[nodiscard]] MissionProgress mission() const noexcept { return navigator_.mission().progress(); }
    [[nodiscard]] const std::optional<NavigationTarget>& target() const noexcept {
        return navigator_.guidance().target();
    }
    [[nodiscard]] std::optional<OrbitStatus> orbit_status() const;
    // The point at which nose and gimbal look; empty: none.
    [[nodiscard]] const std::optional<GeoPoint>& region_of_interest() const noexcept;
    // Since boot; 0 if disarmed.
    [[nodiscard]] FlightTime armed_at() const noexcept { return context_.armed_at; }
    // Since boot; 0 if on the ground.
    [[nodiscard]] FlightTime took_off_at() const noexcept { return detector_.took_off_at(); }
    [[nodiscard]] std::uint32_t flights() const noexcept { return commander_.flights(); }

private:
    // The state that HEARTBEAT and related messages show.
    struct Shown {
        const ModeInfo* mode = nullptr;
        bool armed = false;
        SystemStatus status{};
        LandedState landed{};
        bool operator==(const Shown&) const = default;
    };

    void begin_random_motion();
    void supervise();
    void steer_at_random();
    [[nodiscard]] Shown shown() const noexcept;
    // Reports to the observer what changed since the last report.
    void report_changes();
    // Carries out an order and reports what it changed.
    template <class Order>
    Outcome carry_out(Order order) {
        Outcome outcome = order();
        report_changes();
        return outcome;
    }
    void move_origin(const GeoPoint& origin);
    void apply_failures();
    void on_put_back();
    Outcome begin_takeoff(const TakeoffOrder& order);
    Outcome begin_reposition(const RepositionOrder& order);
    Outcome begin_orbit(const OrbitOrder& order);
    Outcome begin_mission(std::optional<std::uint16_t> first);
    Outcome begin_return(OrderedBy by);
    // Where the vehicle stays, or is. `keeps_goal`: on its way, it counts as there.
    [[nodiscard]] Vector3 present_position(bool keeps_goal = false) const;
    // The behaviour in which the vehicle stays where a client wants it: PX4's Hold, ArduPilot's Guided.
    [[nodiscard]] Behaviour steady_behaviour() const noexcept {
        return is_px4() ? Behaviour::hold : Behaviour::offboard;
    }
    [[nodiscard]] bool is_px4() const noexcept { return context_.firmware.is_px4(); }

    const Parameters& parameters_;
    FlightContext context_;
    Inputs inputs_;
    Failures injected_;
    Faults faults_;
    Navigator navigator_;
    LandedDetector detector_;
    CrashDetector crash_detector_;
    Commander commander_;
    Fence fence_;
    Failsafes failsafes_;
    std::optional<RandomPilot> random_pilot_;  // steers instead of the navigator
    Shown shown_;
    unsigned steps_ = 0;
    unsigned not_finite_ = 0;  // those of the craft that were handled
};

}  // namespace mavloom::flight
