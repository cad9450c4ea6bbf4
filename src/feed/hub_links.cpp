// SPDX-License-Identifier: MIT
#include "feed/hub_links.hpp"

#include <algorithm>

namespace mavloom::feed {
namespace {

constexpr auto look_interval = std::chrono::seconds(1);
constexpr std::size_t ring_frames_a_turn = 4096;  // in total, over all lossy rings

bool listens(endpoint::Scheme scheme) noexcept {
    return scheme == endpoint::Scheme::udpin || scheme == endpoint::Scheme::tcpin;
}

}  // namespace

HubLinks::HubLinks(Sources sources) : sources_(std::move(sources)) { links().make_independent(); }

void HubLinks::turn(MonoTime deadline) {
    for (const auto& [endpoint, served] : served_)
        if (served.is_lossless) sources_.hold_ring(endpoint, !served.channel->has_room());
    sources_.turn(*this, std::min(deadline, look_due_), {0, Channel::frames_a_turn, ring_frames_a_turn});
    for (const auto& [endpoint, served] : served_) served.channel->publish();
    look_after_recorders();
}

void HubLinks::look_after_recorders() {
    const auto now = mono_now();
    if (now < look_due_) return;
    look_due_ = now + look_interval;
    for (const auto& [endpoint, served] : served_) served.channel->look_after_recorders();
}

void HubLinks::close_channels() {
    for (const auto& [endpoint, served] : served_) served.channel->close();
}

// ---- what arrives

HubLinks::Served* HubLinks::served_by(link::EndpointId endpoint) noexcept {
    const auto found = served_.find(endpoint);
    return found == served_.end() ? nullptr : &found->second;
}

void HubLinks::on_frame(const link::RxFrame& rx) {
    if (auto* served = served_by(rx.endpoint)) served->channel->on_frame(rx, links().now());
    else pass_answer(rx);
}

void HubLinks::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    auto* served = served_by(endpoint);
    if (served == nullptr) return;
    if (served->is_ring) served->channel->name_link(link, name);
    else served->channel->on_link_up(link, name);
}

void HubLinks::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view) {
    auto* served = served_by(endpoint);
    if (served == nullptr) return;
    if (!served->is_ring) return served->channel->on_link_down(link, links().sources(link));
    const auto name = served->channel->names().find(link);
    served->channel->forget_link(link, sources_.ring_losses(endpoint, name));
}

void HubLinks::on_bad_checksum(LinkId, link::EndpointId endpoint, MessageId id) {
    if (auto* served = served_by(endpoint)) served->channel->on_bad_checksum(id);
}

// Does not route: all peers of the endpoint that fills the ring get each answer.
void HubLinks::pass_answer(const link::RxFrame& rx) {
    const auto filled = filled_from_.find(rx.endpoint);
    if (filled == filled_from_.end()) return;
    auto& served = served_.at(filled->second);
    const auto to = served.is_ring ? open_way_out(filled->second).value_or(filled->second) : filled->second;
    if (links().send(to, rx.frame) == 0) ++served.unheard_answers;
}

// ---- opening

SetupResult<Hub::Opened> HubLinks::open(const endpoint::Endpoint& endpoint, const std::shared_ptr<Channel>& channel,
                                        const Consumer& reader) {
    const bool is_ring = endpoint.scheme == endpoint::Scheme::shm;
    const auto* own = &channel->dialect();
    const auto added = is_ring ? sources_.add_ring(endpoint, own) : links().add(endpoint, own);
    if (!added) return tl::unexpected(added.error());
    const bool is_lossless = is_ring && endpoint.options.lossless.value_or(false);
    if (is_lossless) channel->hold_for(&reader, [this] { wake(); });
    served_.emplace(*added, Served{.channel = channel, .is_ring = is_ring, .is_lossless = is_lossless});
    turn(MonoTime{});
    Hub::Opened opened{*added, 0, endpoint.label(), is_ring};
    for (const auto& info : links().endpoints()) {
        if (info.id != *added) continue;
        opened.port = info.local_port;
        opened.name = info.label();
    }
    return opened;
}

bool HubLinks::is_up(link::EndpointId endpoint) const {
    const auto links = sources_.links().links();
    return std::ranges::any_of(links, [&](const auto& link) { return link.endpoint == endpoint && link.up; });
}

std::optional<SetupResult<void>> HubLinks::far_side(const Hub::Opened& opened) {
    bool is_there = opened.is_ring || is_up(opened.endpoint);  // a required ring existed when it was added
    for (const auto& info : links().endpoints())
        if (info.id == opened.endpoint && listens(info.endpoint.scheme)) is_there = is_there || info.local_port != 0;
    if (is_there) return SetupResult<void>{};
    if (const auto* error = links().failure(opened.endpoint)) return tl::unexpected(*error);
    return std::nullopt;
}

SetupResult<link::EndpointId> HubLinks::inlet(link::EndpointId ring) {
    auto opened = open_way_out(ring);
    turn(MonoTime{});
    return opened;
}

SetupResult<link::EndpointId> HubLinks::open_way_out(link::EndpointId ring) {
    const auto opened = sources_.inlet(ring);
    if (!opened || served_.contains(*opened)) return opened;
    auto& served = served_.at(ring);
    served.inlet = *opened;
    served_.emplace(*opened, Served{.channel = served.channel});
    return opened;
}

SetupResult<void> HubLinks::serve_inlet(link::EndpointId endpoint, const std::string& ring, unsigned mode) {
    auto& served = served_.at(endpoint);
    if (served.served_inlet) return setup_error(SetupCode::usage, "this link already serves a ring's inlet");
    const auto path = link::Links::inlet_path(ring);
    if (!path) return tl::unexpected(path.error());
    const auto opened = links().add_inlet(ring, *path, mode);
    if (!opened) return tl::unexpected(opened.error());
    served.served_inlet = *opened;
    filled_from_.emplace(*opened, endpoint);
    return {};
}

// ---- closing

// Returns the endpoint that carries sent frames: for a ring its inlet, else the endpoint itself.
link::EndpointId HubLinks::way_out(link::EndpointId endpoint) { return served_.at(endpoint).inlet.value_or(endpoint); }

bool HubLinks::is_flushed(link::EndpointId endpoint) {
    return links().queued_bytes(way_out(endpoint)) == 0 || served_.at(endpoint).channel->peers() == 0;
}

void HubLinks::remove(link::EndpointId endpoint) {
    auto served = std::move(served_.at(endpoint));
    served_.erase(endpoint);
    if (served.inlet) served_.erase(*served.inlet);
    if (served.served_inlet) {
        filled_from_.erase(*served.served_inlet);
        links().remove(*served.served_inlet);
    }
    if (served.is_ring) sources_.remove_ring(endpoint);
    else links().remove(endpoint);
    served.channel->close();
}

// ---- counters

EndpointStats HubLinks::stats(link::EndpointId endpoint) {
    links().refresh_kernel_drops();
    const auto& served = served_.at(endpoint);
    EndpointStats stats;
    add_live_counters(way_out(endpoint), stats);
    if (served.is_ring) {
        stats.links.add(sources_.ring_counters(endpoint));
        sources_.add_ring_to(endpoint, stats.ring);
    }
    stats.losses = served.channel->losses();
    for (const auto& loss : sources_.losses(endpoint))
        add_to(stats.losses, served.channel->names().find(loss.link), loss.stats);
    stats.crc_errors = served.channel->crc_errors();
    if (served.served_inlet) stats.answers = frames_in(*served.served_inlet);
    stats.unheard_answers = served.unheard_answers;
    return stats;
}

void HubLinks::add_live_counters(link::EndpointId endpoint, EndpointStats& stats) {
    for (const auto& link : links().links()) {
        if (link.endpoint != endpoint) continue;
        stats.links.add(*link.counters);
        stats.peers += link.up;
    }
    for (const auto& info : links().endpoints()) {
        if (info.id != endpoint) continue;
        stats.endpoint = *info.counters;
        stats.links.add(info.counters->gone);
    }
}

// Sums over present and former senders.
std::uint64_t HubLinks::frames_in(link::EndpointId endpoint) {
    std::uint64_t sum = 0;
    for (const auto& link : links().links())
        if (link.endpoint == endpoint) sum += link.counters->frames_in.value();
    for (const auto& info : links().endpoints())
        if (info.id == endpoint) sum += info.counters->gone.frames_in.value();
    return sum;
}

}  // namespace mavloom::feed
