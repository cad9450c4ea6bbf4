// SPDX-License-Identifier: MIT
// Keeps connections alive: handles heartbeats of clients, time synchronisation, pings, and a radio's report of its
// buffers. Private to module sim; single owner. Source: MAVLink guide, "Time Synchronization" and "Ping Protocol".
#pragma once

#include "sim/service/service.hpp"

namespace mavloom::sim {

struct Parts;

class Connection final : public Service {
public:
    explicit Connection(Parts& parts) noexcept : parts_(parts) {}

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;

private:
    void on_heartbeat(const Client& from, ByteView payload, Moment now);
    void on_timesync(const Client& from, ByteView payload, Moment now);
    void on_ping(const Client& from, ByteView payload);
    void on_radio_status(const Client& from, ByteView payload, Moment now);

    Parts& parts_;
};

}  // namespace mavloom::sim
