// SPDX-License-Identifier: MIT
// The parts of Flight and the order in which they work. Private to flight.
//
//   Craft           moves: airframe, battery, sensors, wind       250 Hz
//   Navigator       set-points for the current behaviour           50 Hz, like the parts below
//   LandedDetector  on the ground or not
//   Commander       armed or not, and in which mode
//   Failsafes       make the Commander act; a breached Fence is one reason
#pragma once

#include "flight/navigation/navigator.hpp"
#include "flight/navigation/random_pilot.hpp"
#include "flight/supervision/commander.hpp"
#include "flight/supervision/failsafes.hpp"
#include "flight/supervision/fence.hpp"
#include "flight/supervision/landed_detector.hpp"

namespace mavloom::flight {

class Flight::Impl {
public:
    Impl(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
         FlightObserver& observer);
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void step();
    void reboot();
    void set_origin(const GeoPoint& origin);
    // Reports to the observer what changed since the last report.
    void report_changes();
    // Carries out an order and reports what it changed.
    template <class Order>
    Outcome carry_out(Order order) {
        Outcome outcome = order();
        report_changes();
        return outcome;
    }

    // --- Orders that concern several parts.
    Outcome take_off(const TakeoffOrder& order);
    Outcome reposition(const RepositionOrder& order);
    Outcome orbit(const OrbitOrder& order);
    Outcome start_mission(std::optional<std::uint16_t> first);
    Outcome return_home(OrderedBy by);

    [[nodiscard]] const Firmware& firmware() const noexcept { return context.firmware; }
    // The behaviour in which the vehicle stays where a client wants it: PX4's Hold, ArduPilot's Guided.
    [[nodiscard]] Behaviour steady_behaviour() const noexcept {
        return firmware().is_px4() ? Behaviour::hold : Behaviour::offboard;
    }

    const Parameters& parameters;
    FlightContext context;
    Inputs inputs;
    Navigator navigator;
    LandedDetector detector;
    Commander commander;
    Fence fence;
    Failsafes failsafes;
    std::optional<RandomPilot> random_pilot;  // steers instead of the navigator

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

    Shown shown_;
    unsigned steps_ = 0;
};

}  // namespace mavloom::flight
