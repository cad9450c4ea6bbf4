// SPDX-License-Identifier: MIT
#include "mavloom/runtime/router_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace mavloom::runtime {

using Json = nlohmann::ordered_json;

namespace {

struct NamedCount {
    const char* name;
    std::uint64_t value;
};

// One list for JSON and metrics: what arrived and left on a link, then every loss by its name.
std::vector<NamedCount> counts_of(const LinkCounters& c, const route::LinkCounters* routed) {
    std::vector<NamedCount> all{{"frames_in", c.frames_in.value()},
                                {"bytes_in", c.bytes_in.value()},
                                {"frames_out", c.frames_out.value()},
                                {"bytes_out", c.bytes_out.value()},
                                {"lost", c.lost.value()},
                                {"late", c.late.value()},
                                {"repeated", c.duplicate.value()},
                                {"resync", c.resync.value()},
                                {"crc_error", c.crc_error.value()},
                                {"junk_bytes", c.junk_bytes.value()},
                                {"unknown_flags", c.unknown_flags.value()},
                                {"unknown_ids", c.unknown_ids.value()},
                                {"bad_signature", c.bad_signature.value()},
                                {"queue_bytes", c.queue_bytes.value()},
                                {"queue_age", c.queue_age.value()},
                                {"frames_not_sent", c.frames_not_sent.value()}};
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
                           {"out_filtered", r.out_filtered.value()},
                           {"out_rate_limited", r.out_rate_limited.value()},
                           {"out_bytes_limited", r.out_bytes_limited.value()}});
    return all;
}

std::vector<NamedCount> counts_of(const EndpointCounters& c) {
    return {{"kernel_drop", c.kernel_drop.value()},     {"wrong_peer", c.wrong_peer.value()},
            {"stray_bytes", c.stray_bytes.value()},     {"peers_refused", c.peers_refused.value()},
            {"peers_evicted", c.peers_evicted.value()}, {"send_errors", c.send_errors.value()},
            {"reconnects", c.reconnects.value()}};
}

std::vector<NamedCount> counts_of(const RecorderCounters& c) {
    return {{"frames", c.frames.value()},
            {"bytes", c.bytes.value()},
            {"queue_full", c.queue_full.value()},
            {"write_error", c.write_error.value()}};
}

std::vector<NamedCount> counts_of(const Router& router) {
    const auto& c = router.engine().counters();
    return {{"heartbeats_sent", router.heartbeats_sent()},
            {"not_signed", router.not_signed()},
            {"routes_learned", c.routes_learned.value()},
            {"routes_expired", c.routes_expired.value()},
            {"routes_evicted", c.routes_evicted.value()},
            {"recent_evicted", c.recent_evicted.value()},
            {"reboots", c.reboots.value()},
            {"duplicate_ids", c.duplicate_ids.value()}};
}

void put(Json& object, const std::vector<NamedCount>& counts) {
    for (const auto& count : counts) object[count.name] = count.value;
}

// Text from outside (names in URLs) may be any bytes: what is not UTF-8 is shown as U+FFFD.
std::string line_of(const Json& object) { return object.dump(-1, ' ', false, Json::error_handler_t::replace); }

double seconds(Nanoseconds time) { return std::chrono::duration<double>(time).count(); }

std::string endpoint_label(Router& router, EndpointId id) {
    for (const auto& info : router.links().endpoints())
        if (info.id == id) return info.label();
    return {};
}

Json link_json(Router& router, const LinkInfo& link) {
    Json object{
        {"kind", "link"}, {"link", link.name}, {"endpoint", endpoint_label(router, link.endpoint)}, {"up", link.up}};
    put(object, counts_of(*link.counters, router.engine().counters(link.id)));
    return object;
}

void add_router(Lines& lines, Router& router) {
    Json object{{"kind", "router"}, {"uptime_s", seconds(mono_now() - router.started())}};
    put(object, counts_of(router));
    lines.push_back(line_of(object));
}

void add_endpoints(Lines& lines, Router& router) {
    for (const auto& info : router.links().endpoints()) {
        Json object{{"kind", "endpoint"},
                    {"endpoint", info.label()},
                    {"scheme", scheme_name(info.endpoint.scheme)},
                    {"rcvbuf", info.rcvbuf_bytes}};
        put(object, counts_of(*info.counters));
        lines.push_back(line_of(object));
    }
}

void add_sources(Lines& lines, Router& router) {
    for (const auto& link : router.links().links()) {
        for (const auto& s : router.links().sources(link.id))
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

void add_messages(Lines& lines, Router& router) {
    for (const auto& row : router.traffic().sorted()) {
        const auto* message = router.dialect().find(row.id);
        const auto link = router.links().link_name(row.link);
        if (link.empty()) continue;  // gone
        lines.push_back(line_of({{"kind", "message"},
                                 {"link", link},
                                 {"sys", row.source.system.value},
                                 {"comp", row.source.component.value},
                                 {"id", row.id.value},
                                 {"name", message == nullptr ? Json() : Json(message->name)},
                                 {"frames", row.count},
                                 {"bytes", row.bytes},
                                 {"rate_hz", row.recent_rate_hz(wall_now())}}));
    }
}

void add_recordings(Lines& lines, const Router& router) {
    for (const auto& recorder : router.recorders()) {
        Json object{{"kind", "recording"}, {"endpoint", recorder->label()}};
        put(object, counts_of(recorder->counters()));
        lines.push_back(line_of(object));
    }
}

void add_unknown_targets(Lines& lines, const Router& router) {
    for (const auto& unknown : router.engine().unknown_targets())
        lines.push_back(line_of({{"kind", "unknown_target"},
                                 {"sys", unknown.target.system.value},
                                 {"comp", unknown.target.component.value},
                                 {"frames", unknown.frames}}));
}

}  // namespace

Lines report_links(Router& router) {
    Lines lines;
    for (const auto& link : router.links().links()) lines.push_back(line_of(link_json(router, link)));
    return lines;
}

Lines report_routes(Router& router) {
    Lines lines;
    for (const auto& r : router.engine().routes(mono_now()))
        lines.push_back(line_of({{"kind", "route"},
                                 {"sys", r.source.system.value},
                                 {"comp", r.source.component.value},
                                 {"link", router.links().link_name(r.link)},
                                 {"age_s", seconds(r.age)},
                                 {"frames", r.frames}}));
    return lines;
}

Lines report_stats(Router& router) {
    router.links().refresh_kernel_drops();
    Lines lines;
    add_router(lines, router);
    add_endpoints(lines, router);
    for (auto& line : report_links(router)) lines.push_back(std::move(line));
    add_sources(lines, router);
    add_messages(lines, router);
    add_recordings(lines, router);
    add_unknown_targets(lines, router);
    return lines;
}

// ---- metrics ---------------------------------------------------------------------------------------------------------

namespace {

// Groups samples by metric, as the format asks: all of one name stand together behind its TYPE line.
class Metrics {
public:
    void add(std::string_view prefix, const std::vector<NamedCount>& counts, std::string_view labels) {
        for (const auto& count : counts)
            sample(fmt::format("mavloom_{}_{}_total", prefix, count.name), labels, count.value);
    }
    void sample(const std::string& name, std::string_view labels, std::uint64_t value) {
        auto at = std::ranges::find(families_, name, &std::pair<std::string, std::string>::first);
        if (at == families_.end()) at = families_.insert(at, {name, fmt::format("# TYPE {} counter\n", name)});
        fmt::format_to(std::back_inserter(at->second), "{}{{{}}} {}\n", name, labels, value);
    }
    [[nodiscard]] std::string text() const {
        std::string all;
        for (const auto& [name, lines] : families_) all += lines;
        return all;
    }

private:
    std::vector<std::pair<std::string, std::string>> families_;
};

// A label's value: backslash, quote and newline are escaped.
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

}  // namespace

std::string report_metrics(Router& router) {
    router.links().refresh_kernel_drops();
    Metrics metrics;
    metrics.add("router", counts_of(router), "");
    for (const auto& info : router.links().endpoints())
        metrics.add("endpoint", counts_of(*info.counters), label("endpoint", info.label()));
    for (const auto& link : router.links().links()) {
        metrics.add("link", counts_of(*link.counters, router.engine().counters(link.id)), label("link", link.name));
        for (const auto& s : router.links().sources(link.id))
            metrics.add("source", {{"frames", s.received}, {"lost", s.lost}, {"late", s.late}},
                        source_labels(link.name, s.source));
    }
    for (const auto& row : router.traffic().sorted()) {
        const auto link = router.links().link_name(row.link);
        if (link.empty()) continue;
        const auto* message = router.dialect().find(row.id);
        const auto name = message == nullptr ? fmt::format("{}", row.id.value) : std::string(message->name);
        metrics.add("message", {{"frames", row.count}, {"bytes", row.bytes}},
                    fmt::format("{},{}", source_labels(link, row.source), label("message", name)));
    }
    for (const auto& recorder : router.recorders())
        metrics.add("recording", counts_of(recorder->counters()), label("endpoint", recorder->label()));
    return metrics.text();
}

// ---- requests --------------------------------------------------------------------------------------------------------

namespace {

constexpr std::array commands{"links", "routes", "stats", "add", "remove"};

Lines failed(std::string_view why) { return {line_of({{"ok", false}, {"error", why}})}; }

Lines with_end(Lines lines) {
    lines.push_back(line_of({{"ok", true}}));
    return lines;
}

Lines add(Router& router, const std::string& url) {
    const auto endpoint = parse_router_endpoint(url);
    if (!endpoint) return failed(endpoint.error().text);
    const auto added = router.add(*endpoint);
    return added ? with_end({}) : failed(added.error().text);
}

// An endpoint or a recording by its name.
Lines remove(Router& router, const std::string& name) {
    if (router.remove(name)) return with_end({});
    return failed(fmt::format("there is no endpoint {}; links shows them", name));
}

std::string text_at(const Json& request, const char* key) {
    const auto at = request.find(key);
    return at != request.end() && at->is_string() ? at->get<std::string>() : std::string();
}

}  // namespace

SetupResult<Endpoint> parse_router_endpoint(std::string_view text) {
    auto endpoint = parse_endpoint(text);
    if (!endpoint) return endpoint;
    const bool has_port = endpoint->scheme != Scheme::tlog && endpoint->scheme != Scheme::serial &&
                          endpoint->scheme != Scheme::shm;
    if (has_port && endpoint->address.port == 0)
        return setup_error(SetupCode::usage,
                           fmt::format("{}: a router's port is known to others; name one", endpoint->label()));
    return endpoint;
}

Lines answer_request(Router& router, std::string_view request) {
    const auto parsed = Json::parse(request, nullptr, false);
    if (!parsed.is_object()) return failed("a request is one JSON object a line, as in {\"cmd\":\"links\"}");
    const auto command = text_at(parsed, "cmd");
    if (command == "links") return with_end(report_links(router));
    if (command == "routes") return with_end(report_routes(router));
    if (command == "stats") return with_end(report_stats(router));
    if (command == "add") return add(router, text_at(parsed, "url"));
    if (command == "remove") return remove(router, text_at(parsed, "name"));
    return failed(fmt::format("there is no command '{}'; there are {}", command, fmt::join(commands, ", ")));
}

}  // namespace mavloom::runtime
