// SPDX-License-Identifier: MIT
#include "sim/telemetry/streams.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "mavloom/wire/frame.hpp"

namespace mavloom::sim {

namespace {

constexpr MessageId heartbeat_id{0};
constexpr MessageId high_latency2_id{235};
// No stream runs faster than the vehicle steps.
constexpr Nanoseconds shortest_interval = step_time;
// A stream that a client asks for starts within this time.
constexpr Nanoseconds longest_start = std::chrono::milliseconds{20};
constexpr Nanoseconds metering = std::chrono::seconds{1};

Nanoseconds interval_of_rate(double hz) noexcept {
    return hz <= 0 ? Nanoseconds{0} : Nanoseconds{static_cast<std::int64_t>(std::llround(1e9 / hz))};
}

Nanoseconds scaled(Nanoseconds time, double factor) noexcept {
    return Nanoseconds{std::llround(static_cast<double>(time.count()) * factor)};
}

double fraction(double x) noexcept { return x - std::floor(x); }

// Spreads systems 1, 2, 3 ... evenly over 0 to 1, however many there are: 0, 1/2, 1/4, 3/4, 1/8 ...
double phase_of(SystemId system) noexcept {
    unsigned reversed = 0;
    for (unsigned bit = 0, id = system.value - 1u; bit < 8; ++bit) reversed = reversed << 1 | (id >> bit & 1);
    return reversed / 256.0;
}

// Spreads streams of one interval over it: multiples of the golden ratio keep far apart for any number of streams. The
// interval's own share keeps classes of different rates apart.
double phase_of(SystemId system, std::size_t rank, Nanoseconds interval) noexcept {
    constexpr double golden = 0.6180339887498949;
    const auto mixed = static_cast<std::uint64_t>(interval.count()) * 0x9e3779b97f4a7c15u;
    const double of_class = static_cast<double>(mixed >> 11) * 0x1.0p-53;
    return fraction(phase_of(system) + static_cast<double>(rank) * golden + of_class);
}

// Streams that the bandwidth limit leaves alone, as in PX4.
bool is_constant(const Projection& projection) noexcept {
    return projection.info.id == heartbeat_id || projection.info.id == high_latency2_id;
}

std::size_t wire_size(const Projection& projection) noexcept {
    return wire::header_length_v2 + projection.info.max_length + wire::checksum_length;
}

double bytes_s_at(const Projection& projection, Nanoseconds interval) noexcept {
    return static_cast<double>(wire_size(projection)) * 1e9 / static_cast<double>(interval.count());
}

double hz_of(Nanoseconds interval) noexcept {
    return interval.count() == 0 ? 0 : 1e9 / static_cast<double>(interval.count());
}

}  // namespace

void Streams::open(LinkId link, const LinkOptions& options, const View& view, FlightTime now) {
    if (find(link) != nullptr) return;
    LinkStreams& opened = links_.emplace_back(LinkStreams{.link = link, .options = options});
    opened.meter.at = now;
    fill(opened, now);
    if (phase_of(options_.system) != 0) send_once(view, link, heartbeat_id);
}

// HEARTBEAT of system 1 is due at once. Other systems send theirs later in the second, so that a fleet does not burst;
// `open` has sent them one more.
void Streams::fill(LinkStreams& link, FlightTime now) {
    link.streams.clear();
    link.due.clear();
    const auto rates = rates_of_link(link.options);
    link.group_hz = group_rates(link.options);
    link.streams.reserve(rates.size());
    link.due.reserve(rates.size());
    for (const StreamRate& rate : rates) {
        const Projection* const projection = find_projection(rate.message, firmware_.is_px4());
        if (projection == nullptr || !holds(rate.when, options_)) continue;
        const Nanoseconds interval = std::max(interval_of_rate(rate.hz), shortest_interval);
        const auto rank = static_cast<std::size_t>(std::ranges::count(link.streams, interval, &Stream::asked));
        const bool is_heartbeat = projection->info.id == heartbeat_id;
        const double phase = is_heartbeat ? phase_of(options_.system) : phase_of(options_.system, rank, interval);
        link.streams.push_back({.projection = projection, .when = rate.when, .asked = interval});
        link.due.push_back(now + scaled(interval, phase));
    }
    limit(link, now);
}

// The rows of the profile, with the rates of groups from parameters, and the link's own rates in their place.
std::vector<StreamRate> Streams::rates_of_link(const LinkOptions& options) const {
    const auto rows = rates_of(options.profile);
    std::vector<StreamRate> rates(rows.begin(), rows.end());
    const auto put = [&](MessageId message, double hz) {
        if (message == heartbeat_id) return;
        std::erase_if(rates, [&](const StreamRate& rate) { return rate.message == message; });
        if (hz > 0) rates.push_back({message, hz});
    };
    const auto hz = group_rates(options);
    for (std::size_t i = 0; i < hz.size(); ++i)
        for (const MessageId message : stream_groups()[i].messages) put(message, hz[i]);
    for (const MessageRate& own : options.rates) put(own.message, own.hz);
    return rates;
}

std::vector<double> Streams::group_rates(const LinkOptions& options) const {
    constexpr double usual = 4, fastest = 1000;
    std::vector<double> rates;
    if (options.profile != Profile::ardupilot) return rates;
    for (const StreamGroup& group : stream_groups())
        rates.push_back(std::min(parameters_.get(group.parameter, usual), fastest));
    return rates;
}

void Streams::retune(FlightTime now) {
    for (LinkStreams& link : links_) {
        const auto before = std::exchange(link.group_hz, group_rates(link.options));
        for (std::size_t i = 0; i < before.size(); ++i) {
            if (link.group_hz[i] == before[i]) continue;
            for (const MessageId message : stream_groups()[i].messages)
                (void)set_interval(link.link, message, std::nullopt, now);
        }
    }
}

void Streams::close(LinkId link) {
    std::erase_if(links_, [&](const LinkStreams& l) { return l.link == link; });
}

void Streams::reset(FlightTime now) {
    for (LinkStreams& link : links_) {
        link.share = 1;
        fill(link, now);
    }
}

FlightTime Streams::next_due() const noexcept {
    FlightTime due = FlightTime::max();
    for (const LinkStreams& link : links_) due = std::min(due, link.next);
    return due;
}

void Streams::skip_missed(FlightTime now) noexcept {
    for (LinkStreams& link : links_) {
        if (link.next > now - shortest_interval) continue;
        for (std::size_t i = 0; i < link.streams.size(); ++i) {
            Stream& stream = link.streams[i];
            if (stream.interval.count() == 0 || link.due[i] > now - stream.interval) continue;
            const auto missed = (now - link.due[i]) / stream.interval;
            link.due[i] += missed * stream.interval;
            stream.skipped += static_cast<std::uint64_t>(missed);
            stream.pending += missed * stream.interval;
        }
        note_next(link);
    }
}

void Streams::run(const View& view, FlightTime at, FlightTime now) {
    for (LinkStreams& link : links_) {
        if (link.next > at) continue;
        View own = view_of(view, link, at);
        FlightTime next = FlightTime::max();
        for (std::size_t i = 0, count = link.due.size(); i < count; ++i) {
            if (link.due[i] <= at) [[unlikely]]
                run_stream(link, i, own, now);
            next = std::min(next, link.due[i]);
        }
        link.next = next;
    }
}

void Streams::run_stream(LinkStreams& link, std::size_t index, View& view, FlightTime now) {
    Stream& stream = link.streams[index];
    const FlightTime due = std::exchange(link.due[index], link.due[index] + stream.interval);
    const bool is_sent = send(link.link, stream, view, due, now);
    if (!is_sent || stream.when != When::once) return;
    stream.asked = stream.interval = Nanoseconds{0};
    link.due[index] = FlightTime::max();
}

View Streams::view_of(const View& view, LinkStreams& link, FlightTime at) const noexcept {
    const Radio::Totals now = radio_.totals(link.link);
    Meter& meter = link.meter;
    if (at - meter.at >= metering) {
        const double seconds = std::chrono::duration<double>(at - meter.at).count();
        const auto rate = [&](std::uint64_t after, std::uint64_t before) {
            return static_cast<std::uint32_t>(static_cast<double>(after - before) / seconds);
        };
        meter = {.at = at,
                 .totals = now,
                 .sent_s = rate(now.bytes, meter.totals.bytes),
                 .received_s = rate(now.received_bytes, meter.totals.received_bytes)};
    }
    View own = view;
    own.traffic = {.sent = static_cast<std::uint32_t>(now.frames),
                   .received = static_cast<std::uint32_t>(now.received_frames),
                   .sent_s = meter.sent_s,
                   .received_s = meter.received_s};
    return own;
}

bool Streams::send(LinkId link, Stream& stream, View& view, FlightTime due, FlightTime now) {
    std::array<std::uint8_t, wire::max_payload_length> payload;
    view.number = stream.number;
    const bool is_unwanted = stream.when == When::armed && !view.flight.armed();
    if (is_unwanted || !stream.projection->write(view, payload)) {
        stream.pending += stream.interval;
        return false;
    }
    if (stream.sent == 0) {
        stream.first = now;
        stream.skipped = 0;
    } else {
        stream.left_out += stream.pending;
    }
    stream.pending = Nanoseconds{0};
    stream.last = now;
    ++stream.sent;
    ++stream.number;
    stream.lateness.add(now - due);
    radio_.transmit(link, stream.projection->info, {payload.data(), stream.projection->info.max_length});
    return true;
}

void Streams::send_now(const View& view, std::span<const MessageId> messages) {
    std::array<std::uint8_t, wire::max_payload_length> payload;
    for (const MessageId id : messages) {
        const Projection* const projection = find_projection(id, firmware_.is_px4());
        if (projection == nullptr || projection->write == nullptr || !projection->write(view, payload)) continue;
        for (const LinkStreams& link : links_)
            if (streams(link, id))
                radio_.transmit(link.link, projection->info, {payload.data(), projection->info.max_length});
    }
}

bool Streams::send_once(const View& view, LinkId link, MessageId message) {
    std::array<std::uint8_t, wire::max_payload_length> payload;
    const Projection* const projection = find_projection(message, firmware_.is_px4());
    LinkStreams* const of = find(link);
    if (projection == nullptr || projection->write == nullptr || of == nullptr) return false;
    if (!projection->write(view_of(view, *of, of->meter.at), payload)) return false;
    radio_.transmit(link, projection->info, {payload.data(), projection->info.max_length});
    return true;
}

bool Streams::set_interval(LinkId link, MessageId message, std::optional<Nanoseconds> interval, FlightTime now) {
    LinkStreams* const of = find(link);
    const Projection* const projection = find_projection(message, firmware_.is_px4());
    if (of == nullptr || projection == nullptr || message == heartbeat_id) return false;
    const auto usual = interval ? std::nullopt : default_rate(of->options, message);
    Nanoseconds asked = interval.value_or(interval_of_rate(usual ? usual->hz : 0));
    if (asked.count() != 0) asked = std::max(asked, shortest_interval);
    Stream& stream = stream_of(*of, *projection);
    const auto index = static_cast<std::size_t>(&stream - of->streams.data());
    stream.when = usual ? usual->when : When::always;
    if (stream.asked == asked) return true;
    stream = {.projection = projection, .when = stream.when, .number = stream.number, .asked = asked};
    limit(*of, now);
    of->due[index] = stream.interval.count() == 0 ? FlightTime::max() : first_due(*of, index, now);
    note_next(*of);
    return true;
}

Streams::Stream& Streams::stream_of(LinkStreams& link, const Projection& projection) {
    const auto at = std::ranges::find(link.streams, &projection, &Stream::projection);
    if (at != link.streams.end()) return *at;
    link.due.push_back(FlightTime::max());
    return link.streams.emplace_back(Stream{.projection = &projection});
}

// Soon, but not at the same instant as the other streams that the client asks for.
FlightTime Streams::first_due(const LinkStreams& link, std::size_t index, FlightTime now) const noexcept {
    const Nanoseconds window = std::min(link.streams[index].interval, longest_start);
    return now + scaled(window, phase_of(options_.system, index, window));
}

std::optional<StreamRate> Streams::default_rate(const LinkOptions& options, MessageId message) const {
    const auto rates = rates_of_link(options);
    const auto rate = std::ranges::find(rates, message, &StreamRate::message);
    return rate == rates.end() || !holds(rate->when, options_) ? std::nullopt : std::optional(*rate);
}

std::optional<Nanoseconds> Streams::interval(LinkId link, MessageId message) const noexcept {
    const Projection* const projection = find_projection(message, firmware_.is_px4());
    const LinkStreams* const of = find(link);
    if (projection == nullptr || of == nullptr) return std::nullopt;
    const auto at = std::ranges::find(of->streams, projection, &Stream::projection);
    return at == of->streams.end() ? Nanoseconds{0} : at->asked;
}

void Streams::scale_share(LinkId link, double factor, FlightTime now) {
    LinkStreams* const of = find(link);
    if (of == nullptr) return;
    const double before = std::exchange(of->share, std::clamp(of->share * factor, 0.05, 1.0));
    if (of->share != before) limit(*of, now);
}

// One factor for all streams but the constant ones, so that the sum fits the link: PX4's rule. The factor is at least
// 0.05. With no limit it is 1. The rest of each running interval is scaled too, so that phases stay apart.
void Streams::limit(LinkStreams& link, FlightTime now) {
    double constant = 0, rest = 0;
    for (const Stream& stream : link.streams)
        if (stream.asked.count() != 0 && stream.projection->write != nullptr)
            (is_constant(*stream.projection) ? constant : rest) += bytes_s_at(*stream.projection, stream.asked);
    double factor = 1;
    if (link.options.max_bytes_s != 0 && rest > 0)
        factor = std::clamp((link.options.max_bytes_s * link.share - constant) / rest, 0.05, 1.0);
    for (std::size_t i = 0; i < link.streams.size(); ++i) {
        Stream& stream = link.streams[i];
        const bool is_scheduled = stream.asked.count() != 0 && stream.projection->write != nullptr;
        const double scale = is_constant(*stream.projection) ? 1 : 1 / factor;
        const Nanoseconds before = std::exchange(stream.interval,
                                                 is_scheduled ? scaled(stream.asked, scale) : Nanoseconds{0});
        if (!is_scheduled) {
            link.due[i] = FlightTime::max();
        } else if (before.count() != 0 && before != stream.interval && link.due[i] > now) {
            const double change = static_cast<double>(stream.interval.count()) / static_cast<double>(before.count());
            link.due[i] = now + scaled(link.due[i] - now, change);
        }
    }
    note_next(link);
}

void Streams::note_next(LinkStreams& link) noexcept {
    FlightTime next = FlightTime::max();
    for (const FlightTime due : link.due) next = std::min(next, due);
    link.next = next;
}

bool Streams::streams(const LinkStreams& link, MessageId message) noexcept {
    return std::ranges::any_of(link.streams, [&](const Stream& stream) {
        return stream.projection->info.id == message && stream.interval.count() != 0;
    });
}

std::vector<StreamReport> Streams::reports(LinkId link) const {
    std::vector<StreamReport> reports;
    if (const LinkStreams* const of = find(link))
        for (const Stream& stream : of->streams)
            if (stream.interval.count() != 0 || stream.sent != 0)
                reports.push_back(report_of(radio_.system(), link, stream));
    return reports;
}

StreamReport Streams::report_of(SystemId system, LinkId link, const Stream& stream) {
    const auto time = std::chrono::duration<double>(stream.last - stream.first - stream.left_out).count();
    return {.system = system,
            .link = link,
            .message = stream.projection->info.id,
            .name = stream.projection->name,
            .asked_hz = hz_of(stream.asked),
            .achieved_hz = stream.sent < 2 || time <= 0 ? 0 : static_cast<double>(stream.sent - 1) / time,
            .sent = stream.sent,
            .skipped = stream.skipped,
            .lateness = stream.lateness};
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
