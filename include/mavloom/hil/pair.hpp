// SPDX-License-Identifier: MIT
// A simulated vehicle and the autopilot that flies it: sensors out, motor commands in, one step at a time. The
// autopilot is PX4, or what speaks like its module simulator_mavlink. docs/guide/hil.md describes what users see.
//
// It opens nothing and reads no clock: its owner passes frames and times, and sends the frames that `step` returns.
// Pairs are independent of each other. Single owner; after construction nothing allocates.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/flight/fault.hpp"
#include "mavloom/flight/options.hpp"
#include "mavloom/hil/lock_step.hpp"
#include "mavloom/hil/sensor_rates.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::hil {

struct PairOptions {
    flight::VehicleOptions vehicle{};
    SensorRates rates{};
    double speed = 1;            // as for LockStep
    bool has_own_clock = false;  // a flight controller with SYS_HITL: flies in real time, and gets no true state
    WallTime utc_at_start{};     // at flight time 0
};

// How the pair understood a frame.
enum class Heard : std::uint8_t {
    nothing,    // not for the simulator
    request,    // how often it wants the true state
    autopilot,  // HEARTBEAT of PX4 or of something that names no autopilot
    stranger,   // HEARTBEAT of another autopilot or of a ground station
    controls,   // HIL_ACTUATOR_CONTROLS
};

struct PairCounters {
    std::uint64_t clamped = 0;      // messages with a control beyond its range
    std::uint64_t not_numbers = 0;  // messages with a control that is NaN or infinite
    std::uint64_t not_finite = 0;   // steps after which the motion was not finite: the vehicle is back at its start
    std::uint64_t restarts = 0;     // autopilots that came after the first
};

// The vehicle's true motion.
struct PairStatus {
    SystemId system{};  // of the autopilot; before it was heard, the one expected
    State state = State::waiting;
    bool is_paused = false, is_armed = false, touches_ground = true;
    FlightTime time{};
    double latitude_deg = 0, longitude_deg = 0;
    double altitude_m = 0, height_m = 0;  // above mean sea level, above its start
    double north_m_s = 0, east_m_s = 0, down_m_s = 0;
    double roll_deg = 0, pitch_deg = 0, heading_deg = 0;
};

// False for the parts that PX4 simulates itself, such as the battery.
[[nodiscard]] bool has_part(flight::FaultPart part) noexcept;

class Pair {
public:
    explicit Pair(const PairOptions& options);
    ~Pair();
    Pair(Pair&&) noexcept;
    Pair& operator=(Pair&&) noexcept;

    // An autopilot came. Call `end` first if there was one before.
    void begin(MonoTime now);
    // The autopilot went: the vehicle stands where it started. The clock continues from here with the next autopilot.
    void end();

    Heard receive(const wire::FrameView& frame, MonoTime now);
    [[nodiscard]] MonoTime due() const noexcept;
    // Makes one step and returns the frames for the autopilot, valid until the next call. Call it only when it is due.
    [[nodiscard]] std::span<const wire::FrameView> step(MonoTime now);

    void pause(MonoTime now) noexcept;
    void resume(MonoTime now) noexcept;
    // While it is paused, the flight continues for this time, rounded up to whole steps.
    void allow(Nanoseconds time) noexcept;
    // The vehicle stands where it started. The flight continues.
    void reset();
    // Within half a second, the velocity and the rates of turn change by so much.
    struct Push {
        double north_m_s = 0, east_m_s = 0, down_m_s = 0;
        double roll_deg_s = 0, pitch_deg_s = 0, yaw_deg_s = 0;
    };
    void push(const Push& push);
    void set_wind(const flight::Wind& wind);
    void set_mass(double kg);
    // A fault on purpose. It stays over `reset` and with the next autopilot, as broken hardware does. A part that PX4
    // simulates itself, or a motor that the vehicle does not have, is an error.
    [[nodiscard]] SetupResult<void> fail(const flight::Fault& fault);
    [[nodiscard]] std::span<const flight::Fault> faults() const noexcept;

    [[nodiscard]] const LockStep& lock_step() const noexcept;
    [[nodiscard]] const PairCounters& counters() const noexcept;
    [[nodiscard]] PairStatus status() const;
    // True once the peer has shown to be an autopilot.
    [[nodiscard]] bool is_known() const noexcept;

private:
    class Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace mavloom::hil
