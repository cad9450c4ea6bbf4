// SPDX-License-Identifier: MIT
// Sends each message on each link when it is due. Private to module sim; single owner; `run` allocates nothing.
//
// Every stream has absolute deadlines, start + phase + n * interval, so rates do not drift. After a stall, each stream
// sends once; the instants that it missed are skipped and counted. Phases depend on the vehicle and differ between
// streams of equal rate, so that neither the messages of one vehicle nor the vehicles of a fleet burst together.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "mavloom/sim/report.hpp"
#include "mavloom/sim/vehicle.hpp"
#include "sim/radio/radio.hpp"
#include "sim/telemetry/profiles.hpp"
#include "sim/telemetry/telemetry.hpp"

namespace mavloom::sim {

class Streams {
public:
    // The arguments must outlive the object.
    Streams(const VehicleOptions& options, const Firmware& firmware, const Parameters& parameters, Radio& radio) noexcept
        : options_(options), firmware_(firmware), parameters_(parameters), radio_(radio) {}

    // Starts the streams of the link's profile, and sends the first HEARTBEAT.
    void open(LinkId link, const LinkOptions& options, const View& view, FlightTime now);
    void close(LinkId link);
    // Returns all streams to the rates of their profiles, as after a boot.
    void reset(FlightTime now);
    // Call it after a parameter changed: some of ArduPilot's set the rates of groups of its profile.
    void retune(FlightTime now);

    [[nodiscard]] FlightTime next_due() const noexcept;
    // Skips all but the newest missed instant of each stream.
    void skip_missed(FlightTime now) noexcept;
    // Sends what is due up to `at`, the time of the view. `now` is the moment of the call, for the lateness.
    void run(const View& view, FlightTime at, FlightTime now);
    // Sends these messages at once on every link that streams them, without moving their deadlines.
    void send_now(const View& view, std::span<const MessageId> messages);
    // Sends one message to one link, whether it is streamed or not. Returns false if the message is unknown or there is
    // nothing to report.
    bool send_once(const View& view, LinkId link, MessageId message);

    // Changes the interval of one stream. An empty `interval` restores the profile's rate; 0 turns the stream off.
    // Returns false if the firmware does not stream this message, and for HEARTBEAT, whose rate is fixed. A change
    // resets the stream's statistics.
    bool set_interval(LinkId link, MessageId message, std::optional<Nanoseconds> interval, FlightTime now);
    // The requested interval, before the bandwidth limit. Empty: unknown message; 0: off.
    [[nodiscard]] std::optional<Nanoseconds> interval(LinkId link, MessageId message) const noexcept;
    // Multiplies the share of the link's bandwidth that telemetry may use. The share starts at 1 and stays between 0.05
    // and 1.
    void scale_share(LinkId link, double factor, FlightTime now);

    [[nodiscard]] std::vector<StreamReport> reports(LinkId link) const;

private:
    // Deadlines stand in LinkStreams::due, so that the search for the next one reads few cache lines.
    struct Stream {
        const Projection* projection;
        When when = When::always;
        std::uint32_t number = 0;  // messages sent so far
        Nanoseconds asked{};       // as requested by the client or the profile; 0: off
        Nanoseconds interval{};    // after the bandwidth limit; 0: off, or a service sends the message
        // Statistics. `left_out` is time without messages between `first` and `last`: skipped instants, and instants
        // at which there was nothing to report. `pending` becomes part of it with the next message.
        FlightTime first{}, last{};
        Nanoseconds left_out{}, pending{};
        std::uint64_t sent = 0, skipped = 0;
        Lateness lateness{};
    };
    // Bytes per second over a link, measured once a second.
    struct Meter {
        FlightTime at{};
        Radio::Totals totals{};
        std::uint32_t sent_s = 0, received_s = 0;
    };
    struct LinkStreams {
        LinkId link;
        LinkOptions options;
        double share = 1;
        std::vector<Stream> streams{};
        std::vector<FlightTime> due{};  // as streams; FlightTime::max(): never
        FlightTime next{};
        Meter meter{};
        std::vector<double> group_hz{};  // as stream_groups(), for the profile with groups
    };
    [[nodiscard]] LinkStreams* find(LinkId link) noexcept;
    [[nodiscard]] const LinkStreams* find(LinkId link) const noexcept;
    [[nodiscard]] std::vector<StreamRate> rates_of_link(const LinkOptions& options) const;
    [[nodiscard]] std::vector<double> group_rates(const LinkOptions& options) const;
    [[nodiscard]] std::optional<StreamRate> default_rate(const LinkOptions& options, MessageId message) const;
    void fill(LinkStreams& link, FlightTime now);
    Stream& stream_of(LinkStreams& link, const Projection& projection);
    [[nodiscard]] FlightTime first_due(const LinkStreams& link, std::size_t index, FlightTime now) const noexcept;
    [[nodiscard]] View view_of(const View& view, LinkStreams& link, FlightTime at) const noexcept;
    void run_stream(LinkStreams& link, std::size_t index, View& view, FlightTime now);
    // Returns false if there is nothing to report.
    bool send(LinkId link, Stream& stream, View& view, FlightTime due, FlightTime now);
    static void limit(LinkStreams& link, FlightTime now);
    static void note_next(LinkStreams& link) noexcept;
    [[nodiscard]] static bool streams(const LinkStreams& link, MessageId message) noexcept;
    [[nodiscard]] static StreamReport report_of(SystemId system, LinkId link, const Stream& stream);

    const VehicleOptions& options_;
    const Firmware& firmware_;
    const Parameters& parameters_;
    Radio& radio_;
    std::vector<LinkStreams> links_;
};

}  // namespace mavloom::sim
