// SPDX-License-Identifier: MIT
#include "mavloom/link/silence_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mavloom/base/counted.hpp"
#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::link {

namespace {

bool has_heard(const LinkCounters* link) noexcept { return link != nullptr && link->frames_in.value() != 0; }
// Frames that the far side refused were sent there, too.
bool has_sent(const LinkCounters* link) noexcept {
    return link != nullptr && link->frames_out.value() + link->refused.value() != 0;
}

// udpout and udpbcast send first: most programs answer the address that they hear, and no other.
std::string advice_for_unsent(const endpoint::Endpoint& endpoint) {
    return fmt::format(
        "nothing was sent there either, so the far side may not know where to send; to receive what others send to "
        "port {} of this machine, use udpin://0.0.0.0:{}",
        endpoint.address.port, endpoint.address.port);
}

// True for endpoints that send datagrams to a fixed address, and hear answers only.
bool must_send_first(const endpoint::Endpoint& endpoint) noexcept {
    const auto& row = endpoint.row();
    return endpoint.calls() && row.carrier == endpoint::Carrier::udp && row.cast != endpoint::Cast::group;
}

std::string advice_for(const EndpointInfo& info, const LinkCounters* link) {
    const auto& endpoint = info.endpoint;
    if (must_send_first(endpoint) && !has_sent(link)) return advice_for_unsent(endpoint);
    if (endpoint.accepts_clients() && link == nullptr)
        return fmt::format("no client has connected to port {}: does one try, and does the firewall let it in?",
                           info.local_port);
    const auto baud = endpoint.options.baud;
    return fmt::format(fmt::runtime(endpoint.row().if_silent), fmt::arg("address", endpoint::to_text(endpoint.address)),
                       fmt::arg("port", endpoint.address.port), fmt::arg("local_port", info.local_port),
                       fmt::arg("baud", baud == 0 ? std::string("baud=auto found none yet")
                                                  : fmt::format("{} here; baud=auto tries a list", baud)));
}

std::string evidence(const EndpointInfo& info, const LinkCounters* link) {
    const LinkCounters none;
    const LinkCounters& heard = link != nullptr ? *link : none;
    const auto& all = *info.counters;
    if (const auto bad = heard.bad_signature.value() + all.gone.bad_signature.value(); bad != 0)
        return fmt::format("{} arrived without the signature that verify= requires: do both sides use the same key?",
                           counted(bad, "frame"));
    if (all.wrong_peer.value() != 0)
        return fmt::format(
            "{} came from an address other than {}: if the far side answers from another port, receive "
            "with udpin://",
            counted(all.wrong_peer.value(), "datagram"), endpoint::to_text(info.endpoint.address));
    const auto junk = heard.junk_bytes.value() + all.gone.junk_bytes.value() + all.stray_bytes.value();
    const auto damaged = heard.crc_error.value() + all.gone.crc_error.value();
    if (junk + damaged == 0) return {};
    const bool is_serial = info.endpoint.row().form == endpoint::Form::device;
    return fmt::format("the received bytes are not MAVLink ({}, {}): {}", counted(junk, "byte"),
                       counted(damaged, "damaged frame"),
                       is_serial ? "is the baud rate right (baud=auto tries a list)?" : "is it the right port?");
}

}  // namespace

void SilenceWatch::add(EndpointId endpoint, const endpoint::Endpoint& opened, MonoTime now) {
    if (opened.row().side == endpoint::Side::reads) return;
    const bool waits = opened.listens();
    watched_.push_back({.endpoint = endpoint,
                        .waits_for_peers = waits,
                        .calls = must_send_first(opened),
                        .since = waits ? now : MonoTime::max()});
}

void SilenceWatch::remove(EndpointId endpoint) {
    std::erase_if(watched_, [&](const Watched& w) { return w.endpoint == endpoint; });
}

void SilenceWatch::on_link_up(LinkId link, EndpointId endpoint, MonoTime now) {
    const auto at = std::ranges::find(watched_, endpoint, &Watched::endpoint);
    if (at == watched_.end()) return;
    std::erase(at->links, link);
    at->links.push_back(link);
    at->refused = 0;
    at->sent_since = MonoTime::max();
    if (!at->waits_for_peers) at->since = now;
}

void SilenceWatch::on_link_down(LinkId link, const LinkCounters* counters) {
    const auto at = std::ranges::find_if(watched_, [&](Watched& w) { return std::erase(w.links, link) != 0; });
    if (at == watched_.end()) return;
    if (has_heard(counters)) {
        watched_.erase(at);
        return;
    }
    if (!at->waits_for_peers && at->links.empty()) at->since = at->sent_since = MonoTime::max();
}

// After a refusal, the time starts over: the link itself reports that no program listens.
bool SilenceWatch::is_due(Watched& watched, const LinkCounters* link, MonoTime now) {
    if (has_sent(link)) {
        const auto refused = link->refused.value();
        const bool is_refused = std::exchange(watched.refused, refused) != refused;
        watched.sent_since = is_refused ? now : std::min(watched.sent_since, now);
        return watched.sent_since <= now - patience;
    }
    return !watched.is_reported && watched.since <= now - patience;
}

std::vector<SilenceWatch::Silent> SilenceWatch::poll(const CountersOf& counters_of, MonoTime now) {
    std::vector<Silent> silent;
    std::erase_if(watched_, [&](Watched& w) {
        if (std::ranges::any_of(w.links, [&](LinkId id) { return has_heard(counters_of(id)); })) return true;
        const LinkId newest = w.links.empty() ? LinkId{} : w.links.back();
        const LinkCounters* const link = w.links.empty() ? nullptr : counters_of(newest);
        if (!is_due(w, link, now)) return false;
        silent.push_back({w.endpoint, newest});
        w.is_reported = true;
        return has_sent(link) || !w.calls;
    });
    return silent;
}

std::string silence_reason(const EndpointInfo& info, const LinkCounters* link) {
    const auto found = evidence(info, link);
    return found.empty() ? advice_for(info, link) : found;
}

std::string silence_text(const EndpointInfo& info, const LinkCounters* link) {
    return fmt::format("{}: nothing heard for 5 s; {}", info.label(), silence_reason(info, link));
}

std::vector<std::string> poll_silence(SilenceWatch& watch, const Links& links, MonoTime now) {
    const auto silent = watch.poll([&](LinkId link) { return links.counters(link); }, now);
    std::vector<std::string> texts;
    if (silent.empty()) return texts;
    const auto endpoints = links.endpoints();
    for (const auto& [endpoint, link] : silent) {
        const auto info = std::ranges::find(endpoints, endpoint, &EndpointInfo::id);
        if (info != endpoints.end()) texts.push_back(silence_text(*info, links.counters(link)));
    }
    return texts;
}

}  // namespace mavloom::link
