// SPDX-License-Identifier: MIT
// ArduPilot's calibration of compasses: MAV_CMD_DO_START_MAG_CAL, _ACCEPT_ and _CANCEL_, and MAV_CMD_FIXED_MAG_CAL_YAW.
// Private to module sim; single owner. Source: AP_Compass_Calibration.cpp and CompassCalibrator.cpp of ArduPilot 4.6.
//
// The simulated vehicle turns itself. Four times a second, all links get MAG_CAL_PROGRESS of each compass that is being
// calibrated, and MAG_CAL_REPORT of each that is done, until a client accepts or cancels it. The offsets that come out
// are those of ArduPilot's own simulator.
#pragma once

#include <array>

#include "sim/command/commands.hpp"
#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class CompassCalibration final : public Service {
public:
    // All parts: it sets parameters, reports them, and boots the vehicle, which only all of them together can do.
    explicit CompassCalibration(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override { return {}; }
    void receive(const Client& /*from*/, MessageId /*id*/, ByteView /*payload*/, Moment /*now*/) override {}
    [[nodiscard]] FlightTime wakes_at() const noexcept override { return next_; }
    void pump(Moment now) override;
    void reboot() override;

    Outcome start(const Command& command, Moment now);
    Outcome accept(const Command& command, Moment now);
    Outcome cancel(const Command& command);
    // Needs no turns: the client knows the vehicle's heading.
    Outcome calibrate_by_heading(const Command& command);

private:
    struct Compass {
        FlightTime begins = FlightTime::max();  // when it leaves the state "waiting"; max(): not started
        bool is_saved = false;

        [[nodiscard]] bool is_started() const noexcept { return begins != FlightTime::max(); }
        [[nodiscard]] bool is_done(FlightTime now) const noexcept;
        [[nodiscard]] std::uint8_t status(FlightTime now) const noexcept;   // MAG_CAL_STATUS
        [[nodiscard]] std::uint8_t percent(FlightTime now) const noexcept;  // of MAG_CAL_PROGRESS
    };

    [[nodiscard]] bool is_usable(std::size_t index) const noexcept;
    [[nodiscard]] bool is_running(FlightTime now) const noexcept;
    [[nodiscard]] std::uint8_t started() const noexcept;  // a bit for each compass
    bool begin(std::uint32_t mask, FlightTime begins, FlightTime now);
    void stop(std::uint32_t mask);
    void save(std::size_t index);
    void end();
    void send_progress(std::size_t index, FlightTime now);
    void send_report(std::size_t index);

    static constexpr std::size_t max_compasses = 3;
    Parts& parts_;
    std::array<Compass, max_compasses> compasses_{};
    bool saves_by_itself_ = false, reboots_by_itself_ = false;
    bool is_calibrating_ = false;          // from the start until all compasses are done or stopped
    FlightTime next_ = FlightTime::max();  // when messages are due
};

}  // namespace mavloom::sim
