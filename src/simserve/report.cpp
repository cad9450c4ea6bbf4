// SPDX-License-Identifier: MIT
#include "mavloom/simserve/report.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "control/json_request.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/control/metrics_text.hpp"
#include "mavloom/link/snapshot.hpp"

namespace mavloom::simserve {

namespace {

using control::append_line;
using control::MetricsText;
using link::NamedCount;

std::string_view landed_name(sim::LandedState state) {
    switch (state) {
        case sim::LandedState::on_ground: return "on_ground";
        case sim::LandedState::in_air: return "in_air";
        case sim::LandedState::takeoff: return "takeoff";
        case sim::LandedState::landing: return "landing";
        case sim::LandedState::undefined: break;
    }
    return "undefined";
}

// Rounds to so many decimals, so that lines stay readable.
double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

// 359.999 is 0 when it is rounded.
double rounded_heading(double degrees) { return std::fmod(rounded(degrees, 1e2), 360); }

void append_vehicle(std::string& text, const sim::VehicleStatus& s) {
    append_line(text, {{"kind", "vehicle"},
                       {"system", s.system.value},
                       {"type", sim::kind_names[static_cast<std::size_t>(s.kind)]},
                       {"autopilot", sim::autopilot_names[static_cast<std::size_t>(s.autopilot)]},
                       {"armed", s.armed},
                       {"ready", s.ready},
                       {"mode", s.mode},
                       {"custom_mode", s.custom_mode},
                       {"landed_state", landed_name(s.landed)},
                       {"lat", rounded(s.latitude_deg, 1e7)},
                       {"lon", rounded(s.longitude_deg, 1e7)},
                       {"alt_m", rounded(s.altitude_m, 1e3)},
                       {"relative_alt_m", rounded(s.relative_altitude_m, 1e3)},
                       {"vn_m_s", rounded(s.north_m_s, 1e3)},
                       {"ve_m_s", rounded(s.east_m_s, 1e3)},
                       {"vd_m_s", rounded(s.down_m_s, 1e3)},
                       {"roll_deg", rounded(s.roll_deg, 1e2)},
                       {"pitch_deg", rounded(s.pitch_deg, 1e2)},
                       {"heading_deg", rounded_heading(s.heading_deg)},
                       {"battery_percent", rounded(s.battery_percent, 1e1)},
                       {"battery_v", rounded(s.battery_volts, 1e3)},
                       {"mission_items", s.mission_items},
                       {"mission_current", s.mission_current},
                       {"boot_s", rounded(seconds(s.since_boot), 1e3)},
                       {"not_finite", s.not_finite},
                       {"faults", s.faults}});
}

std::vector<sim::VehicleStatus> statuses_of(const std::vector<sim::Vehicle*>& vehicles) {
    std::vector<sim::VehicleStatus> all;
    all.reserve(vehicles.size());
    for (const sim::Vehicle* const vehicle : vehicles) all.push_back(vehicle->status());
    return all;
}

std::vector<NamedCount> counts_of(const SimulatorTotals& totals) {
    return {{"frames_sent", totals.frames_sent, "frames that the vehicles sent"},
            {"bytes_sent", totals.bytes_sent, "bytes of these frames"},
            {"gaps", totals.gaps, "frames that a full queue or the kernel dropped: gaps for the receiver"},
            {"frames_received", totals.frames_received, "frames that arrived for the vehicles"}};
}

// A copy of a simulator's counters, taken between two turns.
struct Snapshot : link::Snapshot {
    Nanoseconds uptime{};
    double speed = 1;
    sim::FlightTime flight_time{};
    bool is_paused = false;
    std::vector<NamedCount> counts{};
    std::vector<sim::VehicleStatus> vehicles{};
};

control::Json speed_of(double speed) { return speed == max_speed ? control::Json("max") : control::Json(speed); }

Snapshot snapshot_of(Simulator& simulator) {
    simulator.links().refresh_counters();
    Snapshot s{link::snapshot_of(simulator.links())};
    s.uptime = simulator.uptime();
    s.speed = simulator.options().speed;
    s.flight_time = simulator.flight_time();
    s.is_paused = simulator.is_paused();
    s.counts = counts_of(simulator.totals());
    s.vehicles = statuses_of(simulator.vehicles());
    return s;
}

void append_stats(std::string& text, const Snapshot& s) {
    append_line(text,
                {{"kind", "sim"},
                 {"uptime_s", seconds(s.uptime)},
                 {"speed", speed_of(s.speed)},
                 {"flight_s", seconds(s.flight_time)},
                 {"paused", s.is_paused},
                 {"vehicles", s.vehicles.size()}},
                s.counts);
    for (const auto& endpoint : s.endpoints) {
        control::append_endpoint(text, endpoint);
        control::append_gone(text, endpoint);
    }
    for (const auto& link : s.links) control::append_link(text, s, link);
    for (const auto& link : s.links) control::append_sources(text, link);
    for (const auto& vehicle : s.vehicles) append_vehicle(text, vehicle);
}

}  // namespace

Report report_state(const std::vector<sim::Vehicle*>& vehicles) {
    return control::succeeded([statuses = statuses_of(vehicles)](std::string& text) {
        for (const auto& status : statuses) append_vehicle(text, status);
    });
}

Report report_links(Simulator& simulator) {
    return control::succeeded([s = link::snapshot_of(simulator.links())](std::string& text) {
        for (const auto& link : s.links) control::append_link(text, s, link);
    });
}

Report report_stats(Simulator& simulator) {
    return control::succeeded([s = snapshot_of(simulator)](std::string& text) { append_stats(text, s); });
}

// ---- streams --------------------------------------------------------------------------------------------------------

namespace {

// One row of the report. Rates and jitter are those that the peer sees: of real time.
struct Row {
    double asked_hz, achieved_hz, median_ms, p99_ms;
};

Row row_of(const sim::StreamReport& stream, double speed) {
    if (speed == max_speed) speed = 1;  // nobody sees them; those of the flight clock
    return {stream.asked_hz * speed, stream.achieved_hz * speed, milliseconds(stream.lateness.at(0.5)) / speed,
            milliseconds(stream.lateness.at(0.99)) / speed};
}

void append_streams(std::string& text, const LinkReport& report, double speed) {
    for (const auto& stream : report.streams) {
        const Row row = row_of(stream, speed);
        append_line(text, {{"kind", "stream"},
                           {"link", report.link},
                           {"system", stream.system.value},
                           {"id", stream.message.value},
                           {"name", stream.name},
                           {"asked_hz", rounded(row.asked_hz, 1e4)},
                           {"achieved_hz", rounded(row.achieved_hz, 1e4)},
                           {"sent", stream.sent},
                           {"skipped", stream.skipped},
                           {"jitter_median_ms", row.median_ms},
                           {"jitter_p99_ms", row.p99_ms}});
    }
}

}  // namespace

Report report_clock(Simulator& simulator) {
    return control::succeeded([flight = simulator.flight_time(), is_paused = simulator.is_paused()](std::string& text) {
        append_line(text, {{"kind", "clock"}, {"flight_s", seconds(flight)}, {"paused", is_paused}});
    });
}

Report report_streams(Simulator& simulator) {
    return control::succeeded([reports = simulator.reports(), speed = simulator.options().speed](std::string& text) {
        for (const auto& report : reports) append_streams(text, report, speed);
    });
}

std::string json_of(const std::vector<LinkReport>& reports, double speed) {
    std::string text;
    for (const auto& report : reports) {
        append_streams(text, report, speed);
        append_line(text, {{"kind", "link_total"},
                           {"link", report.link},
                           {"frames", report.frames},
                           {"bytes", report.bytes},
                           {"gaps", report.gaps}});
    }
    return text;
}

std::string text_of(const std::vector<LinkReport>& reports, double speed) {
    std::string text;
    auto out = std::back_inserter(text);
    for (const auto& report : reports) {
        fmt::format_to(out, "{}: {}, {}, {}\n", report.link, counted(report.frames, "frame"),
                       counted(report.bytes, "byte"), counted(report.gaps, "sequence gap"));
        fmt::format_to(out, "  {:>3}  {:<32} {:>10} {:>12} {:>9} {:>8} {:>12} {:>12}\n", "sys", "message", "asked Hz",
                       "achieved Hz", "sent", "skipped", "median, ms", "99 %, ms");
        for (const auto& stream : report.streams) {
            const Row row = row_of(stream, speed);
            fmt::format_to(out, "  {:>3}  {:<32} {:>10.3f} {:>12} {:>9} {:>8} {:>12.3f} {:>12.3f}\n",
                           stream.system.value, stream.name, row.asked_hz,
                           stream.sent < 2 ? "-" : fmt::format("{:.3f}", row.achieved_hz), stream.sent, stream.skipped,
                           row.median_ms, row.p99_ms);
        }
    }
    return text;
}

// ---- metrics --------------------------------------------------------------------------------------------------------

namespace {

std::string metrics_text(const Snapshot& s) {
    MetricsText metrics;
    metrics.add("sim", s.counts, "");
    for (const auto& endpoint : s.endpoints) {
        const auto label = MetricsText::label("endpoint", endpoint.label);
        metrics.add("endpoint", endpoint.counts, label);
        metrics.add("gone", endpoint.gone, label);
    }
    for (const auto& link : s.links) metrics.add("link", link.counts, MetricsText::label("link", link.name));
    return metrics.text();
}

}  // namespace

Report report_metrics(Simulator& simulator) {
    return control::report_of([s = snapshot_of(simulator)] { return metrics_text(s); });
}

}  // namespace mavloom::simserve
