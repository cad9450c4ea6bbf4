// SPDX-License-Identifier: MIT
#include "web/report/metrics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "mavloom/control/metrics_text.hpp"

namespace mavloom::web {

namespace {

using control::MetricsText;

std::string labels_of(Source source) {
    return fmt::format("sys=\"{}\",comp=\"{}\"", source.system.value, source.component.value);
}

std::string labels_of(const TrafficLine& row) {
    const auto message = row.name.empty() ? std::to_string(row.id.value) : std::string(row.name);
    const auto instance = row.instance ? "," + MetricsText::label("instance", *row.instance) : "";
    return fmt::format("{},{},{}{}", MetricsText::label("link", row.link), labels_of(row.source),
                       MetricsText::label("message", message), instance);
}

struct Series {
    std::string labels;
    std::uint64_t frames = 0, bytes = 0;
};

// Links that have the same name, such as a peer that came back, are one series.
std::vector<Series> series_of(const std::vector<TrafficLine>& rows) {
    std::map<std::string, Series> all;
    for (const auto& row : rows) {
        auto labels = labels_of(row);
        auto& series = all[labels];
        series.labels = std::move(labels);
        series.frames += row.count;
        series.bytes += row.bytes;
    }
    std::vector<Series> list;
    list.reserve(all.size());
    for (auto& [labels, series] : all) list.push_back(std::move(series));
    return list;
}

void add_rows(MetricsText& out, const std::vector<TrafficLine>& rows) {
    auto all = series_of(rows);
    const auto most = std::min(max_message_series, all.size());
    std::ranges::partial_sort(all, all.begin() + static_cast<std::ptrdiff_t>(most), std::ranges::greater{},
                              &Series::frames);
    Series others{R"(link="other",sys="other",comp="other",message="other")"};
    for (std::size_t i = most; i < all.size(); ++i) {
        others.frames += all[i].frames;
        others.bytes += all[i].bytes;
    }
    all.resize(most);
    if (others.frames != 0) all.push_back(std::move(others));
    for (const auto& series : all) {
        out.add("message", {"frames", series.frames, "frames of this message"}, series.labels);
        out.add("message", {"bytes", series.bytes, "bytes of the frames"}, series.labels);
    }
}

void add_hop(MetricsText& out, const observe::Hop& hop) {
    const auto label = MetricsText::label("hop", hop.name);
    out.add("hop", {"frames_in", hop.frames_in, "frames that arrived"}, label);
    out.add("hop", {"frames_out", hop.frames_out, "frames that were sent"}, label);
    for (const auto& loss : hop.losses)
        out.add("hop", {"losses", loss.count, "frames that were lost here, by reason"},
                label + "," + MetricsText::label("reason", loss.name));
}

void add_vehicle(MetricsText& out, const observe::Vehicle& vehicle) {
    const auto labels = labels_of(vehicle.source);
    out.add_gauge("vehicle_armed", "1: the vehicle is armed", labels, vehicle.is_armed ? 1 : 0);
    if (vehicle.battery && vehicle.battery->percent)
        out.add_gauge("vehicle_battery_percent", "the charge that is left", labels, *vehicle.battery->percent);
}

void add_alarms(MetricsText& out, std::span<const observe::Alarm> alarms) {
    std::map<std::string_view, int> now;
    for (const auto& alarm : alarms) now[name_of(alarm.kind)] += alarm.ended ? 0 : 1;
    for (const auto& [kind, count] : now)
        out.add_gauge("alarms", "alarms of this kind that have not ended", MetricsText::label("kind", kind), count);
}

}  // namespace

std::string metrics_text(const std::vector<TrafficLine>& rows, std::span<const observe::Vehicle> vehicles,
                         std::span<const observe::Hop> hops, std::span<const observe::Alarm> alarms,
                         std::span<const observe::NamedCount> server) {
    MetricsText out;
    add_rows(out, rows);
    for (const auto& vehicle : vehicles) add_vehicle(out, vehicle);
    for (const auto& hop : hops) add_hop(out, hop);
    add_alarms(out, alarms);
    for (const auto& [name, count, help] : server) out.add("server", {name, count, help}, "");
    return out.text();
}

}  // namespace mavloom::web
