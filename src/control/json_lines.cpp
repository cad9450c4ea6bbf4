// SPDX-License-Identifier: MIT
#include "control/json_lines.hpp"

#include <array>
#include <cstddef>
#include <string_view>

namespace mavloom::control {

void append_line(std::string& text, Json object, std::span<const link::NamedCount> counts) {
    for (const auto& count : counts) object[std::string(count.name)] = count.value;
    text.append(object.dump(-1, ' ', false, Json::error_handler_t::replace)).push_back('\n');
}

void append_endpoint(std::string& text, const link::Snapshot::OfEndpoint& endpoint) {
    append_line(text,
                {{"kind", "endpoint"},
                 {"endpoint", endpoint.label},
                 {"scheme", endpoint::scheme_name(endpoint.scheme)},
                 {"rcvbuf", endpoint.rcvbuf_bytes}},
                endpoint.counts);
}

void append_gone(std::string& text, const link::Snapshot::OfEndpoint& endpoint) {
    append_line(text, {{"kind", "gone"}, {"endpoint", endpoint.label}}, endpoint.gone);
}

static std::string_view name_of(Rank rank) noexcept {
    constexpr std::array<std::string_view, 3> names{"stranger", "own", "verified"};
    return names[static_cast<std::size_t>(rank)];
}

void append_link(std::string& text, const link::Snapshot& snapshot, const link::Snapshot::OfLink& link) {
    append_line(text,
                {{"kind", "link"},
                 {"link", link.name},
                 {"endpoint", snapshot.endpoint_label(link.endpoint)},
                 {"up", link.up},
                 {"rank", name_of(link.rank)},
                 {"queued_bytes", link.queued_bytes},
                 {"queue_limit_bytes", link.queue_limit_bytes},
                 {"faults", link.stages.empty() ? "off" : link.stages}},
                link.counts);
}

void append_sources(std::string& text, const link::Snapshot::OfLink& link) {
    for (const auto& s : link.sources)
        append_line(text, {{"kind", "source"},
                           {"link", link.name},
                           {"sys", s.source.system.value},
                           {"comp", s.source.component.value},
                           {"frames", s.received},
                           {"lost", s.lost},
                           {"late", s.late},
                           {"repeated", s.duplicate},
                           {"resync", s.resync},
                           {"no_sequence", s.no_sequence}});
}

}  // namespace mavloom::control
