// SPDX-License-Identifier: MIT
// The events interface: EVENT, CURRENT_EVENT_SEQUENCE, REQUEST_EVENT. Private to module sim; single owner. Source:
// MAVLink guide, "Events Interface".
//
// Only PX4 sends events. It sends them to all links; clients can request the last 20 again. The arming checks and the
// health of the components are a report of several events, which is sent when it changes and when a client asks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "flight/firmware/firmware.hpp"
#include "flight/flight.hpp"
#include "mavloom/msg/event.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/announcer.hpp"
#include "sim/service/health_report.hpp"
#include "sim/service/service.hpp"
#include "sim/store/recorded_logs.hpp"

namespace mavloom::sim {

struct EventInfo;

// The vehicle's own times, which advance while it flies: of its last boot, of its last step, and the present one.
struct EventTimes {
    const FlightTime &booted, &stepped;
    const Moment& now;
};

class EventService final : public Service {
public:
    EventService(const Firmware& firmware, const Flight& flight, const RecordedLogs& logs, const EventTimes& times,
                 Radio& radio, Announcer& announcer) noexcept;

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    [[nodiscard]] FlightTime wakes_at() const noexcept override;
    void pump(Moment now) override;

    // Sends the event that has the same meaning as a text. Returns false if there is none.
    bool report_text(std::string_view text);
    // Sends the arming checks and the health of all components, as RUN_PREARM_CHECKS asks. Does nothing for ArduPilot.
    void report_health();

private:
    // Sends the event of this id with these arguments, packed little-endian.
    template <class... Arguments>
    void send(std::uint32_t id, Arguments... arguments);
    void send_packed(std::uint32_t id, const std::array<std::uint8_t, 40>& arguments);
    void send_problem(const HealthProblem& problem);
    void send_report(const HealthReport& report, FlightTime now);
    void announce_log();
    void restart();

    static constexpr std::size_t kept = 20;

    const Firmware& firmware_;
    const Flight& flight_;
    const RecordedLogs& logs_;
    const EventTimes times_;
    Radio& radio_;
    Announcer& announcer_;
    std::array<msg::Event, kept> past_{};  // a ring
    std::size_t next_slot_ = 0;            // of `past_`
    std::uint16_t count_ = 0;              // events in `past_`
    std::uint16_t sequence_ = 0;           // of the newest event
    std::uint16_t reset_ = 1;              // MAV_EVENT_CURRENT_SEQUENCE_FLAGS of the next CURRENT_EVENT_SEQUENCE
    FlightTime booted_;
    FlightTime next_sequence_, next_check_, may_report_;
    std::optional<HealthReport> reported_;
    bool has_announced_log_ = false;
};

}  // namespace mavloom::sim
