// SPDX-License-Identifier: MIT
#include "mavloom/router/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "router/report/json_line.hpp"

namespace mavloom::router {

namespace {

struct NamedCount {
    std::string_view name;
    std::uint64_t value;
};

template <class Counters>
std::vector<NamedCount> counts_in(const Counters& counters, const auto& table) {
    std::vector<NamedCount> all(table.size());
    std::ranges::transform(table, all.begin(), [&](const auto& counter) {
        return NamedCount{counter.name, (counters.*counter.word).value()};
    });
    return all;
}

// The counters of a link, for JSON and metrics: traffic in and out, then every kind of loss.
std::vector<NamedCount> counts_of(const link::LinkCounters& c, const route::LinkCounters* routed) {
    auto all = counts_in(c, link::link_counters);
    if (routed == nullptr) return all;
    const route::LinkCounters& r = *routed;
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
    return all;
}

std::vector<NamedCount> counts_of(const link::EndpointCounters& c) { return counts_in(c, link::endpoint_counters); }

// Sums over the links of an endpoint that are gone.
std::vector<NamedCount> gone_of(const link::EndpointCounters& c) {
    auto all = counts_of(c.gone, nullptr);
    all.push_back({"queued", c.gone_queued.value()});
    return all;
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
struct Snapshot {
    struct OfEndpoint {
        link::EndpointId id;
        std::string label;
        endpoint::Scheme scheme;
        std::uint64_t rcvbuf_bytes;
        std::vector<NamedCount> counts;
        std::vector<NamedCount> gone;
    };
    struct OfLink {
        LinkId id;
        link::EndpointId endpoint;
        std::string name;
        bool up;
        std::vector<NamedCount> counts;
        std::vector<wire::SequenceStats> sources;
    };
    struct OfRecording {
        std::string label;
        std::vector<NamedCount> counts;
    };

    const dialect::Dialect* dialect = nullptr;
    WallTime time{};
    Nanoseconds uptime{};
    std::vector<NamedCount> counts{};
    std::vector<OfEndpoint> endpoints{};  // sorted by id, as `links` are
    std::vector<OfLink> links{};
    std::vector<observe::TrafficRow> messages{};
    std::vector<OfRecording> recordings{};
    std::vector<route::UnknownTargetInfo> unknown_targets{};

    // Null if the link is gone.
    [[nodiscard]] const OfLink* link(LinkId id) const {
        const auto at = std::ranges::lower_bound(links, id, {}, &OfLink::id);
        return at != links.end() && at->id == id ? &*at : nullptr;
    }
    [[nodiscard]] std::string_view endpoint_label(link::EndpointId id) const {
        const auto at = std::ranges::find(endpoints, id, &OfEndpoint::id);
        return at != endpoints.end() ? std::string_view(at->label) : std::string_view{};
    }
};

Snapshot snapshot_of_links(Router& router) {
    Snapshot s{.dialect = &router.dialect()};
    for (const auto& info : router.links().endpoints())
        s.endpoints.push_back({info.id, info.label(), info.endpoint.scheme, info.rcvbuf_bytes,
                               counts_of(*info.counters), gone_of(*info.counters)});
    for (auto& link : router.links().links())
        s.links.push_back({link.id,
                           link.endpoint,
                           std::move(link.name),
                           link.up,
                           counts_of(*link.counters, router.engine().counters(link.id)),
                           {}});
    return s;
}

Snapshot snapshot_of_all(Router& router) {
    router.links().refresh_kernel_drops();
    Snapshot s = snapshot_of_links(router);
    s.time = wall_now();
    s.uptime = mono_now() - router.started();
    s.counts = counts_of(router);
    for (auto& link : s.links) {
        const auto sources = router.links().sources(link.id);
        link.sources.assign(sources.begin(), sources.end());
    }
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

// Groups samples by metric. The format requires all samples of one name to follow its TYPE line.
class Metrics {
public:
    void add(std::string_view prefix, const std::vector<NamedCount>& counts, std::string_view labels) {
        for (const auto& count : counts)
            sample(fmt::format("mavloom_{}_{}_total", prefix, count.name), labels, count.value);
    }
    void sample(const std::string& name, std::string_view labels, std::uint64_t value) {
        auto at = std::ranges::find(families_, name, &std::pair<std::string, std::string>::first);
        if (at == families_.end())
            at = families_.insert(at, {name, fmt::format("# TYPE {} {}\n", name, type_of(name))});
        fmt::format_to(std::back_inserter(at->second), "{}{{{}}} {}\n", name, labels, value);
    }
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const auto& [name, lines] : families_) all += lines;
        return all;
    }

private:
    // Loss is corrected when a frame arrives late or a source turns out to have restarted. These values can therefore
    // decrease, which a Prometheus counter must not, so they are gauges.
    static std::string_view type_of(std::string_view name) {
        static constexpr std::array<std::string_view, 4> judged_again{"_lost_total", "_late_total", "_repeated_total",
                                                                      "_resync_total"};
        const auto ends = [&](std::string_view end) { return name.ends_with(end); };
        return std::ranges::any_of(judged_again, ends) ? "gauge" : "counter";
    }

    std::vector<std::pair<std::string, std::string>> families_;
};

// Formats a label, with backslash, quote and newline escaped in the value.
std::string label(std::string_view name, std::string_view value) {
    std::string escaped;
    for (const char c : value) {
        if (c == '\\' || c == '"') escaped += '\\';
        if (c == '\n') escaped += "\\n";
        else escaped += c;
    }
    return fmt::format("{}=\"{}\"", name, escaped);
}

std::string source_labels(std::string_view link, Source source) {
    return fmt::format("{},sys=\"{}\",comp=\"{}\"", label("link", link), source.system.value, source.component.value);
}

std::string metrics_text(const Snapshot& s) {
    Metrics metrics;
    metrics.add("router", s.counts, "");
    for (const auto& endpoint : s.endpoints) {
        metrics.add("endpoint", endpoint.counts, label("endpoint", endpoint.label));
        metrics.add("gone", endpoint.gone, label("endpoint", endpoint.label));
    }
    for (const auto& link : s.links) {
        metrics.add("link", link.counts, label("link", link.name));
        for (const auto& source : link.sources)
            metrics.add("source", {{"frames", source.received}, {"lost", source.lost}, {"late", source.late}},
                        source_labels(link.name, source.source));
    }
    for (const auto& row : observe::TrafficTable::sorted(s.messages)) {
        const auto* link = s.link(row.link);
        if (link == nullptr) continue;
        const auto* message = s.dialect->find(row.id);
        const auto name = message == nullptr ? fmt::format("{}", row.id.value) : std::string(message->name);
        metrics.add("message", {{"frames", row.count}, {"bytes", row.bytes}},
                    fmt::format("{},{}", source_labels(link->name, row.source), label("message", name)));
    }
    for (const auto& recording : s.recordings)
        metrics.add("recording", recording.counts, label("endpoint", recording.label));
    return metrics.text();
}

}  // namespace

Later<std::string> report_metrics(Router& router) {
    return [s = snapshot_of_all(router)] { return metrics_text(s); };
}

}  // namespace mavloom::router
