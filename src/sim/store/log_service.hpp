// SPDX-License-Identifier: MIT
// Download of recorded logs, and streaming of the log that is being written. Private to module sim; single owner.
// Source: MAVLink guide, "Log transfer protocol".
//
// A client downloads one thing at a time; a new request replaces the running one. Data is sent as fast as the link
// takes it.
#pragma once

#include <vector>

#include "flight/orders.hpp"
#include "sim/service/service.hpp"
#include "sim/store/log_stream.hpp"
#include "sim/store/recorded_logs.hpp"

namespace mavloom::sim {

using flight::Result;  // and not mavloom::Result

class LogService final : public Service {
public:
    LogService(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters,
               const Flight& flight, Radio& radio, const FlightTime& booted);

    [[nodiscard]] std::span<const MessageId> handled() const noexcept override;
    void receive(const Client& from, MessageId id, ByteView payload, Moment now) override;
    [[nodiscard]] bool is_busy() const noexcept override { return !downloads_.empty() || streams_.is_busy(); }
    void pump(Moment now) override;
    void reboot() override;
    void forget(LinkId link) override;

    [[nodiscard]] const RecordedLogs& logs() const noexcept { return logs_; }
    [[nodiscard]] FlightRecorder& recorder() noexcept { return logs_.recorder(); }

    // MAV_CMD_LOGGING_START and _STOP, which PX4 knows: streams the running log to the client.
    [[nodiscard]] Result start_stream(const Client& to, Moment now) { return streams_.start(to, now); }
    Result stop_stream(const Client& to);

private:
    // A list of entries, or the content of one log: the range from `next` up to but not including `end`.
    struct Download {
        Client client;
        bool is_list = false;
        std::uint16_t id = 0;   // of LOG_DATA
        std::uint32_t log = 0;  // its serial
        std::uint32_t next = 0, end = 0;
    };
    void on_list(const Client& from, ByteView payload);
    void on_data(const Client& from, ByteView payload);
    // Returns false if too many clients download.
    [[nodiscard]] bool begin(const Download& download);
    void stop(const Client& client);
    void send_entry(const Client& to, std::uint32_t index);
    void send_nothing(const Client& to, std::uint16_t id, std::uint32_t offset);
    // These return false when the download is complete.
    [[nodiscard]] bool send_next_entry(Download& download);
    [[nodiscard]] bool send_next(Download& download);
    [[nodiscard]] bool advance(Download& download);  // sends as many messages as may be sent at once

    const Firmware& firmware_;
    Radio& radio_;
    const FlightTime& booted_;
    const std::size_t max_clients_;
    RecordedLogs logs_;
    LogStreams streams_;
    std::vector<Download> downloads_;  // at most Limits::clients
};

}  // namespace mavloom::sim
