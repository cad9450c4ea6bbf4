// SPDX-License-Identifier: MIT
// Keeps connections alive: handles heartbeats of clients, time synchronisation, pings, and a radio's report of its
// buffers. Private to module sim; single owner. Source: MAVLink guide, "Time Synchronization" and "Ping Protocol".
#pragma once

#include "flight/flight.hpp"
#include "sim/radio/radio.hpp"
#include "sim/service/announcer.hpp"
#include "sim/service/service.hpp"
#include "sim/telemetry/streams.hpp"

namespace mavloom::sim {

class Connection final : public Service {
public:
    Connection(const FlightTime& booted, Flight& flight, Radio& radio, Streams& streams, Announcer& announcer) noexcept
        : booted_(booted), flight_(flight), radio_(radio), streams_(streams), announcer_(announcer) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    void on_heartbeat(const Client& from, ByteView payload, Moment now);
    void on_timesync(const Client& from, ByteView payload, Moment now);
    void on_ping(const Client& from, ByteView payload);
    void on_radio_status(const Client& from, ByteView payload, Moment now);

    const FlightTime& booted_;
    Flight& flight_;
    Radio& radio_;
    Streams& streams_;
    Announcer& announcer_;
};

}  // namespace mavloom::sim
