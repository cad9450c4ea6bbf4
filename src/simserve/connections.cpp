// SPDX-License-Identifier: MIT
#include "simserve/connections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/endpoint/checks.hpp"

namespace mavloom::simserve {

namespace {

constexpr std::size_t frames_per_turn = 4096;  // of rings that are read

// Half of what the line carries with ten bits a byte, as PX4 does: the rest is for answers and parameters.
std::uint32_t usual_limit(const endpoint::Endpoint& endpoint) noexcept {
    if (endpoint.scheme != endpoint::Scheme::serial) return 0;
    constexpr std::uint32_t usual_baud = 57600;  // of telemetry radios, for baud=auto
    return (endpoint.options.baud == 0 ? usual_baud : endpoint.options.baud) / 20;
}

LinkRates rates_of(const SimEndpoint& given, const SimulatorOptions& options) {
    constexpr std::uint64_t most = 0xFFFF'FFFF;
    const auto limit = given.endpoint.options.max_bytes_per_s;
    LinkRates rates{
        .profile = given.profile ? given.profile : options.profile,
        .max_bytes_s = limit ? static_cast<std::uint32_t>(std::min(*limit, most)) : usual_limit(given.endpoint),
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
    if (endpoint.scheme == endpoint::Scheme::tlog)
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
    const auto endpoint = without_limit(given.endpoint);
    const LinkRates rates = rates_of(given, parts_.options);
    if (endpoint.scheme == endpoint::Scheme::shm) return add_ring(endpoint, rates);
    const auto added = parts_.links.add(endpoint);
    if (!added) return tl::unexpected(added.error());
    places_[*added].rates = rates;
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
    places_[*ring].is_one_link = true;
    Place& place = places_[*sends];
    place.rates = rates;
    place.ring = *ring;
    return {};
}

SetupResult<void> Connections::open_inlet(const config::RingConfig& config, const std::filesystem::path& socket) {
    const auto added = parts_.links.add_inlet(config.name, socket, config.mode);
    if (!added) return tl::unexpected(added.error());
    inlet_ = *added;
    places_[*added] = {.link = parts_.shared.ring_link(), .is_one_link = true};
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
    const auto place = places_.find(endpoint);
    const auto ring = place == places_.end() ? std::nullopt : place->second.ring;
    places_.erase(endpoint);
    if (!ring) return parts_.links.remove(endpoint);
    places_.erase(*ring);
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

void Connections::open_ring_link() {
    if (const LinkId link = parts_.shared.ring_link(); link != LinkId{})
        open(link, {.profile = parts_.options.profile, .rates = parts_.options.rates}, parts_.shared.ring_link_name());
}

void Connections::open(LinkId link, const LinkRates& rates, std::string_view name) {
    open_[link] = name;
    parts_.fleet.open(link, rates, now());
}

void Connections::close(LinkId link) {
    const auto opened = open_.find(link);
    if (opened == open_.end()) return;
    if (parts_.options.keeps_reports) {
        if (closed_.size() == most_closed_reports) closed_.erase(closed_.begin());
        closed_.push_back(report_of(link, opened->second));
    }
    open_.erase(opened);
    parts_.fleet.close(link);
}

void Connections::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    Place& place = places_[endpoint];
    if (place.is_one_link && endpoint != inlet_) return;  // a link in a ring that is read
    parts_.shared.on_link_up(link, name);
    if (place.lines.spend()) parts_.notice(config::LogLevel::info, fmt::format("{}: up", name));
    if (place.is_one_link) return;
    if (place.ring) places_[*place.ring].link = link;
    open(link, place.rates, name);
}

void Connections::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view why) {
    Place& place = places_[endpoint];
    if (place.is_one_link && endpoint != inlet_) return;
    if (place.lines.spend())
        parts_.notice(config::LogLevel::info, fmt::format("{}: down, {}", parts_.links.link_name(link), why));
    parts_.shared.on_link_down(link);
    if (place.ring) places_[*place.ring].link.reset();
    close(link);
}

void Connections::on_notice(link::EndpointId, std::string_view text) { parts_.notice(config::LogLevel::info, text); }

void Connections::refill_lines() {
    for (auto& [endpoint, place] : places_)
        if (const auto suppressed = place.lines.refill(); suppressed != 0)
            parts_.notice(config::LogLevel::info, counted(suppressed, "more link") + " came or went");
}

// ---- frames ---------------------------------------------------------------------------------------------------------

void Connections::on_frame(const link::RxFrame& rx) {
    ++frames_received_;
    const auto place = places_.find(rx.endpoint);
    if (place == places_.end() || (place->second.is_one_link && !place->second.link)) return;
    parts_.fleet.receive(place->second.link.value_or(rx.link), rx.frame, rx.info, now());
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
