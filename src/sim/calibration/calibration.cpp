// SPDX-License-Identifier: MIT
#include "sim/calibration/calibration.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/accelcal_vehicle_pos.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array calibration_messages{msg::CommandAck::id};

constexpr Nanoseconds step_interval = std::chrono::milliseconds{250};
constexpr unsigned progress_steps = 10;

// PX4's names of sides, each as the side that points down; then ArduPilot's names of positions, from number 1 on.
constexpr std::array<std::string_view, 6> side_names{"down", "back", "front", "left", "right", "up"};
constexpr std::array<std::string_view, 6> position_names{"level",     "on its LEFT side", "on its RIGHT side",
                                                         "nose DOWN", "nose UP",          "on its BACK"};
constexpr Nanoseconds longest_wait = std::chrono::seconds{60};

// By CalibrationService::Sensor.
constexpr std::array<std::string_view, 7> sensor_names{"gyro", "mag", "baro", "accel", "level", "airspeed", "radio"};
constexpr std::array<std::string_view, 7> parameter_prefixes{"CAL_GYRO",    "CAL_MAG",     "", "CAL_ACC",
                                                             "SENS_BOARD_", "SENS_DPRES_", ""};

}  // namespace

std::span<const MessageId> CalibrationService::handled() const noexcept { return calibration_messages; }

// Older clients of ArduPilot confirm a position by a COMMAND_ACK.
void CalibrationService::receive(const Client& from, MessageId /*id*/, ByteView /*payload*/, Moment now) {
    (void)confirm(from, now);
}

// The sensor that the first set parameter asks for. Clients leave the others 0 or NaN.
std::optional<CalibrationService::Sensor> CalibrationService::sensor_of(const Command& command) noexcept {
    const auto asks = [&](std::size_t number, float value) { return command.param(number) == value; };
    if (asks(1, 1)) return Sensor::gyro;
    if (asks(2, 1)) return Sensor::mag;
    if (asks(3, 1)) return Sensor::baro;
    if (asks(4, 1) || asks(4, 2)) return Sensor::radio;
    if (asks(5, 1)) return Sensor::accel;
    if (asks(5, 2) || asks(5, 4)) return Sensor::level;
    if (asks(6, 1) || asks(6, 2)) return Sensor::airspeed;
    return std::nullopt;
}

Outcome CalibrationService::begin(const Command& command, Moment now) {
    const bool cancels = std::ranges::all_of(command.params, [](float p) { return p == 0 || std::isnan(p); });
    if (cancels) return cancel(now);
    const auto sensor = sensor_of(command);
    if (!sensor) return Result::denied;
    if (flight_.armed() || flight_.is_calibrating() || is_running()) return Result::temporarily_rejected;
    const bool is_px4 = firmware_.is_px4();
    if (*sensor == Sensor::radio || (!is_px4 && *sensor != Sensor::accel))
        return *sensor == Sensor::mag ? Result::unsupported : Result::accepted;
    client_ = command.from;
    sensor_ = *sensor;
    step_ = 0;
    flight_.set_calibrating(true);
    stage_ = Stage::begun;
    next_ = now.flight;
    if (!is_px4) ask_for_position(now);
    return Result::accepted;
}

// PX4's text comes after the acknowledgement. MAVSDK waits for the latter, and handles no text meanwhile.
Outcome CalibrationService::cancel(Moment now) {
    if (!is_running()) return Result::accepted;
    stop();
    if (!firmware_.is_px4()) {
        say("Calibration cancelled");
        return Result::accepted;
    }
    stage_ = Stage::cancelled;
    next_ = now.flight;
    return Result::accepted;
}

void CalibrationService::stop() {
    next_ = FlightTime::max();
    flight_.set_calibrating(false);
}

void CalibrationService::reboot() {
    if (is_running()) stop();
}

void CalibrationService::forget(LinkId link) {
    if (is_running() && !firmware_.is_px4() && client_.link == link) stop();
}

void CalibrationService::say(std::string_view text) { observer_.on_text(Severity::info, text); }

void CalibrationService::pump(Moment now) {
    if (now.flight < next_) return;
    if (!firmware_.is_px4()) return finish_ardupilot(false);
    next_ = now.flight + step_interval;
    report_px4(std::exchange(stage_, Stage::steps));
}

// --- PX4

// 2 is the version of these texts.
void CalibrationService::report_px4(Stage stage) {
    if (stage == Stage::begun)
        return say(fmt::format("[cal] calibration started: 2 {}", sensor_names[static_cast<std::size_t>(sensor_)]));
    if (stage == Stage::cancelled) {
        stop();
        return say("[cal] calibration cancelled");
    }
    sensor_ == Sensor::accel || sensor_ == Sensor::mag ? report_side_step() : report_step();
}

void CalibrationService::report_step() {
    if (step_ > progress_steps) return finish_px4();
    say(fmt::format("[cal] progress <{}>", 100 * step_++ / progress_steps));
}

void CalibrationService::report_side_step() {
    constexpr unsigned steps_per_side = 3;
    const unsigned side = step_ / steps_per_side;
    if (side == side_names.size()) return finish_px4();
    switch (step_++ % steps_per_side) {
        case 0: return say(fmt::format("[cal] {} orientation detected", side_names[side]));
        case 1: return say(fmt::format("[cal] {} side done, rotate to a different side", side_names[side]));
        default: return say(fmt::format("[cal] progress <{}>", 100 * (side + 1) / side_names.size()));
    }
}

void CalibrationService::finish_px4() {
    stop();
    store_results();
    say(fmt::format("[cal] calibration done: {}", sensor_names[static_cast<std::size_t>(sensor_)]));
}

// The vehicle reports the parameters of the sensor, as PX4 does after it stored the results.
void CalibrationService::store_results() {
    const std::string_view prefix = parameter_prefixes[static_cast<std::size_t>(sensor_)];
    if (prefix.empty()) return;
    for (ParamIndex i = 0; i < parameters_.size(); ++i)
        if (parameters_.info(i).name.starts_with(prefix)) parameter_service_.announce(i);
}

// --- ArduPilot

void CalibrationService::ask_for_position(Moment now) {
    next_ = now.flight + longest_wait;
    say(fmt::format("Place vehicle {} and press any key", position_names[step_]));
    send_position(step_ + msg::ACCELCAL_VEHICLE_POS_LEVEL);
}

bool CalibrationService::confirm(const Client& from, Moment now) {
    if (!is_running() || firmware_.is_px4() || from != client_) return false;
    if (++step_ < position_names.size()) {
        ask_for_position(now);
    } else {
        finish_ardupilot(true);
    }
    return true;
}

void CalibrationService::finish_ardupilot(bool successful) {
    stop();
    if (successful) flight_.require_reboot(unready_accelerometer_calibrated);
    say(successful ? "Calibration successful" : "Calibration FAILED");
    send_position(successful ? msg::ACCELCAL_VEHICLE_POS_SUCCESS : msg::ACCELCAL_VEHICLE_POS_FAILED);
}

void CalibrationService::send_position(std::uint32_t position) {
    radio_.send(client_.link, msg::CommandLong{.target_system = client_.id.system.value,
                                               .target_component = client_.id.component.value,
                                               .command = msg::MAV_CMD_ACCELCAL_VEHICLE_POS,
                                               .param1 = static_cast<float>(position)});
}

}  // namespace mavloom::sim
