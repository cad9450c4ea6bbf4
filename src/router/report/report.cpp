// SPDX-License-Identifier: MIT
#include "mavloom/router/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "mavloom/control/metrics_text.hpp"
#include "mavloom/link/snapshot.hpp"
#include "router/report/json_line.hpp"

namespace mavloom::router {

namespace {

using control::MetricsText;
using link::NamedCount;

// The router's counters of a link: the verdicts of its frames.
void append(std::vector<NamedCount>& all, const route::LinkCounters& r) {
    all.insert(all.end(), {{"forwarded", r.forwarded.value()},
                           {"nowhere", r.nowhere.value()},
                           {"filtered", r.filtered.value()},
                           {"rate_limited", r.rate_limited.value()},
                           {"duplicate", r.duplicate.value()},
                           {"echo", r.echo.value()},
                           {"unknown_target", r.unknown_target.value()},
                           {"consumed", r.consumed.value()},
                           {"tap", r.tap.value()},
                           {"private_link", r.private_link.value()},
                           {"out_filtered", r.out_filtered.value()},
                           {"out_rate_limited", r.out_rate_limited.value()},
                           {"out_bytes_limited", r.out_bytes_limited.value()}});
}

std::vector<NamedCount> counts_of(const record::RecorderCounters& c) {
    return {{"frames", c.frames.value()},
            {"bytes", c.bytes.value()},
            {"queue_full", c.queue_full.value()},
            {"write_error", c.write_error.value()}};
}

std::vector<NamedCount> counts_of(Router& router) {
    const auto& c = router.engine().counters();
    return {{"heartbeats_sent", router.heartbeats_sent()},
            {"not_signed", router.not_signed()},
            {"unknown_link", c.unknown_link.value()},
            {"unlisted", router.traffic().unlisted()},
            {"routes_learned", c.routes_learned.value()},
            {"routes_expired", c.routes_expired.value()},
            {"routes_evicted", c.routes_evicted.value()},
            {"recent_evicted", c.recent_evicted.value()},
            {"reboots", c.reboots.value()},
            {"duplicate_ids", c.duplicate_ids.value()},
            {"route_conflicts", c.route_conflicts.value()}};
}

void put(Json& object, const std::vector<NamedCount>& counts) {
    for (const auto& count : counts) object[std::string(count.name)] = count.value;
}

double seconds(Nanoseconds time) { return std::chrono::duration<double>(time).count(); }

// A copy of a router's counters, taken between two turns.
struct Snapshot : link::Snapshot {
    struct OfRecording {
        std::string label;
        std::vector<NamedCount> counts;
    };

    const dialect::Dialect* dialect = nullptr;
    WallTime time{};
    Nanoseconds uptime{};
    std::vector<NamedCount> counts{};
    std::vector<observe::TrafficRow> messages{};
    std::vector<OfRecording> recordings{};
    std::vector<route::UnknownTargetInfo> unknown_targets{};
};

Snapshot snapshot_of_links(Router& router) {
    Snapshot s{link::snapshot_of(router.links())};
    s.dialect = &router.dialect();
    for (auto& link : s.links)
        if (const auto* routed = router.engine().counters(link.id)) append(link.counts, *routed);
    return s;
}

Snapshot snapshot_of_all(Router& router) {
    router.links().refresh_kernel_drops();
    Snapshot s = snapshot_of_links(router);
    s.time = wall_now();
    s.uptime = mono_now() - router.started();
    s.counts = counts_of(router);
    s.messages = router.traffic().rows();
    for (const auto* recorder : router.recorders())
        s.recordings.push_back({recorder->label(), counts_of(recorder->counters())});
    s.unknown_targets = router.engine().unknown_targets();
    return s;
}

void add_router(Lines& lines, const Snapshot& s) {
    Json object{{"kind", "router"}, {"uptime_s", seconds(s.uptime)}};
    put(object, s.counts);
    lines.push_back(line_of(object));
}

void add_endpoints(Lines& lines, const Snapshot& s) {
    for (const auto& endpoint : s.endpoints) {
        Json object{{"kind", "endpoint"},
                    {"endpoint", endpoint.label},
                    {"scheme", endpoint::scheme_name(endpoint.scheme)},
                    {"rcvbuf", endpoint.rcvbuf_bytes}};
        put(object, endpoint.counts);
        lines.push_back(line_of(object));
    }
}

void add_gone(Lines& lines, const Snapshot& s) {
    for (const auto& endpoint : s.endpoints) {
        Json object{{"kind", "gone"}, {"endpoint", endpoint.label}};
        put(object, endpoint.gone);
        lines.push_back(line_of(object));
    }
}

void add_links(Lines& lines, const Snapshot& s) {
    for (const auto& link : s.links) {
        Json object{
            {"kind", "link"}, {"link", link.name}, {"endpoint", s.endpoint_label(link.endpoint)}, {"up", link.up}};
        put(object, link.counts);
        lines.push_back(line_of(object));
    }
}

void add_sources(Lines& lines, const Snapshot& snapshot) {
    for (const auto& link : snapshot.links) {
        for (const auto& s : link.sources)
            lines.push_back(line_of({{"kind", "source"},
                                     {"link", link.name},
                                     {"sys", s.source.system.value},
                                     {"comp", s.source.component.value},
                                     {"frames", s.received},
                                     {"lost", s.lost},
                                     {"late", s.late},
                                     {"repeated", s.duplicate},
                                     {"resync", s.resync},
                                     {"no_sequence", s.no_sequence}}));
    }
}

void add_messages(Lines& lines, const Snapshot& s) {
    for (const auto& row : observe::TrafficTable::sorted(s.messages)) {
        const auto* message = s.dialect->find(row.id);
        const auto* link = s.link(row.link);
        if (link == nullptr) continue;
        lines.push_back(line_of({{"kind", "message"},
                                 {"link", link->name},
                                 {"sys", row.source.system.value},
                                 {"comp", row.source.component.value},
                                 {"id", row.id.value},
                                 {"name", message == nullptr ? Json() : Json(message->name)},
                                 {"frames", row.count},
                                 {"bytes", row.bytes},
                                 {"rate_hz", row.recent_rate_hz(s.time)}}));
    }
}

void add_recordings(Lines& lines, const Snapshot& s) {
    for (const auto& recording : s.recordings) {
        Json object{{"kind", "recording"}, {"endpoint", recording.label}};
        put(object, recording.counts);
        lines.push_back(line_of(object));
    }
}

void add_unknown_targets(Lines& lines, const Snapshot& s) {
    for (const auto& unknown : s.unknown_targets)
        lines.push_back(line_of({{"kind", "unknown_target"},
                                 {"sys", unknown.target.system.value},
                                 {"comp", unknown.target.component.value},
                                 {"frames", unknown.frames}}));
}

Lines route_lines(const Snapshot& s, const std::vector<route::RouteInfo>& routes) {
    Lines lines;
    for (const auto& r : routes) {
        const auto* link = s.link(r.link);
        lines.push_back(line_of({{"kind", "route"},
                                 {"sys", r.source.system.value},
                                 {"comp", r.source.component.value},
                                 {"link", link == nullptr ? std::string_view{} : std::string_view(link->name)},
                                 {"age_s", seconds(r.age)},
                                 {"frames", r.frames}}));
    }
    return lines;
}

Lines stat_lines(const Snapshot& s) {
    Lines lines;
    add_router(lines, s);
    add_endpoints(lines, s);
    add_gone(lines, s);
    add_links(lines, s);
    add_sources(lines, s);
    add_messages(lines, s);
    add_recordings(lines, s);
    add_unknown_targets(lines, s);
    return lines;
}

}  // namespace

Later<Lines> report_links(Router& router) {
    return [s = snapshot_of_links(router)] {
        Lines lines;
        add_links(lines, s);
        return lines;
    };
}

Later<Lines> report_routes(Router& router) {
    return
        [s = snapshot_of_links(router), routes = router.engine().routes(mono_now())] { return route_lines(s, routes); };
}

Later<Lines> report_stats(Router& router) {
    return [s = snapshot_of_all(router)] { return stat_lines(s); };
}

// ---- metrics --------------------------------------------------------------------------------------------------------

namespace {

// Senders choose their ids, so invented ids must not grow the report without limit. The busiest sources and messages
// are listed, the rest are summed for each link.
constexpr std::size_t most_sources = 256, most_messages = 1024;

// Moves the `most` rows with the highest `count` to the front, in their present order. Returns how many those are.
template <class Row, class Count>
std::size_t put_busiest_first(std::vector<Row>& rows, std::size_t most, Count count) {
    if (rows.size() <= most) return rows.size();
    std::vector<std::uint64_t> counts(rows.size());
    std::ranges::transform(rows, counts.begin(), count);
    std::ranges::nth_element(counts, counts.begin() + static_cast<std::ptrdiff_t>(most), std::greater{});
    const std::uint64_t limit = counts[most];
    const auto rest = std::stable_partition(rows.begin(), rows.end(),
                                            [&](const Row& row) { return count(row) > limit; });
    return static_cast<std::size_t>(rest - rows.begin());
}

std::string source_labels(std::string_view link, Source source) {
    return fmt::format("{},sys=\"{}\",comp=\"{}\"", MetricsText::label("link", link), source.system.value,
                       source.component.value);
}

std::string other_labels(std::string_view link) {
    return fmt::format("{},sys=\"other\",comp=\"other\"", MetricsText::label("link", link));
}

std::vector<NamedCount> metrics_of(const wire::SequenceStats& source) {
    return {{"frames", source.received}, {"lost", source.lost}, {"late", source.late}};
}

void add_sources(MetricsText& metrics, const Snapshot& s) {
    std::vector<std::pair<const link::Snapshot::OfLink*, const wire::SequenceStats*>> rows;
    for (const auto& link : s.links)
        for (const auto& source : link.sources) rows.emplace_back(&link, &source);
    const auto listed = put_busiest_first(rows, most_sources, [](const auto& row) { return row.second->received; });
    std::map<std::string_view, wire::SequenceStats> others;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& [link, source] = rows[i];
        if (i < listed) {
            metrics.add("source", metrics_of(*source), source_labels(link->name, source->source));
            continue;
        }
        auto& other = others[link->name];
        other.received += source->received;
        other.lost += source->lost;
        other.late += source->late;
    }
    for (const auto& [name, other] : others) metrics.add("source", metrics_of(other), other_labels(name));
}

void add_messages(MetricsText& metrics, const Snapshot& s) {
    auto rows = observe::TrafficTable::sorted(s.messages);
    std::erase_if(rows, [&](const auto& row) { return s.link(row.link) == nullptr; });
    const auto listed = put_busiest_first(rows, most_messages, [](const auto& row) { return row.count; });
    std::map<std::string_view, observe::TrafficRow> others;
    const auto add = [&](const observe::TrafficRow& row, const std::string& labels, std::string_view name) {
        metrics.add("message", std::vector<NamedCount>{{"frames", row.count}, {"bytes", row.bytes}},
                    fmt::format("{},{}", labels, MetricsText::label("message", name)));
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& row = rows[i];
        const std::string_view link = s.link(row.link)->name;
        if (i >= listed) {
            others[link].count += row.count;
            others[link].bytes += row.bytes;
            continue;
        }
        const auto* message = s.dialect->find(row.id);
        add(row, source_labels(link, row.source),
            message == nullptr ? fmt::format("{}", row.id.value) : std::string(message->name));
    }
    for (const auto& [name, other] : others) add(other, other_labels(name), "other");
}

std::string metrics_text(const Snapshot& s) {
    MetricsText metrics;
    metrics.add("router", s.counts, "");
    for (const auto& endpoint : s.endpoints) {
        metrics.add("endpoint", endpoint.counts, MetricsText::label("endpoint", endpoint.label));
        metrics.add("gone", endpoint.gone, MetricsText::label("endpoint", endpoint.label));
    }
    for (const auto& link : s.links) metrics.add("link", link.counts, MetricsText::label("link", link.name));
    add_sources(metrics, s);
    add_messages(metrics, s);
    for (const auto& recording : s.recordings)
        metrics.add("recording", recording.counts, MetricsText::label("endpoint", recording.label));
    return metrics.text();
}

}  // namespace

Later<std::string> report_metrics(Router& router) {
    return [s = snapshot_of_all(router)] { return metrics_text(s); };
}

}  // namespace mavloom::router
