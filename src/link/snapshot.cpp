// SPDX-License-Identifier: MIT
#include "mavloom/link/snapshot.hpp"

#include <algorithm>
#include <utility>

namespace mavloom::link {

namespace {

std::vector<NamedCount> gone_of(const EndpointCounters& counters) {
    auto all = counts_of(counters.gone);
    all.push_back({"queued", counters.gone_queued.value(), "frames that were still queued when their links ended"});
    return all;
}

}  // namespace

std::vector<NamedCount> counts_of(const LinkCounters& counters) { return counts_in(counters, link_counters); }

std::vector<NamedCount> counts_of(const EndpointCounters& counters) { return counts_in(counters, endpoint_counters); }

const Snapshot::OfLink* Snapshot::link(LinkId id) const {
    const auto at = std::ranges::lower_bound(links, id, {}, &OfLink::id);
    return at != links.end() && at->id == id ? &*at : nullptr;
}

std::string_view Snapshot::endpoint_label(EndpointId id) const {
    const auto at = std::ranges::find(endpoints, id, &OfEndpoint::id);
    return at != endpoints.end() ? std::string_view(at->label) : std::string_view{};
}

void add_endpoints(Snapshot& snapshot, const Links& links) {
    for (const auto& info : links.endpoints())
        snapshot.endpoints.push_back({info.id, info.label(), info.endpoint.scheme, info.rcvbuf_bytes,
                                      counts_of(*info.counters), gone_of(*info.counters)});
}

void add_links(Snapshot& snapshot, const Links& links, std::span<const LinkId> ids) {
    for (auto& link : links.links(ids)) {
        const auto sources = links.sources(link.id);
        snapshot.links.push_back({link.id,
                                  link.endpoint,
                                  std::move(link.name),
                                  link.up,
                                  link.rank,
                                  link.queued_bytes,
                                  link.queue_limit_bytes,
                                  counts_of(*link.counters),
                                  {sources.begin(), sources.end()},
                                  std::move(link.stages)});
    }
}

Snapshot snapshot_of(const Links& links) {
    Snapshot snapshot;
    add_endpoints(snapshot, links);
    add_links(snapshot, links, links.link_ids());
    return snapshot;
}

}  // namespace mavloom::link
