// SPDX-License-Identifier: MIT
#include "sim/telemetry/streams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "mavloom/wire/frame.hpp"

namespace mavloom::sim {

namespace {

constexpr MessageId heartbeat_id{0};
constexpr MessageId high_latency2_id{235};
// No stream runs faster than the vehicle steps.
constexpr Nanoseconds shortest_interval = step_time;

Nanoseconds interval_of(double hz) noexcept {
    return hz <= 0 ? Nanoseconds{0} : Nanoseconds{static_cast<std::int64_t>(std::llround(1e9 / hz))};
}

// A number that spreads over 0 to 1 for each vehicle and message.
double phase_of(SystemId system, MessageId message) noexcept {
    std::uint64_t z = (std::uint64_t{system.value} << 32 | message.value) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1.0p-53;
}

// Streams that the bandwidth limit leaves alone, as in PX4.
bool is_constant(const Projection& projection) noexcept {
    return projection.info.id == heartbeat_id || projection.info.id == high_latency2_id;
}

std::size_t wire_size(const Projection& projection) noexcept {
    return wire::header_length_v2 + projection.info.max_length + wire::checksum_length;
}

Nanoseconds default_interval(const LinkOptions& options, MessageId message) noexcept {
    const auto rows = rates_of(options.profile);
    const auto row = std::ranges::find(rows, message, &StreamRate::message);
    return row == rows.end() ? Nanoseconds{0} : interval_of(row->hz);
}

}  // namespace

void Streams::open(LinkId link, const LinkOptions& options, FlightTime now) {
    if (find(link) != nullptr) return;
    auto& opened = links_.emplace_back(LinkStreams{.link = link, .options = options, .streams = {}});
    for (const Projection& projection : projections()) {
        const Nanoseconds interval = default_interval(options, projection.info.id);
        if (interval.count() != 0) opened.streams.push_back({.projection = &projection, .asked = interval});
    }
    for (Stream& stream : opened.streams) {
        const bool starts_at_once = is_constant(*stream.projection);
        const double phase = starts_at_once ? 0 : phase_of(system_, stream.projection->info.id);
        stream.due = now + Nanoseconds{static_cast<std::int64_t>(phase * static_cast<double>(stream.asked.count()))};
    }
    limit(opened, now);
}

void Streams::close(LinkId link) {
    std::erase_if(links_, [&](const LinkStreams& l) { return l.link == link; });
}

FlightTime Streams::next_due() const noexcept {
    FlightTime due = FlightTime::max();
    for (const LinkStreams& link : links_) due = std::min(due, link.next);
    return due;
}

void Streams::skip_missed(FlightTime now) noexcept {
    for (LinkStreams& link : links_) {
        if (now - link.next < shortest_interval) continue;
        for (Stream& stream : link.streams) {
            if (stream.interval.count() == 0 || now - stream.due < stream.interval) continue;
            const auto missed = (now - stream.due) / stream.interval;
            stream.due += missed * stream.interval;
            stream.skipped += static_cast<std::uint64_t>(missed);
            stream.skipped_time += missed * stream.interval;
        }
        note_next(link);
    }
}

void Streams::run(const View& view, FlightTime at, FlightTime now) {
    for (LinkStreams& link : links_) {
        if (link.next > at) continue;
        for (Stream& stream : link.streams)
            if (stream.interval.count() != 0 && stream.due <= at) send(link.link, stream, view, now);
        note_next(link);
    }
}

void Streams::send(LinkId link, Stream& stream, const View& view, FlightTime now) {
    const FlightTime due = std::exchange(stream.due, stream.due + stream.interval);
    std::array<std::uint8_t, wire::max_payload_length> payload{};
    if (!stream.projection->write(view, payload)) return;
    stream.lateness.add(now - due);
    if (stream.sent++ == 0) {
        stream.first = now;
        stream.skipped = 0;
        stream.skipped_time = Nanoseconds{0};
    }
    stream.last = now;
    radio_.transmit(link, stream.projection->info, {payload.data(), stream.projection->info.max_length});
}

void Streams::send_now(const View& view, std::span<const MessageId> messages) {
    std::array<std::uint8_t, wire::max_payload_length> payload;
    for (const MessageId id : messages) {
        const Projection* const projection = find_projection(id);
        if (projection == nullptr) continue;
        payload.fill(0);
        if (!projection->write(view, payload)) continue;
        for (const LinkStreams& link : links_)
            if (streams(link, id)) radio_.transmit(link.link, projection->info, {payload.data(), projection->info.max_length});
    }
}

bool Streams::set_interval(LinkId link, MessageId message, std::optional<Nanoseconds> interval, FlightTime now) {
    LinkStreams* const of = find(link);
    const Projection* const projection = find_projection(message);
    if (of == nullptr || projection == nullptr || message == heartbeat_id) return false;
    const Nanoseconds asked = interval ? std::max(*interval, Nanoseconds{0}) : default_interval(of->options, message);
    auto at = std::ranges::find(of->streams, projection, &Stream::projection);
    if (at == of->streams.end()) {
        of->streams.push_back({.projection = projection});
        at = of->streams.end() - 1;
    }
    at->asked = asked.count() == 0 ? asked : std::max(asked, shortest_interval);
    at->due = now;
    at->sent = at->skipped = 0;
    at->skipped_time = Nanoseconds{0};
    at->lateness = {};
    limit(*of, now);
    return true;
}

std::optional<Nanoseconds> Streams::interval(LinkId link, MessageId message) const noexcept {
    const Projection* const projection = find_projection(message);
    const LinkStreams* const of = find(link);
    if (projection == nullptr || of == nullptr) return std::nullopt;
    const auto at = std::ranges::find(of->streams, projection, &Stream::projection);
    return at == of->streams.end() ? Nanoseconds{0} : at->asked;
}

void Streams::set_share(LinkId link, double share, FlightTime now) {
    if (LinkStreams* const of = find(link)) {
        of->share = share;
        limit(*of, now);
    }
}

double Streams::bytes_s(LinkId link) const noexcept {
    double sum = 0;
    if (const LinkStreams* const of = find(link))
        for (const Stream& stream : of->streams)
            if (stream.interval.count() != 0)
                sum += static_cast<double>(wire_size(*stream.projection)) * 1e9 / static_cast<double>(stream.interval.count());
    return sum;
}

// One factor for all streams but the constant ones, so that the sum fits the link: PX4's rule. The factor is at least
// 0.05. With no limit it is 1.
void Streams::limit(LinkStreams& link, FlightTime now) {
    double constant = 0, rest = 0;
    for (const Stream& stream : link.streams) {
        if (stream.asked.count() == 0) continue;
        const double rate = static_cast<double>(wire_size(*stream.projection)) * 1e9 / static_cast<double>(stream.asked.count());
        (is_constant(*stream.projection) ? constant : rest) += rate;
    }
    double factor = 1;
    if (link.options.max_bytes_s != 0 && rest > 0)
        factor = std::clamp((link.options.max_bytes_s * link.share - constant) / rest, 0.05, 1.0);
    for (Stream& stream : link.streams) {
        const double scale = is_constant(*stream.projection) ? 1 : 1 / factor;
        stream.interval = Nanoseconds{static_cast<std::int64_t>(std::llround(static_cast<double>(stream.asked.count()) * scale))};
        stream.due = std::min(stream.due, now + stream.interval);
    }
    note_next(link);
}

void Streams::note_next(LinkStreams& link) noexcept {
    link.next = FlightTime::max();
    for (const Stream& stream : link.streams)
        if (stream.interval.count() != 0) link.next = std::min(link.next, stream.due);
}

bool Streams::streams(const LinkStreams& link, MessageId message) noexcept {
    return std::ranges::any_of(link.streams, [&](const Stream& stream) {
        return stream.projection->info.id == message && stream.interval.count() != 0;
    });
}

std::vector<StreamReport> Streams::reports() const {
    std::vector<StreamReport> reports;
    for (const LinkStreams& link : links_)
        for (const Stream& stream : link.streams) {
            const auto time = std::chrono::duration<double>(stream.last - stream.first - stream.skipped_time).count();
            reports.push_back({.system = system_,
                               .link = link.link,
                               .message = stream.projection->info.id,
                               .name = stream.projection->name,
                               .asked_hz = stream.interval.count() == 0 ? 0 : 1e9 / static_cast<double>(stream.interval.count()),
                               .achieved_hz = stream.sent < 2 || time <= 0 ? 0 : static_cast<double>(stream.sent - 1) / time,
                               .sent = stream.sent,
                               .skipped = stream.skipped,
                               .lateness = stream.lateness});
        }
    return reports;
}

Streams::LinkStreams* Streams::find(LinkId link) noexcept {
    const auto at = std::ranges::find(links_, link, &LinkStreams::link);
    return at == links_.end() ? nullptr : &*at;
}
const Streams::LinkStreams* Streams::find(LinkId link) const noexcept {
    const auto at = std::ranges::find(links_, link, &LinkStreams::link);
    return at == links_.end() ? nullptr : &*at;
}

}  // namespace mavloom::sim
