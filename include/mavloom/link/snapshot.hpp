// SPDX-License-Identifier: MIT
// A copy of the counters of all links and endpoints, for reports. Plain values; making a copy allocates.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/wire/sequence.hpp"

namespace mavloom::link {

struct NamedCount {
    std::string_view name;
    std::uint64_t value;
    std::string_view help{};  // one line, for the metrics
};

// The counters that a table lists, in its order.
template <class Counters>
[[nodiscard]] std::vector<NamedCount> counts_in(const Counters& counters, const auto& table) {
    std::vector<NamedCount> all;
    all.reserve(table.size());
    for (const auto& row : table) all.push_back({row.name, (counters.*row.word).value(), row.help});
    return all;
}
[[nodiscard]] std::vector<NamedCount> counts_of(const LinkCounters& counters);
[[nodiscard]] std::vector<NamedCount> counts_of(const EndpointCounters& counters);

struct Snapshot {
    struct OfEndpoint {
        EndpointId id;
        std::string label;
        endpoint::Scheme scheme;
        std::uint64_t rcvbuf_bytes;
        std::vector<NamedCount> counts;
        std::vector<NamedCount> gone;  // sums over its links that no longer exist
    };
    struct OfLink {
        LinkId id;
        EndpointId endpoint;
        std::string name;
        bool up;
        Rank rank;
        std::size_t queued_bytes, queue_limit_bytes;
        std::vector<NamedCount> counts;
        std::vector<wire::SequenceStats> sources;
        std::string stages{};  // LinkInfo::stages
    };

    std::vector<OfEndpoint> endpoints{};  // sorted by id, as `links` are
    std::vector<OfLink> links{};

    // Null if the link is gone.
    [[nodiscard]] const OfLink* link(LinkId id) const;
    // Empty if the endpoint is gone.
    [[nodiscard]] std::string_view endpoint_label(EndpointId id) const;
};

[[nodiscard]] Snapshot snapshot_of(const Links& links);

// For a snapshot in pieces: first the endpoints, then some links at a time, in the order of their ids.
void add_endpoints(Snapshot& snapshot, const Links& links);
void add_links(Snapshot& snapshot, const Links& links, std::span<const LinkId> ids);

}  // namespace mavloom::link
