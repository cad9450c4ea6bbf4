// SPDX-License-Identifier: MIT
#include "router/silence_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mavloom/endpoint/grammar.hpp"

namespace mavloom::router {

namespace {

std::string advice_for(const endpoint::Endpoint& endpoint) {
    switch (endpoint.scheme) {
        case endpoint::Scheme::serial:
            return fmt::format(
                "is it the right port, is the baud rate right ({}), are the wires crossed (TX to RX), and "
                "does the far side send MAVLink on that port?",
                endpoint.options.baud == 0 ? std::string("baud=auto found none yet")
                                           : fmt::format("{} here; baud=auto tries a list", endpoint.options.baud));
        case endpoint::Scheme::tcpout:
            return fmt::format("{} accepted the connection: does it send MAVLink?", endpoint::to_text(endpoint.address));
        case endpoint::Scheme::udpbcast:
            return fmt::format(
                "does a program on that network listen on port {}, and does the firewall let answers through?",
                endpoint.address.port);
        case endpoint::Scheme::udpmcast:
            return fmt::format("is a program in the group {}, on the network that iface= or the routing table selects?",
                               endpoint::to_text(endpoint.address));
        default:
            return fmt::format(
                "does the far side listen on {}, and does it answer every sender? PX4 answers only the "
                "first one: restart it after this router",
                endpoint::to_text(endpoint.address));
    }
}

std::string evidence(const link::EndpointInfo& info, const link::LinkCounters& link) {
    if (link.bad_signature.value() != 0)
        return fmt::format(
            "{} frames arrived without the signature that verify= requires: do both sides use the same key?",
            link.bad_signature.value());
    if (info.counters->wrong_peer.value() != 0)
        return fmt::format(
            "{} datagrams came from an address other than {}: if the far side answers from another port, "
            "receive with udpin://",
            info.counters->wrong_peer.value(), endpoint::to_text(info.endpoint.address));
    if (link.junk_bytes.value() + link.crc_error.value() == 0) return {};
    const bool is_serial = info.endpoint.scheme == endpoint::Scheme::serial;
    return fmt::format("the received bytes are not MAVLink ({} bytes, {} damaged frames): {}", link.junk_bytes.value(),
                       link.crc_error.value(),
                       is_serial ? "is the baud rate right (baud=auto tries a list)?" : "is it the right port?");
}

}  // namespace

void SilenceWatch::add(LinkId link, link::EndpointId endpoint) {
    if (std::ranges::find(reported_, endpoint) == reported_.end()) watched_.push_back({link, endpoint});
}

void SilenceWatch::remove(LinkId link) {
    std::erase_if(watched_, [&](const Watched& w) { return w.link == link; });
}

std::vector<SilenceWatch::Silent> SilenceWatch::look(const CountersOf& counters_of, MonoTime now) {
    std::vector<Silent> silent;
    std::erase_if(watched_, [&](Watched& w) {
        const link::LinkCounters* const counters = counters_of(w.link);
        if (counters == nullptr || counters->frames_in.value() != 0) return true;
        const std::uint64_t refused = counters->refused.value();
        const bool is_refused = std::exchange(w.refused, refused) != refused;
        if (counters->frames_out.value() != 0) w.since = is_refused ? now : std::min(w.since, now);
        const bool is_silent = w.since != MonoTime::max() && now - w.since >= patience;
        if (is_silent) silent.push_back({w.link, w.endpoint});
        return is_silent;
    });
    for (const Silent& s : silent) reported_.push_back(s.endpoint);
    return silent;
}

bool expects_answer(const endpoint::Endpoint& endpoint) noexcept {
    return endpoint::sends_first(endpoint.scheme) && !endpoint.options.tap;
}

std::string silence_text(const link::EndpointInfo& info, const link::LinkCounters& link) {
    const auto found = evidence(info, link);
    return fmt::format("{}: nothing heard for 5 s; {}", info.label(), found.empty() ? advice_for(info.endpoint) : found);
}

}  // namespace mavloom::router
