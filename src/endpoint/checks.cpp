// SPDX-License-Identifier: MIT
#include "mavloom/endpoint/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "mavloom/base/text.hpp"

namespace mavloom::endpoint {

static tl::unexpected<SetupError> refused(const Endpoint& endpoint, std::string_view text) {
    return setup_error(SetupCode::usage, fmt::format("{}: {}", endpoint.label(), text));
}

static SetupResult<void> check_scheme(const Endpoint& endpoint, RoutingOptions routing) {
    if (endpoint.is_recording())
        return refused(endpoint, "a recording is not a link; listen, relay, record and replay read or write it");
    if (endpoint.is_ring() && routing == RoutingOptions::by_owner)
        return refused(endpoint, fmt::format("a ring is not an endpoint of a router; --ring {} writes every frame into "
                                             "it, and forwards what programs send there",
                                             endpoint.path));
    return {};
}

static SetupResult<void> refuse_routing_options(const Endpoint& endpoint) {
    const EndpointOptions& o = endpoint.options;
    const std::pair<std::string_view, bool> routed[] = {
        {"group", !o.group.empty() || o.has_group_mode},
        {"max_rate", !o.max_rate.empty()},
        {"max_bytes", o.max_bytes_per_s.has_value()},
        {"in_allow", !o.in_allow.empty()},
        {"in_block", !o.in_block.empty()},
        {"out_allow", !o.out_allow.empty()},
        {"out_block", !o.out_block.empty()},
        {"tap", o.tap},
        {"private", o.is_private},
        {"heartbeat", o.heartbeat.has_value()},
        {"learn", o.learns_first},
    };
    const auto set = std::ranges::find(routed, true, &std::pair<std::string_view, bool>::second);
    if (set == std::end(routed)) return {};
    return refused(endpoint,
                   fmt::format("option {}= applies only to mavloom route, which decides where frames go", set->first));
}

SetupResult<void> check_supported(const Endpoint& endpoint, RoutingOptions routing) {
    if (auto good = check_scheme(endpoint, routing); !good) return good;
    if (routing == RoutingOptions::refused)
        if (auto good = refuse_routing_options(endpoint); !good) return good;
    const EndpointOptions& o = endpoint.options;
    const Cast cast = endpoint.row().cast;
    if (endpoint.is_ring() && !o.verify_key_file.empty())
        return refused(
            endpoint,
            "set verify= at the endpoint that receives the frames; the writer of the ring has already checked them");
    if (o.ttl == 0 && cast != Cast::group)
        return refused(endpoint,
                       "ttl=0 keeps datagrams of a multicast group on this machine; other datagrams need 1 to 255");
    const bool is_one_link = cast == Cast::group || (cast == Cast::broadcast && o.fixed);
    if (is_one_link && o.max_peers != EndpointOptions{}.max_peers)
        return refused(endpoint, "all senders that are heard here share one link, so max_peers= has no effect");
    if (o.queue_bytes > EndpointOptions::max_queue_bytes) return refused(endpoint, "queue_bytes= goes up to 1 GiB");
    return {};
}

SetupResult<void> check_destination(const Endpoint& endpoint) {
    const auto& [host, port] = endpoint.address;
    const SchemeRow& row = endpoint.row();
    if (host.empty()) return refused(endpoint, "a destination needs a host, as in 127.0.0.1");
    if (port == 0) return refused(endpoint, "port 0 is not a destination; give the port that the far side listens on");
    const auto address = net::Address::parse(host, port);
    if (!address) return {};
    if (address->is_any()) {
        return refused(
            endpoint,
            fmt::format(
                "{} is not a destination; to listen on all addresses type {}://{}, to send to this machine {}://{}:{}",
                host, row.counterpart, address->text(), find_scheme(row.counterpart)->counterpart,
                address->is_v4() ? "127.0.0.1" : "[::1]", port));
    }
    if (address->is_multicast())
        return refused(endpoint, fmt::format("{} is a multicast group: udpmcast://{}", host, address->text()));
    if (address->is_broadcast() && row.cast != Cast::broadcast)
        return refused(endpoint, fmt::format("{} is the broadcast address: udpbcast://{}", host, address->text()));
    return {};
}

SetupResult<std::optional<net::Address>> local_address(const Endpoint& endpoint) {
    const auto& bind = endpoint.options.bind;
    if (!bind) return std::nullopt;
    const auto address = net::Address::parse(bind->host, bind->port);
    if (!address)
        return refused(endpoint, fmt::format("bind= takes a numeric address of this machine, not '{}'", bind->host));
    return address;
}

SetupResult<void> check_link(const Endpoint& endpoint, RoutingOptions routing) {
    if (auto good = check_supported(endpoint, routing); !good) return good;
    if (!endpoint.calls() || endpoint.row().cast == Cast::group) return {};
    if (auto good = check_destination(endpoint); !good) return good;
    const auto local = local_address(endpoint);
    if (!local) return tl::unexpected(local.error());
    const auto far = net::Address::parse(endpoint.address.host, endpoint.address.port);
    if (*local && far && (*local)->family() != far->family())
        return refused(endpoint,
                       fmt::format("bind={} and {} are of different address families", (*local)->text(), far->text()));
    return {};
}

namespace {

struct OwnLog {
    std::string_view suffix, error;
};

constexpr OwnLog own_logs[] = {
    {".ulg",
     "this is PX4's own log (ULog), not a recording of MAVLink; ulog_info and ulog2csv of the Python package pyulog "
     "read it, and PlotJuggler shows it"},
    {".bin",
     "this is ArduPilot's own log (DataFlash), not a recording of MAVLink; mavlogdump.py of the Python package "
     "pymavlink reads it, and MAVExplorer or PlotJuggler show it"},
};

}  // namespace

SetupResult<void> check_recording_name(std::string_view path) {
    for (const auto& [suffix, error] : own_logs)
        if (path.size() > suffix.size() && same_letters(path.substr(path.size() - suffix.size()), suffix))
            return setup_error(SetupCode::usage, std::string(error));
    return {};
}

SetupResult<void> check_written(const Endpoint& recording) {
    if (!recording.options.speed) return {};
    return refused(recording, "'speed' applies to a recording that is read; this one is written");
}

}  // namespace mavloom::endpoint
