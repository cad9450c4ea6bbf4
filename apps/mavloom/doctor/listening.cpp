// SPDX-License-Identifier: MIT
#include "doctor/listening.hpp"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <utility>

#include "frames/receiving.hpp"
#include "page/page_hop.hpp"
#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t doctor_buffer_bytes = 64u << 20, max_heard_links = 4096;
constexpr auto tick_interval = 500ms;
// A router tries a closed port again after a second, and its counters are up to half a second old.
constexpr auto settling_time = 2s;
constexpr int frames_between_ticks = 512;

observe::Listened::Kind kind_of(const endpoint::Endpoint& endpoint) {
    using Kind = observe::Listened::Kind;
    if (endpoint.is_recording()) return Kind::recording;
    if (endpoint.is_ring()) return Kind::ring;
    if (endpoint.row().form == endpoint::Form::device) return Kind::serial;
    return endpoint.listens() ? Kind::listens : Kind::calls;
}

// A recording is called as the user calls it.
std::string name_of(const endpoint::Endpoint& endpoint) {
    return endpoint.is_recording() && endpoint.options.name.empty() ? endpoint.path : endpoint.label();
}

observe::Listened listened_of(const endpoint::Endpoint& endpoint, Listening::Asked asked) {
    observe::Listened its{
        .name = name_of(endpoint), .kind = kind_of(endpoint), .is_asked = asked == Listening::Asked::yes};
    if (its.kind == observe::Listened::Kind::serial) its.baud = endpoint.options.baud;
    if (endpoint.row().carrier == endpoint::Carrier::udp) its.rcvbuf_asked = endpoint.options.rcvbuf_bytes;
    return its;
}

void add_to(std::vector<observe::NamedCount>& to, const std::vector<link::NamedCount>& counts) {
    for (const auto& its : counts)
        if (its.value != 0) to.push_back({std::string(its.name), its.value});
}

// Errors of the system repeat the name of the source, which stands before them anyway.
std::string without_name(const std::string& text, const std::string& name) {
    const auto prefix = name + ": ";
    return text.starts_with(prefix) ? text.substr(prefix.size()) : text;
}

bool is_evidence(const SetupError& error, const endpoint::Endpoint& endpoint) {
    return error.code != SetupCode::usage && !endpoint.is_recording();
}

}  // namespace

SetupResult<std::unique_ptr<Listening>> Listening::create(const Common& common, const dialect::Dialect& dialect,
                                                          std::vector<HopReporter::Program> programs) {
    // The findings state all that a notice would.
    const auto notice = [&common](std::string_view text) {
        if (common.verbose > 0) print_event(common, text);
    };
    auto receiver = feed::Receiver::create(dialect, doctor_buffer_bytes, notice, feed::Copies::left_out);
    if (!receiver) return tl::unexpected(std::move(receiver.error()));
    return std::unique_ptr<Listening>(new Listening(common, dialect, std::move(programs), std::move(*receiver)));
}

SetupResult<void> Listening::add(const endpoint::Endpoint& endpoint, Asked asked) {
    are_recordings_ = endpoint.is_recording();
    total_bytes_ += recorded_bytes(endpoint);
    auto& source = *sources_.emplace_back(std::make_unique<OfSource>(endpoint, asked, dialect_));
    auto added = receiver_->add(endpoint);
    if (added) {
        source.id = *added;
        return {};
    }
    if (!is_evidence(added.error(), endpoint)) return tl::unexpected(std::move(added.error()));
    source.listened.is_taken = added.error().code == SetupCode::in_use;
    source.listened.refusal = without_name(added.error().text, source.listened.name);
    return {};
}

bool Listening::is_any_open() const {
    return std::ranges::any_of(sources_, [](const auto& source) { return source->listened.refusal.empty(); });
}

std::vector<observe::Hop> Listening::hops() const {
    std::vector<observe::Hop> all;
    for (const auto& program : programs_)
        if (auto hop = hop_of_page(program.page)) all.push_back(std::move(*hop));
    return all;
}

void Listening::run(Nanoseconds time) {
    Progress progress(common_);
    hops_before_ = hops();
    const auto begin = mono_now();
    const auto end = are_recordings_ ? MonoTime::max() : begin + time;
    const auto settled_at = begin + settling_time;
    receiver_->start(end);
    while (receiver_->wait()) {
        const Instant now{wall_now(), mono_now()};
        const auto examined_until = examine_some(now);
        if (now.mono < tick_at_) continue;
        tick_at_ = now.mono + tick_interval;
        tick(examined_until);
        if (hops_settled_.empty() && now.mono >= settled_at) hops_settled_ = hops();
        show_progress(progress, now.mono, end);
    }
    receiver_->join();
    // Without an open source, the programs of this machine are still watched.
    while (!is_any_open() && !programs_.empty() && !Signals::received() && mono_now() < end) {
        ::poll(nullptr, 0, 100);  // a signal ends the wait
        show_progress(progress, mono_now(), end);
    }
    listened_ = mono_now() - begin;
}

Listening::OfSource::OfSource(const endpoint::Endpoint& given, Asked asked, const dialect::Dialect& dialect)
    : endpoint(given), listened(listened_of(given, asked)), probe(given), inspector(dialect), log(dialect.wire_table()) {}

// For a recording, each time is its own, and never goes back.
void Listening::OfSource::examine(const observe::Heard& heard) {
    if (!first) first = heard.time;
    latest = std::max(latest.value_or(heard.time), heard.time);
    auto at = heard;
    if (endpoint.is_recording()) at.now = MonoTime{latest->time_since_epoch()};
    inspector.add(at);
    streams.add(at);
    asked_rates.take(at);
    radios.take(at);
}

// Frames wait for us if the terminal is halted.
Listening::Instant Listening::examine_some(Instant now) {
    constexpr Nanoseconds longest_halt = 10min;
    Instant at = now;
    for (int i = 0; i < frames_between_ticks; ++i) {
        const auto entry = receiver_->next();
        if (!entry) return now;
        const auto waited = std::clamp<Nanoseconds>(now.wall - entry->time, {}, longest_halt);
        at = {now.wall - waited, now.mono - waited};
        examine(*entry, at.mono);
    }
    return at;
}

void Listening::examine(const record::FrameQueue::Entry& entry, MonoTime now) {
    auto* const source = source_of(entry.link);
    if (source == nullptr) return;
    const observe::Heard heard{entry.frame, entry.link, receiver_->link_name(entry.link), entry.time, now};
    source->examine(heard);
    if (sources_.size() > 1) source->log.add(heard);
}

Listening::OfSource* Listening::source_of(LinkId link) {
    if (link == last_link_ && last_source_ != nullptr) return last_source_;
    const auto endpoint = receiver_->endpoint_of(link);
    const auto at = std::ranges::find(sources_, endpoint, [](const auto& source) { return source->id; });
    if (at == sources_.end()) return nullptr;
    const bool is_known = std::ranges::find(links_, link, &observe::HeardLink::id) != links_.end();
    const bool is_recording = (*at)->endpoint.is_recording();
    auto name = is_recording ? (*at)->listened.name : std::string(receiver_->link_name(link));
    if (!is_known && links_.size() < max_heard_links)
        links_.push_back({link, std::move(name), static_cast<std::size_t>(at - sources_.begin())});
    last_link_ = link;
    return last_source_ = at->get();
}

// The end of a recording is no silence.
void Listening::tick(Instant now) {
    for (const auto& source : sources_)
        if (!are_recordings_) source->inspector.tick(now.wall, now.mono);
}

std::uint64_t Listening::frames() const {
    std::uint64_t sum = 0;
    for (const auto& source : sources_) sum += source->inspector.latest().frames();
    return sum;
}

void Listening::show_progress(Progress& progress, MonoTime now, MonoTime end) {
    if (!progress.is_due()) return;
    if (!are_recordings_) {
        const auto left = std::chrono::ceil<std::chrono::seconds>(std::max<Nanoseconds>(end - now, {}));
        progress.show(fmt::format("listening, {} s left ({} frames)", left.count(), frames()));
        return;
    }
    const auto done = bytes_read(*receiver_);
    progress.show({.frames = frames(),
                   .bytes = done,
                   .part = total_bytes_ == 0
                               ? std::nullopt
                               : std::optional(static_cast<double>(done) / static_cast<double>(total_bytes_))});
}

void Listening::add_source(observe::Evidence& evidence, OfSource& source, const feed::Receiver::Counts& counts) {
    auto& its = source.listened;
    its.duration = listened_;
    if (are_recordings_) its.duration = source.first ? *source.latest - *source.first : Nanoseconds{};
    evidence.duration = std::max(evidence.duration, its.duration);
    for (const auto& endpoint : counts.endpoints) {
        if (endpoint.endpoint != source.id) continue;
        add_to(its.counts, endpoint.counts);
        its.rcvbuf_granted = endpoint.rcvbuf_bytes;
        its.failure = without_name(endpoint.failure, its.name);
        its.silence = endpoint.silence;
    }
    const bool has_no_endpoint = source.endpoint.is_ring() || source.endpoint.is_recording();
    for (const auto& one : counts.sources) {
        if (one.endpoint != source.id || !has_no_endpoint) continue;
        its.is_up = one.is_up || one.has_ended;
        add_to(its.counts, one.counts);
    }
    if (source.probe.is_refused()) its.counts.push_back({"refused", 1});
    evidence.sources.push_back(its);
}

void Listening::add_heard(observe::Evidence& evidence, const OfSource& source) {
    const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    append(evidence.streams, observe::streams_of(source.inspector.latest()));
    append(evidence.vehicles, source.inspector.vehicles(source.latest.value_or(WallTime{})));
    append(evidence.alarms, source.inspector.alarms());
    append(evidence.radios, source.radios.all());
    evidence.senders.push_back(source.streams.all());
    evidence.asked.push_back(source.asked_rates.all());
}

void Listening::add_counts(observe::Evidence& evidence) {
    const auto counts = receiver_->counts();
    for (const auto& source : sources_) add_source(evidence, *source, counts);
    for (const auto& loss : receiver_->losses())
        evidence.losses.push_back({loss.link, std::string(receiver_->link_name(loss.link)), loss.source, loss.received,
                                   loss.lost, loss.late, loss.duplicate, loss.resync});
    for (const auto& bad : counts.bad_checksums) evidence.bad_checksums.push_back({bad.link, bad.id, bad.count});
    evidence.buffer_full = receiver_->totals().buffer_full;
}

observe::Evidence Listening::evidence() {
    observe::Evidence evidence{.dialect = &dialect_, .is_recorded = are_recordings_};
    add_counts(evidence);
    for (const auto& source : sources_) add_heard(evidence, *source);
    evidence.links = links_;
    evidence.hops_before = hops_before_;
    evidence.hops_settled = hops_settled_;
    evidence.hops_after = hops();
    const bool are_asked = std::ranges::all_of(evidence.sources, &observe::Listened::is_asked);
    for (std::size_t i = 0; are_asked && i + 1 < sources_.size(); ++i)
        evidence.passages.push_back(observe::compare(sources_[i]->log, sources_[i + 1]->log));
    return evidence;
}

}  // namespace mavloom::app
