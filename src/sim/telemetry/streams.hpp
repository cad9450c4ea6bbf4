// SPDX-License-Identifier: MIT
// When each message is due on each link. Private to module sim; single owner; `run` allocates nothing.
//
// Every stream has absolute deadlines, start + phase + n * interval, so rates do not drift. After a stall, each stream
// sends once; the instants that it missed are skipped and counted. Phases depend on vehicle and message, so that neither
// the messages of one vehicle nor the vehicles of a fleet burst together.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mavloom/sim/report.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "sim/radio/radio.hpp"
#include "sim/telemetry/telemetry.hpp"

namespace mavloom::sim {

// One row of a profile.
struct StreamRate {
    MessageId message;
    double hz = 0;
};
// Rows of a profile for a kind of vehicle.
[[nodiscard]] std::span<const StreamRate> rates_of(Profile profile) noexcept;

class Streams {
public:
    Streams(SystemId system, Radio& radio) noexcept : system_(system), radio_(radio) {}

    void open(LinkId link, const LinkOptions& options, FlightTime now);
    void close(LinkId link);

    [[nodiscard]] FlightTime next_due() const noexcept;
    // Skips all but the newest missed instant of each stream.
    void skip_missed(FlightTime now) noexcept;
    // Sends what is due up to `at`, the time of the view. `now` is the moment of the call, for the lateness.
    void run(const View& view, FlightTime at, FlightTime now);
    // Sends these messages at once on every link that streams them, without moving their deadlines.
    void send_now(const View& view, std::span<const MessageId> messages);

    // Changes one stream; empty: back to the profile's rate; 0: off. False if no projection has this id, and for
    // HEARTBEAT, which always runs at its rate. The stream's statistics start again.
    bool set_interval(LinkId link, MessageId message, std::optional<Nanoseconds> interval, FlightTime now);
    // Empty: unknown message; 0: off.
    [[nodiscard]] std::optional<Nanoseconds> interval(LinkId link, MessageId message) const noexcept;
    // The link's bandwidth for telemetry, and the share that RADIO_STATUS or log streaming leaves of it (0 to 1).
    void set_share(LinkId link, double share, FlightTime now);
    // The telemetry of all streams after the limit, in bytes a second.
    [[nodiscard]] double bytes_s(LinkId link) const noexcept;

    [[nodiscard]] std::vector<StreamReport> reports() const;

private:
    struct Stream {
        const Projection* projection;
        Nanoseconds asked{};     // as the client or the profile wants it; 0: off
        Nanoseconds interval{};  // after the bandwidth limit
        FlightTime due{};
        FlightTime first{}, last{};
        Nanoseconds skipped_time{};
        std::uint64_t sent = 0, skipped = 0;
        Lateness lateness{};
    };
    struct LinkStreams {
        LinkId link;
        LinkOptions options;
        double share = 1;
        std::vector<Stream> streams;  // by message id
        FlightTime next{};
    };
    [[nodiscard]] LinkStreams* find(LinkId link) noexcept;
    [[nodiscard]] const LinkStreams* find(LinkId link) const noexcept;
    void send(LinkId link, Stream& stream, const View& view, FlightTime now);
    static void limit(LinkStreams& link, FlightTime now);
    static void note_next(LinkStreams& link) noexcept;
    [[nodiscard]] static bool streams(const LinkStreams& link, MessageId message) noexcept;

    SystemId system_;
    Radio& radio_;
    std::vector<LinkStreams> links_;
};

}  // namespace mavloom::sim
