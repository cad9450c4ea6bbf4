// SPDX-License-Identifier: MIT
// Calibration of sensors (MAV_CMD_PREFLIGHT_CALIBRATION). Private to module sim; single owner.
//
// PX4 reports its progress by texts that begin with "[cal]". Ground stations and SDKs parse them. The simulated vehicle
// turns itself to each side that is needed. ArduPilot asks the client with MAV_CMD_ACCELCAL_VEHICLE_POS to turn the
// vehicle to one side after another, and waits for a confirmation of each. Its other calibrations finish at once.
#pragma once

#include <optional>

#include "flight/firmware/firmware.hpp"
#include "flight/flight.hpp"
#include "sim/command/commands.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/service.hpp"
#include "sim/store/parameter_service.hpp"

namespace mavloom::sim {

class CalibrationService final : public Service {
public:
    CalibrationService(const Firmware& firmware, const Parameters& parameters, Flight& flight, Radio& radio,
                       ParameterService& parameter_service, FlightObserver& observer) noexcept
        : firmware_(firmware),
          parameters_(parameters),
          flight_(flight),
          radio_(radio),
          parameter_service_(parameter_service),
          observer_(observer) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    [[nodiscard]] FlightTime wakes_at() const noexcept override { return next_; }
    void pump(Moment now) override;
    void reboot() override;
    void forget(LinkId link) override;

    Outcome begin(const Command& command, Moment now);
    // ArduPilot: the client confirms the position that the vehicle asked for. Returns false if it asked for none.
    bool confirm(const Client& from, Moment now);

private:
    enum class Stage : std::uint8_t { begun, steps, cancelled };
    enum class Sensor : std::uint8_t { gyro, mag, baro, accel, level, airspeed, radio };

    [[nodiscard]] static std::optional<Sensor> sensor_of(const Command& command) noexcept;
    [[nodiscard]] bool is_running() const noexcept { return next_ != FlightTime::max(); }
    Outcome cancel(Moment now);
    void stop();
    void say(std::string_view text);

    void report_px4(Stage stage);
    void report_step();
    void report_side_step();
    void finish_px4();
    void store_results();

    void ask_for_position(Moment now);
    void finish_ardupilot(bool successful);
    void send_position(std::uint32_t position);

    const Firmware& firmware_;
    const Parameters& parameters_;
    Flight& flight_;
    Radio& radio_;
    ParameterService& parameter_service_;
    FlightObserver& observer_;
    FlightTime next_ = FlightTime::max();  // when the next text is due, or ArduPilot gives up
    Stage stage_ = Stage::begun;           // PX4
    Sensor sensor_{};
    unsigned step_ = 0;
    Client client_;  // ArduPilot: the client that turns the vehicle
};

}  // namespace mavloom::sim
