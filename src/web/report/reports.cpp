// SPDX-License-Identifier: MIT
#include "web/report/reports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <utility>

#include "mavloom/base/durations.hpp"
#include "web/json.hpp"

namespace mavloom::web {

namespace {

using Out = fmt::memory_buffer;

// Viewers want exactly one type for each key, objects with all their keys, and arrays with one type (Lichtblick:
// parseJsonSchema). A value may be null nevertheless.
using Keys = std::initializer_list<std::pair<std::string_view, Json>>;

Json type(std::string_view name) { return {{"type", name}}; }
Json object(Keys keys) {
    auto all = Json::object();
    for (const auto& [key, value] : keys) all[std::string(key)] = value;
    return {{"type", "object"}, {"properties", std::move(all)}};
}
Json array_of(Json entry) { return {{"type", "array"}, {"items", std::move(entry)}}; }

Json vehicle_schema() {
    const auto text = type("string"), number = type("number"), whole = type("integer");
    const auto trip = object({{"last", number}, {"least", number}, {"mean", number}, {"count", whole}});
    return object({{"sys", whole},
                   {"comp", whole},
                   {"type", text},
                   {"autopilot", text},
                   {"mode", text},
                   {"armed", type("boolean")},
                   {"status", text},
                   {"age_s", number},
                   {"silent", type("boolean")},
                   {"hz", number},
                   {"battery", object({{"percent", number}, {"voltage_v", number}, {"current_a", number}})},
                   {"gps", object({{"fix", text}, {"satellites", whole}})},
                   {"position", object({{"lat_deg", number},
                                        {"lon_deg", number},
                                        {"alt_m", number},
                                        {"relative_alt_m", number},
                                        {"heading_deg", number},
                                        {"ground_speed_m_s", number}})},
                   {"round_trip_ms", object({{"timesync", trip}, {"ping", trip}, {"command", trip}})}});
}

Json row_schema() {
    const auto text = type("string"), number = type("number"), whole = type("integer");
    return object({{"topic", text},
                   {"link", text},
                   {"sys", whole},
                   {"comp", whole},
                   {"id", whole},
                   {"name", text},
                   {"instance", text},
                   {"count", whole},
                   {"hz", number},
                   {"bytes", whole},
                   {"share", number},
                   {"gap_min_ms", number},
                   {"gap_max_ms", number},
                   {"jitter_ms", number},
                   {"age_s", number},
                   {"silent_after_s", number}});
}

Json hop_schema() {
    const auto text = type("string"), number = type("number"), whole = type("integer");
    const auto losses = array_of(object({{"name", text}, {"count", whole}, {"help", text}}));
    const auto link = object({{"name", text},
                              {"state", text},
                              {"frames_in", whole},
                              {"frames_out", whole},
                              {"bytes_in", whole},
                              {"bytes_out", whole},
                              {"hz_in", number},
                              {"hz_out", number},
                              {"losses", losses}});
    return object({{"name", text},
                   {"kind", text},
                   {"state", text},
                   {"hz_in", number},
                   {"hz_out", number},
                   {"frames_in", whole},
                   {"frames_out", whole},
                   {"losses", losses},
                   {"links", array_of(link)},
                   {"hint", text}});
}

Json alarm_schema() {
    const auto text = type("string"), number = type("number"), whole = type("integer");
    return object({{"id", whole},
                   {"kind", text},
                   {"severity", text},
                   {"link", text},
                   {"sys", whole},
                   {"comp", whole},
                   {"text", text},
                   {"since_us", number},
                   {"ended_us", number}});
}

struct Described {
    std::string_view name, list;
    Json (*entry)();
};

// By Report.
constexpr std::array described{Described{"vehicles", "vehicles", vehicle_schema},
                               Described{"traffic", "rows", row_schema}, Described{"links", "hops", hop_schema},
                               Described{"alarms", "alarms", alarm_schema}};

const Described& about(Report report) { return described[static_cast<std::size_t>(report)]; }

Json advertised(Report report) {
    const auto& its = about(report);
    auto schema = object({{"time_us", type("number")}, {its.list, array_of(its.entry())}});
    if (report != Report::traffic) schema["properties"]["left_out"] = type("integer");
    return {{"id", channel_of(report)},  {"topic", fmt::format("/mavloom/{}", its.name)},
            {"encoding", "json"},        {"schemaName", fmt::format("mavloom.{}", its.name)},
            {"schema", text_of(schema)}, {"schemaEncoding", "jsonschema"}};
}

template <class... Values>
void add(Out& out, fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(out), format, std::forward<Values>(values)...);
}

// Most texts need no escapes.
void add_text(Out& out, std::string_view text) {
    const auto is_plain = [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; };
    if (std::ranges::all_of(text, is_plain)) return add(out, "\"{}\"", text);
    add(out, "{}", text_of(Json(text)));
}

// `"key":value`, or null. Numbers that JSON does not have are null too.
void add_number(Out& out, std::string_view key, std::optional<double> value, int digits) {
    if (value && std::isfinite(*value)) return add(out, "\"{}\":{:.{}f}", key, *value, digits);
    add(out, "\"{}\":null", key);
}

// The text of a report must fit into the queue of a client.
constexpr std::size_t max_text = 160'000;

// {"time_us":1,"list":[ and, from `add_one(i)`, the entries until the text has `max_bytes`. Returns how many.
template <class AddOne>
[[nodiscard]] std::size_t add_list(Out& out, Report report, ReportTime now, std::size_t size, AddOne add_one,
                                   std::size_t max_bytes = SIZE_MAX) {
    add(out, R"({{"time_us":{},"{}":[)", unix_us(now.wall), about(report).list);
    std::size_t i = 0;
    for (; i < size && out.size() < max_bytes; ++i) {
        if (i != 0) out.push_back(',');
        add_one(out, i);
    }
    out.push_back(']');
    return i;
}

template <class AddOne>
std::string short_list(Report report, ReportTime now, std::size_t size, AddOne add_one, std::uint64_t gone = 0) {
    Out out;
    const auto added = add_list(out, report, now, size, add_one, max_text);
    add(out, R"(,"left_out":{}}})", size - added + gone);
    return fmt::to_string(out);
}

void add_enum(Out& out, std::string_view key, const dialect::Dialect& dialect, std::string_view name,
              std::uint64_t value) {
    const auto* const all = dialect.find_enum(name);
    const auto* const entry = all == nullptr ? nullptr : all->find(value);
    if (entry == nullptr) return add(out, "\"{}\":\"{}\",", key, value);
    add(out, "\"{}\":\"{}\",", key, entry->name);
}

void add_battery(Out& out, const std::optional<observe::Battery>& battery) {
    if (!battery) return add(out, R"("battery":null,)");
    add(out, R"("battery":{{)");
    add_number(out, "percent", battery->percent, 0);
    out.push_back(',');
    add_number(out, "voltage_v", battery->voltage_v, 3);
    out.push_back(',');
    add_number(out, "current_a", battery->current_a, 2);
    add(out, "}},");
}

void add_gps(Out& out, const std::optional<observe::Gps>& gps, const dialect::Dialect& dialect) {
    if (!gps) return add(out, R"("gps":null,)");
    add(out, R"("gps":{{)");
    add_enum(out, "fix", dialect, "GPS_FIX_TYPE", gps->fix);
    add_number(out, "satellites", gps->satellites ? std::optional<double>(*gps->satellites) : std::nullopt, 0);
    add(out, "}},");
}

void add_position(Out& out, const std::optional<observe::Position>& position) {
    if (!position) return add(out, R"("position":null,)");
    add(out, R"("position":{{)");
    add_number(out, "lat_deg", position->lat_deg, 7);
    out.push_back(',');
    add_number(out, "lon_deg", position->lon_deg, 7);
    out.push_back(',');
    add_number(out, "alt_m", position->alt_m, 3);
    out.push_back(',');
    add_number(out, "relative_alt_m", position->relative_alt_m, 3);
    out.push_back(',');
    add_number(out, "heading_deg", position->heading_deg, 2);
    out.push_back(',');
    add_number(out, "ground_speed_m_s", position->ground_speed_m_s, 2);
    add(out, "}},");
}

void add_round_trip(Out& out, std::string_view key, const observe::RoundTrip& trip) {
    if (trip.count == 0) return add(out, "\"{}\":null", key);
    add(out, R"("{}":{{"last":{:.3f},"least":{:.3f},"mean":{:.3f},"count":{}}})", key, milliseconds(trip.last),
        milliseconds(trip.least), milliseconds(trip.mean()), trip.count);
}

void add_vehicle(Out& out, const observe::Vehicle& vehicle, MonoTime now, const dialect::Dialect& dialect) {
    add(out, R"({{"sys":{},"comp":{},)", vehicle.source.system.value, vehicle.source.component.value);
    add_enum(out, "type", dialect, "MAV_TYPE", vehicle.type);
    add_enum(out, "autopilot", dialect, "MAV_AUTOPILOT", vehicle.autopilot);
    add(out, R"("mode":)");
    if (vehicle.mode.empty()) add(out, "null");
    else add_text(out, vehicle.mode);
    add(out, R"(,"armed":{},)", vehicle.is_armed);
    add_enum(out, "status", dialect, "MAV_STATE", vehicle.status);
    const auto age = now - vehicle.heard;
    const bool is_silent = vehicle.is_silent(now);
    add(out, R"("age_s":{:.2f},"silent":{},"hz":{:.1f},)", seconds(age), is_silent, is_silent ? 0 : vehicle.hz);
    add_battery(out, vehicle.battery);
    add_gps(out, vehicle.gps, dialect);
    add_position(out, vehicle.position);
    add(out, R"("round_trip_ms":{{)");
    add_round_trip(out, "timesync", vehicle.timesync);
    out.push_back(',');
    add_round_trip(out, "ping", vehicle.ping);
    out.push_back(',');
    add_round_trip(out, "command", vehicle.command);
    add(out, "}}}}");
}

void add_row(Out& out, const TrafficLine& row) {
    add(out, R"({{"topic":)");
    add_text(out, row.topic);
    add(out, R"(,"link":)");
    add_text(out, row.link);
    add(out, R"(,"sys":{},"comp":{},"id":{},"name":)", row.source.system.value, row.source.component.value,
        row.id.value);
    if (row.name.empty()) add(out, "null");
    else add_text(out, row.name);
    add(out, R"(,"instance":)");
    if (row.instance) add_text(out, *row.instance);
    else add(out, "null");
    add(out,
        R"(,"count":{},"hz":{:.2f},"bytes":{},"share":{:.4f},"gap_min_ms":{:.3f},"gap_max_ms":{:.3f},)"
        R"("jitter_ms":{:.3f},"age_s":{:.2f},)",
        row.count, row.hz, row.bytes, row.share, milliseconds(row.gap_min), milliseconds(row.gap_max),
        milliseconds(row.jitter), seconds(row.age));
    add_number(out, "silent_after_s", row.silent_after ? std::optional(seconds(*row.silent_after)) : std::nullopt, 1);
    out.push_back('}');
}

constexpr std::array hop_kinds{"source", "router", "sim", "listener", "relay", "web", "station"};
constexpr std::array severities{"error", "warning", "info"};

std::string_view state_of(const observe::Hop& hop) { return hop.is_up ? "up" : "down"; }
std::string_view state_of(const observe::HopLink& link) {
    return link.is_up ? "up" : link.has_ended ? "ended" : "down";
}

void add_losses(Out& out, const std::vector<observe::NamedCount>& losses) {
    add(out, R"("losses":[)");
    bool is_first = true;
    for (const auto& loss : losses) {
        if (loss.count == 0) continue;
        add(out, R"({}{{"name":)", std::exchange(is_first, false) ? "" : ",");
        add_text(out, loss.name);
        add(out, R"(,"count":{},"help":)", loss.count);
        add_text(out, loss.help);
        out.push_back('}');
    }
    out.push_back(']');
}

// The part that a hop and a link of it have in common.
void add_flow(Out& out, const auto& of) {
    add_number(out, "hz_in", of.hz_in, 1);
    out.push_back(',');
    add_number(out, "hz_out", of.hz_out, 1);
    add(out, R"(,"frames_in":{},"frames_out":{},)", of.frames_in, of.frames_out);
}

void add_link(Out& out, const observe::HopLink& link) {
    add(out, R"({{"name":)");
    add_text(out, link.name);
    add(out, R"(,"state":"{}","bytes_in":{},"bytes_out":{},)", state_of(link), link.bytes_in, link.bytes_out);
    add_flow(out, link);
    add_losses(out, link.losses);
    out.push_back('}');
}

void add_hop(Out& out, const observe::Hop& hop) {
    add(out, R"({{"name":)");
    add_text(out, hop.name);
    add(out, R"(,"kind":"{}","state":"{}",)", hop_kinds[static_cast<std::size_t>(hop.kind)], state_of(hop));
    add_flow(out, hop);
    add_losses(out, hop.losses);
    add(out, R"(,"links":[)");
    for (std::size_t i = 0; i < hop.links.size(); ++i) {
        if (i != 0) out.push_back(',');
        add_link(out, hop.links[i]);
    }
    add(out, R"(],"hint":)");
    if (hop.hint.empty()) add(out, "null");
    else add_text(out, hop.hint);
    out.push_back('}');
}

void add_alarm(Out& out, const observe::Alarm& alarm) {
    add(out, R"({{"id":{},"kind":"{}","severity":"{}","link":)", alarm.id, observe::name_of(alarm.kind),
        severities[static_cast<std::size_t>(alarm.severity)]);
    if (alarm.link.empty()) add(out, "null");
    else add_text(out, alarm.link);
    if (alarm.source == Source{}) add(out, R"(,"sys":null,"comp":null,"text":)");
    else add(out, R"(,"sys":{},"comp":{},"text":)", alarm.source.system.value, alarm.source.component.value);
    add_text(out, alarm.text);
    add(out, R"(,"since_us":{},"ended_us":)", unix_us(alarm.since));
    if (alarm.ended) add(out, "{}}}", unix_us(*alarm.ended));
    else add(out, "null}}");
}

}  // namespace

std::string_view name_of(Report report) noexcept { return about(report).name; }

const Report* report_of(std::uint32_t channel) noexcept {
    const std::uint32_t first = channel_of(reports.front());
    return channel < first || channel - first >= reports.size() ? nullptr : &reports[channel - first];
}

std::string advertise_reports() {
    Json channels = Json::array();
    for (const auto report : reports) channels.push_back(advertised(report));
    return text_of({{"op", "advertise"}, {"channels", channels}});
}

std::string vehicles_json(ReportTime now, std::span<const observe::Vehicle> vehicles, const dialect::Dialect& dialect) {
    return short_list(Report::vehicles, now, vehicles.size(),
                      [&](Out& out, std::size_t i) { add_vehicle(out, vehicles[i], now.mono, dialect); });
}

std::string traffic_json(ReportTime now, std::span<const TrafficLine> rows) {
    Out out;
    (void)add_list(out, Report::traffic, now, rows.size(), [&](Out& to, std::size_t i) { add_row(to, rows[i]); });
    out.push_back('}');
    return fmt::to_string(out);
}

std::string links_json(ReportTime now, std::span<const observe::Hop> hops) {
    return short_list(Report::links, now, hops.size(), [&](Out& out, std::size_t i) { add_hop(out, hops[i]); });
}

std::string alarms_json(ReportTime now, std::span<const observe::Alarm> alarms, std::uint64_t evicted) {
    return short_list(
        Report::alarms, now, alarms.size(), [&](Out& out, std::size_t i) { add_alarm(out, alarms[i]); }, evicted);
}

}  // namespace mavloom::web
