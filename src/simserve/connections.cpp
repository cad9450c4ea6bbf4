// SPDX-License-Identifier: MIT
#include "simserve/connections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/endpoint/checks.hpp"
#include "mavloom/fault/faults.hpp"

namespace mavloom::simserve {

namespace {

constexpr std::size_t frames_per_turn = 4096;  // of rings that are read

// Bytes that a serial line carries in a second, with ten bits a byte. 0: not a serial line.
std::uint32_t line_speed(const endpoint::Endpoint& endpoint) noexcept {
    if (endpoint.row().form != endpoint::Form::device) return 0;
    constexpr std::uint32_t usual_baud = 57600;  // of telemetry radios, for baud=auto
    return (endpoint.options.baud == 0 ? usual_baud : endpoint.options.baud) / 10;
}

// Links count real seconds, streams count seconds of the flight. 0: no limit.
std::uint32_t per_flight_second(std::uint64_t bytes_s, double speed) noexcept {
    constexpr double most = 0xFFFF'FFFF;
    if (bytes_s == 0) return 0;
    if (speed == max_speed) speed = 1;
    return static_cast<std::uint32_t>(std::clamp(static_cast<double>(bytes_s) / speed, 1.0, most));
}

LinkRates rates_of(const SimEndpoint& given, const SimulatorOptions& options) {
    const std::uint32_t line = line_speed(given.endpoint);
    // Usually half of a line, as in PX4: the rest is for answers and parameters.
    const auto limit = given.endpoint.options.max_bytes_per_s.value_or(line / 2);
    LinkRates rates{.profile = given.profile ? given.profile : options.profile,
                    .max_bytes_s = per_flight_second(limit, options.speed),
                    .line_bytes_s = line,
                    .rates = given.rates};
    rates.rates.insert(rates.rates.end(), options.rates.begin(), options.rates.end());
    return rates;
}

// The links know nothing of `max_bytes`, which limits what the vehicles stream.
endpoint::Endpoint without_limit(endpoint::Endpoint endpoint) {
    endpoint.options.max_bytes_per_s.reset();
    return endpoint;
}

}  // namespace

SetupResult<void> Simulator::check(const endpoint::Endpoint& endpoint) {
    if (endpoint.is_recording())
        return setup_error(
            SetupCode::usage,
            fmt::format("{}: a simulator writes no recordings; record the endpoint that it sends to, with "
                        "mavloom record",
                        endpoint.label()));
    return endpoint::check_link(without_limit(endpoint), endpoint::RoutingOptions::refused);
}

// ---- endpoints ------------------------------------------------------------------------------------------------------

SetupResult<void> Connections::add(const SimEndpoint& given) {
    if (auto good = Simulator::check(given.endpoint); !good) return good;
    if (parts_.options.speed == max_speed && line_speed(given.endpoint) != 0)
        return setup_error(SetupCode::usage,
                           fmt::format("{}: a serial line is too slow for --speed max", given.endpoint.label()));
    const auto endpoint = without_limit(given.endpoint);
    const LinkRates rates = rates_of(given, parts_.options);
    if (endpoint.is_ring()) return add_ring(endpoint, rates);
    const auto added = fault::add(parts_.links, endpoint);
    if (!added) return tl::unexpected(added.error());
    states_[*added].rates = rates;
    return {};
}

SetupResult<void> Connections::add_ring(const endpoint::Endpoint& endpoint, const LinkRates& rates) {
    if (!rings_)
        rings_ = std::make_unique<ring::RingSources>(parts_.links, parts_.dialect.wire_table(), ring::Copies::left_out);
    const auto ring = rings_->add(endpoint);
    if (!ring) return tl::unexpected(ring.error());
    const auto sends = rings_->find(*ring)->inlet();
    if (!sends) {
        rings_->remove(*ring);
        return tl::unexpected(sends.error());
    }
    states_[*ring].is_one_link = true;
    EndpointState& state = states_[*sends];
    state.rates = rates;
    state.ring = *ring;
    return {};
}

SetupResult<void> Connections::open_inlet(const config::RingConfig& config, const std::filesystem::path& socket) {
    const auto added = parts_.links.add_inlet(config.name, socket, config.mode);
    if (!added) return tl::unexpected(added.error());
    inlet_ = *added;
    states_[*added] = {.link = parts_.shared.ring_link(), .is_one_link = true};
    return {};
}

void Connections::close_inlet() {
    if (inlet_) forget(*std::exchange(inlet_, std::nullopt));
}

bool Connections::remove(std::string_view label) {
    for (const auto& info : parts_.links.endpoints()) {
        if (info.label() != label || info.id == inlet_) continue;
        forget(info.id);
        return true;
    }
    return close_by_name(label);
}

void Connections::forget(link::EndpointId endpoint) {
    for (const auto& link : parts_.links.links())
        if (link.endpoint == endpoint) close(link.id);
    const auto state = states_.find(endpoint);
    const auto ring = state == states_.end() ? std::nullopt : state->second.ring;
    states_.erase(endpoint);
    if (!ring) return parts_.links.remove(endpoint);
    states_.erase(*ring);
    rings_->remove(*ring);  // and the endpoint that sends to its inlet
}

bool Connections::close_by_name(std::string_view name) {
    const auto links = parts_.links.links();
    const auto found = std::ranges::find(links, name, &link::LinkInfo::name);
    if (found == links.end() || !parts_.links.close(found->id)) return false;
    close(found->id);
    return true;
}

// ---- links ----------------------------------------------------------------------------------------------------------

void Connections::open_own_links() {
    const LinkRates rates{.profile = parts_.options.profile, .rates = parts_.options.rates};
    if (const LinkId link = parts_.shared.ring_link(); link != LinkId{})
        open(link, rates, parts_.shared.ring_link_name());
    if (const LinkId link = parts_.recording.link(); link != LinkId{}) open(link, rates, parts_.recording.label());
}

bool Connections::has_partners() const noexcept {
    return std::ranges::any_of(open_, [&](const auto& open) {
        return open.first != parts_.shared.ring_link() && open.first != parts_.recording.link();
    });
}

void Connections::open(LinkId link, const LinkRates& rates, std::string_view name) {
    open_[link] = name;
    if (rates.line_bytes_s != 0) parts_.lines.open(link, rates.line_bytes_s);
    parts_.fleet.open(link, rates, now());
}

void Connections::close(LinkId link) {
    const auto opened = open_.find(link);
    if (opened == open_.end()) return;
    if (parts_.options.keeps_reports) {
        if (closed_.size() == max_closed_reports) closed_.erase(closed_.begin());
        closed_.push_back(report_of(link, opened->second));
    }
    open_.erase(opened);
    parts_.lines.close(link);
    parts_.fleet.close(link);
}

void Connections::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    EndpointState& state = states_[endpoint];
    if (state.is_one_link && endpoint != inlet_) return;  // a link in a ring that is read
    parts_.shared.on_link_up(link, name);
    if (state.lines.spend()) parts_.notice(config::LogLevel::info, fmt::format("{}: up", name));
    if (state.is_one_link) return;
    if (state.ring) states_[*state.ring].link = link;
    (void)parts_.catch_up();
    open(link, state.rates, name);
}

void Connections::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) {
    EndpointState& state = states_[endpoint];
    if (state.is_one_link && endpoint != inlet_) return;
    if (state.lines.spend())
        parts_.notice(config::LogLevel::info, fmt::format("{}: down, {}", parts_.links.link_name(link), why));
    parts_.shared.on_link_down(link);
    if (state.ring) states_[*state.ring].link.reset();
    close(link);
}

void Connections::on_notice(link::EndpointId, std::string_view text) { parts_.notice(config::LogLevel::info, text); }

void Connections::refill_lines() {
    for (auto& [endpoint, state] : states_)
        if (const auto suppressed = state.lines.refill(); suppressed != 0)
            parts_.notice(config::LogLevel::info, counted(suppressed, "more link") + " came or went");
}

// ---- frames ---------------------------------------------------------------------------------------------------------

void Connections::on_frame(const link::RxFrame& rx) {
    ++frames_received_;
    const auto state = states_.find(rx.endpoint);
    if (state == states_.end() || (state->second.is_one_link && !state->second.link)) return;
    if (!parts_.catch_up()) return;
    parts_.received.write(parts_.options.utc_at_start + now().flight, rx.frame);
    parts_.fleet.receive(state->second.link.value_or(rx.link), rx.frame, rx.info, now());
}

MonoTime Connections::rings_due() { return rings_ ? rings_->due(ring::Room(frames_per_turn)) : MonoTime::max(); }

void Connections::play_rings() {
    if (rings_) rings_->play(*this, ring::Room(frames_per_turn));
}

// ---- reports --------------------------------------------------------------------------------------------------------

LinkReport Connections::report_of(LinkId link, std::string_view name) const {
    LinkReport report{.link = std::string(name)};
    if (const auto* counters = parts_.links.counters(link)) {
        report.frames = counters->frames_out.value();
        report.bytes = counters->bytes_out.value();
        report.gaps = counters->queue_bytes.value() + counters->queue_age.value() + counters->frames_not_sent.value();
    } else if (link == parts_.shared.ring_link()) {
        report.frames = parts_.shared.frames();
        report.bytes = parts_.shared.bytes();
    } else if (link == parts_.recording.link()) {
        report.frames = parts_.recording.frames();
        report.bytes = parts_.recording.bytes();
    }
    parts_.fleet.each([&](const sim::Vehicle& vehicle) {
        auto streams = vehicle.stream_reports(link);
        std::ranges::move(streams, std::back_inserter(report.streams));
    });
    return report;
}

std::vector<LinkReport> Connections::reports() const {
    (void)parts_.links.links();  // counts the datagrams of the last turn
    std::vector<LinkReport> reports = closed_;
    for (const auto& [link, name] : open_) reports.push_back(report_of(link, name));
    return reports;
}

}  // namespace mavloom::simserve
