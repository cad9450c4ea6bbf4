// SPDX-License-Identifier: MIT
// The answers of `ctl` on a terminal.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ctl/answers.hpp"
#include "ctl/text_table.hpp"
#include "mavloom/base/counted.hpp"
#include "wrapped.hpp"

namespace mavloom::app {

namespace {

// How the value of a key is shown. `sender`, `lost` and `filled` join it with other keys of the object.
enum class Form : std::uint8_t {
    text,
    count,
    bytes,
    whole,
    heading,
    tenths,
    hundredths,
    degrees,
    up,
    yes,
    sender,
    lost,
    filled
};

struct Shown {
    std::string_view title, key;
    Form form = Form::count;
    int rank = 0;
};

// The table of one kind of object.
struct Layout {
    std::string_view kind;
    std::vector<Shown> columns;
    bool has_rest = false;  // counters without a column stand below the row, unless they are 0
};

// In the order in which they are printed.
const std::vector<Layout>& layouts() {
    static const std::vector<Layout> all{
        {"vehicle",
         {{"VEHICLE", "system"},
          {"TYPE", "type", Form::text, 3},
          {"AUTOPILOT", "autopilot", Form::text, 5},
          {"MODE", "mode", Form::text},
          {"ARMED", "armed", Form::yes},
          {"READY", "ready", Form::yes, 2},
          {"STATE", "landed_state", Form::text, 4},
          {"HEIGHT, M", "relative_alt_m", Form::tenths, 1},
          {"HEADING", "heading_deg", Form::heading, 6},
          {"BATTERY, %", "battery_percent", Form::whole, 2},
          {"FAULTS", "faults", Form::text, 6},
          {"LATITUDE", "lat", Form::degrees, 7},
          {"LONGITUDE", "lon", Form::degrees, 7}}},
        {"hil",
         {{"VEHICLE", "system", Form::count},
          {"PX4", "state", Form::text},
          {"ARMED", "armed", Form::yes, 1},
          {"HEIGHT, M", "relative_alt_m", Form::tenths},
          {"FLIGHT, S", "flight_s", Form::tenths},
          {"SPEED", "speed", Form::hundredths},
          {"STEPS", "steps", Form::count, 1},
          {"UNANSWERED", "unanswered"},
          {"FAULTS", "faults", Form::text, 5},
          {"PX4, US", "answer_median_us", Form::tenths, 2},
          {"99 %", "answer_p99_us", Form::tenths, 3},
          {"OURS, US", "own_median_us", Form::tenths, 4},
          {"PORT", "port", Form::text, 2}}},
        {"link",
         {{"LINK", "link", Form::text},
          {"STATE", "up", Form::up},
          {"RANK", "rank", Form::text, 2},
          {"IN", "frames_in"},
          {"OUT", "frames_out"},
          {"BYTES IN", "bytes_in", Form::bytes, 3},
          {"BYTES OUT", "bytes_out", Form::bytes, 3},
          {"LOST", "lost", Form::count, 1},
          {"QUEUE", "queued_bytes", Form::filled, 2}},
         true},
        {"endpoint", {{"ENDPOINT", "endpoint", Form::text}, {"RECEIVE BUFFER", "rcvbuf", Form::bytes, 1}}, true},
        {"recording",
         {{"RECORDING", "endpoint", Form::text}, {"FRAMES", "frames"}, {"BYTES", "bytes", Form::bytes}},
         true},
        {"gone",
         {{"CLOSED LINKS OF", "endpoint", Form::text},
          {"IN", "frames_in"},
          {"OUT", "frames_out"},
          {"LOST", "lost", Form::count, 1}},
         true},
        {"source",
         {{"SENDER", "sys", Form::sender},
          {"FRAMES", "frames"},
          {"LOST", "lost", Form::lost},
          {"LATE", "late", Form::count, 2},
          {"REPEATED", "repeated", Form::count, 2},
          {"LINK", "link", Form::text, 1}}},
        {"message",
         {{"MESSAGE", "name", Form::text},
          {"SENDER", "sys", Form::sender},
          {"HZ", "rate_hz", Form::hundredths},
          {"FRAMES", "frames", Form::count, 1},
          {"BYTES", "bytes", Form::bytes, 3},
          {"LINK", "link", Form::text, 2}}},
        {"unknown_target", {{"NOT HEARD", "sys", Form::sender}, {"FRAMES FOR IT", "frames"}}},
        {"route",
         {{"SENDER", "sys", Form::sender},
          {"LINK", "link", Form::text},
          {"HEARD, S AGO", "age_s", Form::tenths},
          {"FRAMES", "frames", Form::count, 1}}},
        {"stream",
         {{"MESSAGE", "name", Form::text},
          {"VEHICLE", "system", Form::count, 2},
          {"ASKED, HZ", "asked_hz", Form::hundredths, 1},
          {"SENT, HZ", "achieved_hz", Form::hundredths},
          {"SENT", "sent", Form::count, 4},
          {"SKIPPED", "skipped", Form::count, 3},
          {"LATE 99 %, MS", "jitter_p99_ms", Form::tenths, 5},
          {"LINK", "link", Form::text, 6}}},
        {"clock", {{"FLIGHT, S", "flight_s", Form::hundredths}, {"PAUSED", "paused", Form::yes}}},
        {"step", {{"VEHICLE", "system"}, {"MOVED, S", "moved_s", Form::text}}},
        {"parameter",
         {{"VEHICLE", "system", Form::count}, {"PARAMETER", "name", Form::text}, {"VALUE", "value", Form::text}}}};
    return all;
}

bool is_text(Form form) { return form == Form::text || form == Form::up || form == Form::yes || form == Form::sender; }

std::string tenths(double value) {
    auto text = fmt::format("{:.1f}", value);
    return text == "-0.0" ? "0.0" : text;
}

// 359.6 is 0 when it is rounded.
std::string heading_text(double degrees) { return fmt::format("{:.0f}", std::fmod(std::round(degrees), 360)); }

std::string lost_text(const Json& object) {
    const auto frames = object.value("frames", 0.0), lost = object.value("lost", 0.0);
    return lost == 0 ? "0" : fmt::format("{:.0f} ({:.1f} %)", lost, 100 * lost / (frames + lost));
}

std::string filled_text(const Json& link) {
    const auto limit = link.value("queue_limit_bytes", 0.0);
    return limit == 0 ? "-" : fmt::format("{:.0f} %", std::ceil(100 * link.value("queued_bytes", 0.0) / limit));
}

std::string text_of(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_array())
        return value.empty() ? "-" : fmt::format("{}", fmt::join(value.get<std::vector<std::string>>(), "; "));
    return value.is_number_float() ? fmt::format("{:.7g}", value.get<double>()) : value.dump();
}

std::string cell_of(const Json& object, const Shown& shown) {
    const auto found = object.find(shown.key);
    if (found == object.end() || found->is_null())  // a message without a name has an id
        return shown.key == "name" ? fmt::format("{}", object.value("id", 0)) : "-";
    switch (shown.form) {
        case Form::text: return text_of(*found);
        case Form::count: return fmt::format("{}", found->get<std::uint64_t>());
        case Form::bytes: return amount_text(found->get<double>());
        case Form::whole: return fmt::format("{:.0f}", found->get<double>());
        case Form::heading: return heading_text(found->get<double>());
        case Form::tenths: return tenths(found->get<double>());
        case Form::hundredths: return fmt::format("{:.2f}", found->get<double>());
        case Form::degrees: return fmt::format("{:.7f}", found->get<double>());
        case Form::up: return found->get<bool>() ? "up" : "down";
        case Form::yes: return found->get<bool>() ? "yes" : "no";
        case Form::sender: return fmt::format("{}/{}", object.value("sys", 0), object.value("comp", 0));
        case Form::lost: return lost_text(object);
        case Form::filled: return filled_text(object);
    }
    return {};
}

std::string rest_of(const Json& object, const Layout& layout) {
    std::vector<std::string_view> shown{"queue_limit_bytes"};
    if (layout.kind != "gone") shown.push_back("forwarded");
    for (const auto& column : layout.columns) shown.push_back(column.key);
    auto rest = nonzero(object, shown);
    const std::string faults = object.value("faults", "off");
    if (faults == "off") return rest;
    return fmt::format("faults: {}{}{}", faults, rest.empty() ? "" : "; ", rest);
}

void add(TextTable& table, const Json& object, const Layout& layout) {
    const auto rest = layout.has_rest ? rest_of(object, layout) : std::string();
    const bool is_quiet = layout.kind == "gone" && nonzero(object, {}).empty();
    if (is_quiet) return;
    std::vector<std::string> cells;
    cells.reserve(layout.columns.size());
    for (const auto& column : layout.columns) cells.push_back(cell_of(object, column));
    table.add_row(std::move(cells));
    if (!rest.empty()) table.add_note(rest);
}

TextTable table_of(const std::vector<Json>& objects, const Layout& layout) {
    std::vector<TextTable::Column> columns;
    columns.reserve(layout.columns.size());
    for (const auto& shown : layout.columns) columns.push_back({shown.title, shown.rank, !is_text(shown.form)});
    TextTable table(std::move(columns));
    for (const auto& object : objects) {
        if (object.value("kind", "") != layout.kind) continue;
        try {
            add(table, object, layout);
        } catch (const Json::exception&) {}  // skip an object from another version
    }
    return table;
}

// ", flight clock at 62.4 s (paused)"
std::string flight_text(const Json& sim) {
    if (!sim.contains("flight_s")) return {};
    return fmt::format(", flight clock at {:.1f} s{}", sim.value("flight_s", 0.0),
                       sim.value("paused", false) ? " (paused)" : "");
}

// "router: up 12 s, heartbeats_sent 12".
std::string line_of_program(const Json& object) {
    const auto counts = nonzero(object, {});
    return fmt::format("{}: up {:.0f} s{}{}{}", object.value("kind", ""), object.value("uptime_s", 0.0),
                       flight_text(object), counts.empty() ? "" : ", ", counts);
}

}  // namespace

std::string tables_of(const Lines& lines, int width) {
    constexpr int least = 20, indent = 4;
    width = std::max(width, least);
    std::vector<Json> objects;
    for (const auto& line : lines)
        if (auto object = Json::parse(line, nullptr, false); object.is_object()) objects.push_back(std::move(object));
    std::string text;
    for (const auto& object : objects)
        if (const auto kind = object.value("kind", ""); kind == "router" || kind == "sim")
            text += wrapped(line_of_program(object), width, indent);
    bool is_cut = false;
    for (const auto& layout : layouts()) {
        const auto table = table_of(objects, layout);
        if (table.is_empty()) continue;
        const auto fitted = table.fitted(width);
        text += (text.empty() ? "" : "\n") + fitted.text;
        is_cut = is_cut || fitted.is_cut;
    }
    return is_cut ? text + "\nNot all fits; --json prints all.\n" : text;
}

}  // namespace mavloom::app
