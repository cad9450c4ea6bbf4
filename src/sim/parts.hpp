// SPDX-License-Identifier: MIT
// The parts of one vehicle, and how they find each other. Private to module sim.
//
//   Flight      moves and obeys orders; knows no messages
//   Radio       writes, numbers and signs frames, per link
//   Streams     sends projections of the flight's state when they are due
//   services    answer clients, by message id; they give orders to Flight
//
// Members stand in the order of their dependencies. A service gets references to the parts that it uses. Only
// two get all: the commands, because together they reach nearly all of them, and the compass calibration.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "flight/firmware/firmware.hpp"
#include "flight/flight.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "sim/command/commands.hpp"
#include "sim/command/failure_table.hpp"
#include "sim/payload/servo_outputs.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/announcer.hpp"
#include "sim/service/service.hpp"
#include "sim/telemetry/streams.hpp"

namespace mavloom::sim {

class CalibrationService;
class CompassCalibration;
class EventService;
class FileService;
class Gimbal;
class Guard;
class LogService;
class ParameterService;
class PlanService;

struct Parts final : FlightObserver {
    Parts(const VehicleOptions& options, Sink& sink, Moment now);
    ~Parts() override;

    const VehicleOptions options;
    const Firmware& firmware;
    FlightTime booted;   // flight time at the last boot
    FlightTime stepped;  // flight time of the state
    Moment now;          // of the call that is being handled
    Parameters parameters;
    Flight flight;
    Radio radio;
    Streams streams;
    Announcer announcer;
    Commands commands;
    FailureTable failures;  // that clients injected
    ServoOutputs servos;

    std::unique_ptr<Gimbal> gimbal;  // null: none is simulated
    std::unique_ptr<Guard> guard;
    std::unique_ptr<ParameterService> parameter_service;
    std::unique_ptr<PlanService> plan_service;
    std::unique_ptr<LogService> log_service;
    std::unique_ptr<FileService> file_service;
    std::unique_ptr<EventService> event_service;
    std::unique_ptr<CalibrationService> calibration_service;
    std::unique_ptr<CompassCalibration> compass_calibration;
    std::vector<std::unique_ptr<Service>> other_services;
    std::vector<Service*> services;                // all of them
    std::function<bool(SystemId)> is_free_system;  // empty: all ids are free

    [[nodiscard]] View view() const;
    [[nodiscard]] WallTime utc_at(FlightTime time) const noexcept { return options.utc_at_start + time; }
    [[nodiscard]] bool has_utc() const noexcept { return options.utc_at_start != WallTime{}; }
    // The time of signatures runs in real time, as the clients' clocks do.
    [[nodiscard]] WallTime signing_time(Moment moment) const noexcept {
        return utc_at(created_.flight) + (moment.real - created_.real);
    }

    // Null if no service handles the message.
    [[nodiscard]] Service* service_for(MessageId id) const noexcept;
    // Steps the flight up to a moment.
    void step_to(Moment moment);
    [[nodiscard]] bool may_change_by_itself() const noexcept { return flight.armed() || flight.unready() != 0; }
    // Reports what changed since the last call, on the links that stream it.
    void report_changes();
    // When services are pumped next; FlightTime::max() while none is busy or wants to wake.
    [[nodiscard]] FlightTime next_pump() const noexcept;
    void pump(Moment moment);

    // Call it after a parameter changed.
    void retune();
    // Sets a parameter without a client's request, and reports it to all links.
    void put_parameter(std::string_view name, double value);
    // Takes effect after the current call: the vehicle is silent for some seconds, then runs as after a boot. Without
    // `restarts`, it stays silent for good.
    void reboot(bool restarts) noexcept { wanted_silence_ = restarts ? reboot_time : Nanoseconds::max(); }
    // A fault by the simulator's operator. The flight's go there.
    Outcome set_fault(const Fault& fault);
    [[nodiscard]] bool is_silent(FlightTime time) const noexcept { return time < silent_until_; }
    [[nodiscard]] FlightTime silent_until() const noexcept { return silent_until_; }

    void on_text(Severity severity, std::string_view text) override;
    void on_state_changed() override { state_changed_ = true; }
    void on_home_changed() override { home_changed_ = true; }
    void on_mission_progress() override { mission_changed_ = true; }
    void on_item_reached(std::uint16_t seq) override;
    void on_payload_item(const PlanItem& item) override;

private:
    static constexpr Nanoseconds reboot_time = std::chrono::milliseconds{2500};

    void add(Service& service);
    void schedule_pump() noexcept;
    void fly_to(FlightTime time);
    void begin_silence();
    void end_silence();
    void take_system();

    const Moment created_;

    FlightTime silent_until_ = FlightTime::min();
    Nanoseconds wanted_silence_{0};
    FlightTime busy_pump_ = FlightTime::max();  // of the services that are busy
    FlightTime wake_ = FlightTime::max();       // the earliest time at which a service wants to wake
    static constexpr std::size_t direct_ids = 512;
    std::array<std::uint8_t, direct_ids> service_of_{};  // by message id: index in `services` plus one
    bool state_changed_ = false, home_changed_ = false, mission_changed_ = false;
};

}  // namespace mavloom::sim
