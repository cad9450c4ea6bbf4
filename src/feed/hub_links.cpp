// SPDX-License-Identifier: MIT
#include "feed/hub_links.hpp"

#include <algorithm>

#include "mavloom/link/silence_watch.hpp"

namespace mavloom::feed {
namespace {

constexpr auto maintain_interval = std::chrono::seconds(1);
constexpr std::size_t ring_frames_a_turn = 4096;  // in total, over all lossy rings

}  // namespace

HubLinks::HubLinks(Sources sources) : sources_(std::move(sources)) { links().make_independent(); }

void HubLinks::turn(MonoTime deadline) {
    for (const auto& [endpoint, entry] : open_)
        if (entry.is_lossless) sources_.hold_ring(endpoint, !entry.channel->has_room());
    sources_.turn(*this, std::min(deadline, maintain_due_), {0, Channel::frames_a_turn, ring_frames_a_turn});
    for (const auto& [endpoint, entry] : open_) entry.channel->publish();
    maintain_recorders();
}

void HubLinks::maintain_recorders() {
    const auto now = mono_now();
    if (now < maintain_due_) return;
    maintain_due_ = now + maintain_interval;
    for (const auto& [endpoint, entry] : open_) entry.channel->maintain_recorders();
}

void HubLinks::close_channels() {
    for (const auto& [endpoint, entry] : open_) entry.channel->close();
}

// ---- what arrives

HubLinks::OpenLink* HubLinks::find(link::EndpointId endpoint) noexcept {
    const auto found = open_.find(endpoint);
    return found == open_.end() ? nullptr : &found->second;
}

void HubLinks::on_frame(const link::RxFrame& rx) {
    if (auto* entry = find(rx.endpoint)) entry->channel->on_frame(rx, links().now());
    else pass_answer(rx);
}

void HubLinks::on_link_up(LinkId link, link::EndpointId endpoint, std::string_view name) {
    auto* entry = find(endpoint);
    if (entry == nullptr) return;
    if (entry->is_ring) entry->channel->name_link(link, name);
    else entry->channel->on_link_up(link, name);
}

void HubLinks::on_link_down(LinkId link, link::EndpointId endpoint, std::string_view) {
    auto* entry = find(endpoint);
    if (entry == nullptr) return;
    if (!entry->is_ring) return entry->channel->on_link_down(link, links().sources(link));
    const auto name = entry->channel->names().find(link);
    entry->channel->forget_link(link, sources_.ring_losses(endpoint, name));
}

void HubLinks::on_bad_checksum(LinkId, link::EndpointId endpoint, MessageId id) {
    if (auto* entry = find(endpoint)) entry->channel->on_bad_checksum(id);
}

// Does not route: all peers of the endpoint that fills the ring get each answer.
void HubLinks::pass_answer(const link::RxFrame& rx) {
    const auto filled = filled_from_.find(rx.endpoint);
    if (filled == filled_from_.end()) return;
    auto& entry = open_.at(filled->second);
    const auto to = entry.is_ring ? open_inlet_of(filled->second).value_or(filled->second) : filled->second;
    if (links().send(to, rx.frame) == 0) ++entry.unheard_answers;
}

// ---- opening

SetupResult<Hub::Opened> HubLinks::open(const endpoint::Endpoint& endpoint, const std::shared_ptr<Channel>& channel,
                                        const ChannelReader& reader) {
    const bool is_ring = endpoint.is_ring();
    const auto added = sources_.add_live(endpoint, &channel->dialect());
    if (!added) return tl::unexpected(added.error());
    const bool is_lossless = is_ring && endpoint.options.lossless.value_or(false);
    if (is_lossless) channel->hold_for(&reader, [this] { wake(); });
    open_.emplace(*added, OpenLink{.channel = channel, .is_ring = is_ring, .is_lossless = is_lossless});
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
        if (info.id == opened.endpoint && info.endpoint.listens()) is_there = is_there || info.local_port != 0;
    if (is_there) return SetupResult<void>{};
    if (const auto* error = links().failure(opened.endpoint)) return tl::unexpected(*error);
    return std::nullopt;
}

SetupResult<link::EndpointId> HubLinks::inlet(link::EndpointId ring) {
    auto opened = open_inlet_of(ring);
    turn(MonoTime{});
    return opened;
}

SetupResult<link::EndpointId> HubLinks::open_inlet_of(link::EndpointId ring) {
    const auto opened = sources_.inlet(ring);
    if (!opened || open_.contains(*opened)) return opened;
    auto& entry = open_.at(ring);
    entry.inlet = *opened;
    open_.emplace(*opened, OpenLink{.channel = entry.channel});
    return opened;
}

SetupResult<void> HubLinks::serve_inlet(link::EndpointId endpoint, const std::string& ring, unsigned mode) {
    auto& entry = open_.at(endpoint);
    if (entry.served_inlet) return setup_error(SetupCode::usage, "this link already serves a ring's inlet");
    const auto path = link::Links::inlet_path(ring);
    if (!path) return tl::unexpected(path.error());
    const auto opened = links().add_inlet(ring, *path, mode);
    if (!opened) return tl::unexpected(opened.error());
    entry.served_inlet = *opened;
    filled_from_.emplace(*opened, endpoint);
    return {};
}

// ---- closing

// Returns the endpoint that carries sent frames: for a ring its inlet, else the endpoint itself.
link::EndpointId HubLinks::sends_through(link::EndpointId endpoint) {
    return open_.at(endpoint).inlet.value_or(endpoint);
}

bool HubLinks::is_flushed(link::EndpointId endpoint) {
    return links().queued_bytes(sends_through(endpoint)) == 0 || open_.at(endpoint).channel->peers() == 0;
}

void HubLinks::remove(link::EndpointId endpoint) {
    auto entry = std::move(open_.at(endpoint));
    open_.erase(endpoint);
    if (entry.inlet) open_.erase(*entry.inlet);
    if (entry.served_inlet) {
        filled_from_.erase(*entry.served_inlet);
        links().remove(*entry.served_inlet);
    }
    sources_.remove(endpoint);
    entry.channel->close();
}

// ---- counters

EndpointStats HubLinks::stats(link::EndpointId endpoint) {
    links().refresh_counters();
    const auto& entry = open_.at(endpoint);
    EndpointStats stats;
    add_live_counters(sends_through(endpoint), stats);
    if (entry.is_ring) {
        stats.links.add(sources_.ring_counters(endpoint));
        sources_.add_ring_to(endpoint, stats.ring);
    }
    stats.losses = entry.channel->losses();
    for (const auto& loss : sources_.losses(endpoint))
        add_to(stats.losses, entry.channel->names().find(loss.link), loss.stats);
    stats.crc_errors = entry.channel->crc_errors();
    if (entry.served_inlet) stats.answers = frames_in(*entry.served_inlet);
    stats.unheard_answers = entry.unheard_answers;
    if (const auto* error = links().failure(endpoint); error != nullptr && !is_up(endpoint))
        stats.failure = error->text;
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

std::string HubLinks::silence_reason(link::EndpointId endpoint) {
    link::LinkCounters live;
    bool has_link = false;
    for (const auto& link : links().links()) {
        if (link.endpoint != endpoint) continue;
        live.add(*link.counters);
        has_link = has_link || link.up;
    }
    for (const auto& info : links().endpoints())
        if (info.id == endpoint) return link::silence_reason(info, has_link ? &live : nullptr);
    return "does a program write MAVLink to this ring?";
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
