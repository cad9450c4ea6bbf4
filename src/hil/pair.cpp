// SPDX-License-Identifier: MIT
#include "mavloom/hil/pair.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "hil/outputs.hpp"
#include "hil/sensed_vehicle.hpp"
#include "hil/sensor_messages.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/hil_actuator_controls_flags.hpp"
#include "mavloom/msg/enums/mav_autopilot.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_mode_flag.hpp"
#include "mavloom/msg/enums/mav_type.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/hil_actuator_controls.hpp"
#include "mavloom/msg/hil_state_quaternion.hpp"

namespace mavloom::hil {

namespace {

constexpr ComponentId simulator_component{51};  // as in jMAVSim

// Of a request for a message; 0: never.
Nanoseconds interval_of(const msg::CommandLong& command) noexcept {
    constexpr float longest = 1e9f;  // us
    if (!(command.param2 > 0)) return {};
    return std::chrono::microseconds{static_cast<std::int64_t>(std::min(command.param2, longest))};
}

Heard kind_of(const msg::Heartbeat& heartbeat) noexcept {
    if (heartbeat.autopilot == msg::MAV_AUTOPILOT_PX4) return Heard::autopilot;
    const bool names_none = heartbeat.autopilot == msg::MAV_AUTOPILOT_GENERIC && heartbeat.type != msg::MAV_TYPE_GCS;
    return names_none ? Heard::autopilot : Heard::stranger;
}

}  // namespace

class Pair::Parts {
public:
    explicit Parts(const PairOptions& options)
        : has_own_clock_(options.has_own_clock),
          vehicle_(options.vehicle, options.rates),
          messages_(options.rates, options.utc_at_start),
          lock_step_(options.rates.step(), options.speed, options.has_own_clock) {
        messages_.set_source({options.vehicle.system, simulator_component});
        if (has_own_clock_) messages_.send_heartbeats();
    }

    void begin(MonoTime now) {
        lock_step_.begin(now);
        is_known_ = false;
    }
    void end() {
        lock_step_.end();
        stop();
        messages_.send_truth_each({}, {});
    }
    // The vehicle stands where it started, and its motors stand still.
    void stop() {
        vehicle_.place_at_start();
        messages_.forget_fixes();
        outputs_ = {};
        is_armed_ = false;
    }

    Heard receive(const wire::FrameView& frame, MonoTime now) {
        switch (frame.id().value) {
            case msg::HilActuatorControls::id.value: return receive_controls(frame, now);
            case msg::Heartbeat::id.value: return receive_heartbeat(frame);
            case msg::CommandLong::id.value: return receive_command(msg::CommandLong::decode(frame.payload()));
            default: return Heard::nothing;
        }
    }
    std::span<const wire::FrameView> step(MonoTime now) {
        const FlightTime time = lock_step_.take(now);
        if (!vehicle_.step(outputs_)) ++counters_.not_finite;
        return messages_.write(vehicle_, time);
    }

    [[nodiscard]] SensedVehicle& vehicle() noexcept { return vehicle_; }
    [[nodiscard]] LockStep& lock_step() noexcept { return lock_step_; }
    [[nodiscard]] const PairCounters& counters() const noexcept { return counters_; }
    [[nodiscard]] SystemId system() const noexcept { return messages_.source().system; }
    [[nodiscard]] bool is_known() const noexcept { return is_known_; }
    [[nodiscard]] bool is_armed() const noexcept { return is_armed_; }

private:
    Heard receive_heartbeat(const wire::FrameView& frame) {
        const Heard kind = kind_of(msg::Heartbeat::decode(frame.payload()));
        if (kind == Heard::autopilot) know(frame.system());
        return kind;
    }
    void know(SystemId system) {
        if (!is_known_) ++autopilots_;
        counters_.restarts = autopilots_ - 1;
        is_known_ = true;
        messages_.set_source({system, simulator_component});
    }
    Heard receive_controls(const wire::FrameView& frame, MonoTime now) {
        const auto message = msg::HilActuatorControls::decode(frame.payload());
        if (!is_known_) know(frame.system());
        lock_step_.answer(message.time_usec, (message.flags & msg::HIL_ACTUATOR_CONTROLS_FLAGS_LOCKSTEP) != 0, now);
        is_armed_ = (message.mode & msg::MAV_MODE_FLAG_SAFETY_ARMED) != 0;
        apply(message.controls);
        return Heard::controls;
    }
    void apply(const Controls& controls) {
        const ReadOutputs read = read_outputs(controls, vehicle_.kind(), vehicle_.channels());
        outputs_ = read.outputs;
        counters_.clamped += read.has_beyond ? 1 : 0;
        counters_.not_numbers += read.has_no_number ? 1 : 0;
    }
    Heard receive_command(const msg::CommandLong& command) {
        if (command.command != msg::MAV_CMD_SET_MESSAGE_INTERVAL) return Heard::nothing;
        if (command.param1 != static_cast<float>(msg::HilStateQuaternion::id.value)) return Heard::nothing;
        if (!has_own_clock_) messages_.send_truth_each(interval_of(command), lock_step_.time());
        return Heard::request;
    }

    const bool has_own_clock_;
    SensedVehicle vehicle_;
    SensorMessages messages_;
    LockStep lock_step_;
    PairCounters counters_;
    std::uint64_t autopilots_ = 0;
    flight::Outputs outputs_{};
    bool is_known_ = false, is_armed_ = false;
};

Pair::Pair(const PairOptions& options) : parts_(std::make_unique<Parts>(options)) {}
Pair::~Pair() = default;
Pair::Pair(Pair&&) noexcept = default;
Pair& Pair::operator=(Pair&&) noexcept = default;

void Pair::begin(MonoTime now) { parts_->begin(now); }
void Pair::end() { parts_->end(); }
Heard Pair::receive(const wire::FrameView& frame, MonoTime now) { return parts_->receive(frame, now); }
MonoTime Pair::due() const noexcept { return parts_->lock_step().due(); }
std::span<const wire::FrameView> Pair::step(MonoTime now) { return parts_->step(now); }

void Pair::pause(MonoTime now) noexcept { parts_->lock_step().pause(now); }
void Pair::resume(MonoTime now) noexcept { parts_->lock_step().resume(now); }
void Pair::allow(Nanoseconds time) noexcept {
    const Nanoseconds step = parts_->lock_step().step();
    parts_->lock_step().allow(static_cast<std::uint64_t>((time + step - Nanoseconds{1}) / step));
}
void Pair::reset() { parts_->stop(); }
void Pair::push(const Push& push) {
    parts_->vehicle().push({push.north_m_s, push.east_m_s, push.down_m_s},
                           Vector3(push.roll_deg_s, push.pitch_deg_s, push.yaw_deg_s) * flight::to_radians(1));
}
void Pair::set_wind(const flight::Wind& wind) { parts_->vehicle().set_wind(wind); }
void Pair::set_mass(double kg) { parts_->vehicle().set_mass(kg); }

bool has_part(flight::FaultPart part) noexcept {
    using enum flight::FaultPart;
    constexpr std::array parts{gyroscope, accelerometer, compass, barometer, gps, rangefinder, airspeed, motor, all};
    return std::ranges::find(parts, part) != parts.end();
}

SetupResult<void> Pair::fail(const flight::Fault& fault) {
    if (!has_part(fault.part)) {
        using enum flight::FaultPart;
        const bool may_inject = fault.part == battery || fault.part == esc;
        return setup_error(
            SetupCode::usage,
            fmt::format("the {} is PX4's own{}", flight::fault_part_names[static_cast<std::size_t>(fault.part)],
                        may_inject ? "; with its command MAV_CMD_INJECT_FAILURE it fails there" : ""));
    }
    if (auto refusal = flight::motor_refusal(fault, parts_->vehicle().channels()); !refusal.empty())
        return setup_error(SetupCode::usage, std::move(refusal));
    parts_->vehicle().fail(fault);
    return {};
}

std::span<const flight::Fault> Pair::faults() const noexcept { return parts_->vehicle().faults(); }
const LockStep& Pair::lock_step() const noexcept { return parts_->lock_step(); }
const PairCounters& Pair::counters() const noexcept { return parts_->counters(); }
bool Pair::is_known() const noexcept { return parts_->is_known(); }

PairStatus Pair::status() const {
    const flight::Kinematics& truth = parts_->vehicle().truth();
    const flight::GeoPoint place = parts_->vehicle().geo(truth.position);
    const flight::Euler euler = flight::to_euler(truth.attitude);
    return {.system = parts_->system(),
            .state = lock_step().state(),
            .is_paused = lock_step().is_paused(),
            .is_armed = parts_->is_armed(),
            .touches_ground = parts_->vehicle().touches_ground(),
            .time = lock_step().time(),
            .latitude_deg = place.latitude,
            .longitude_deg = place.longitude,
            .altitude_m = place.altitude,
            .height_m = -truth.position.z(),
            .north_m_s = truth.velocity.x(),
            .east_m_s = truth.velocity.y(),
            .down_m_s = truth.velocity.z(),
            .roll_deg = flight::to_degrees(euler.roll),
            .pitch_deg = flight::to_degrees(euler.pitch),
            .heading_deg = flight::to_degrees(flight::wrap_2pi(euler.yaw))};
}

}  // namespace mavloom::hil
