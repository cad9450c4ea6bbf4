// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <iterator>

#include "control/json_request.hpp"
#include "mavloom/base/counted.hpp"
#include "mavloom/base/durations.hpp"
#include "mavloom/control/metrics_text.hpp"
#include "mavloom/simserve/hil_simulator.hpp"

namespace mavloom::simserve {

namespace {

using control::append_line;
using control::MetricsText;
using link::NamedCount;

double to_decimals(double value, double per_unit) {
    return std::round(value * per_unit) / per_unit + 0.0;  // never -0
}
double microseconds_in(Nanoseconds time) { return static_cast<double>(time.count()) / 1e3; }

std::vector<NamedCount> counts_of_pair(const HilReport& report) {
    return {{"steps", report.steps.steps, "steps of the flight"},
            {"answered", report.steps.answered, "steps that the autopilot answered"},
            {"unanswered", report.steps.unanswered, "steps without an answer, since the first one"},
            {"late", report.steps.late, "answers to steps before the last"},
            {"repeated", report.steps.repeated, "further answers to a step"},
            {"foreign", report.steps.foreign, "answers with a time that no step had"},
            {"losses", report.steps.losses, "times that the autopilot stopped answering"},
            {"clamped", report.counters.clamped, "messages with a control beyond its range"},
            {"not_numbers", report.counters.not_numbers, "messages with a control that is no number"},
            {"not_finite", report.counters.not_finite, "times that the motion was no number: back at its start"},
            {"restarts", report.counters.restarts, "autopilots that came after the first"}};
}

void append_pair(std::string& text, const HilReport& report) {
    const auto& s = report.status;
    append_line(text,
                {{"kind", "hil"},
                 {"system", s.system.value},
                 {"state", hil::state_names[static_cast<std::size_t>(s.state)]},
                 {"paused", s.is_paused},
                 {"port", report.port},
                 {"peer", report.peer},
                 {"flight_s", to_decimals(seconds(s.time), 1e3)},
                 {"armed", s.is_armed},
                 {"landed_state", s.touches_ground ? "on_ground" : "in_air"},
                 {"lat", to_decimals(s.latitude_deg, 1e7)},
                 {"lon", to_decimals(s.longitude_deg, 1e7)},
                 {"alt_m", to_decimals(s.altitude_m, 1e3)},
                 {"relative_alt_m", to_decimals(s.height_m, 1e3)},
                 {"vn_m_s", to_decimals(s.north_m_s, 1e3)},
                 {"ve_m_s", to_decimals(s.east_m_s, 1e3)},
                 {"vd_m_s", to_decimals(s.down_m_s, 1e3)},
                 {"roll_deg", to_decimals(s.roll_deg, 1e2)},
                 {"pitch_deg", to_decimals(s.pitch_deg, 1e2)},
                 {"heading_deg", std::fmod(to_decimals(s.heading_deg, 1e2), 360)},
                 {"faults", report.faults},
                 {"speed", to_decimals(report.speed_reached, 1e3)},
                 {"answer_median_us", microseconds_in(report.answer_median)},
                 {"answer_p99_us", microseconds_in(report.answer_p99)},
                 {"own_median_us", microseconds_in(report.own_median)},
                 {"own_p99_us", microseconds_in(report.own_p99)}},
                counts_of_pair(report));
}

std::string metrics_of(const std::vector<HilReport>& reports) {
    MetricsText metrics;
    for (const auto& report : reports)
        metrics.add("hil", counts_of_pair(report),
                    MetricsText::label("port", report.port) + "," +
                        MetricsText::label("system", fmt::format("{}", report.status.system.value)));
    return metrics.text();
}

}  // namespace

control::Report report_hil(HilSimulator& simulator, std::optional<SystemId> system, std::string first) {
    auto reports = simulator.reports();
    if (system) std::erase_if(reports, [&](const HilReport& report) { return report.status.system != *system; });
    return control::succeeded([first = std::move(first), reports = std::move(reports)](std::string& text) {
        text += first + json_of(reports);
    });
}

control::Report HilSimulator::metrics() {
    return control::report_of([all = reports()] { return metrics_of(all); });
}

std::string json_of(const std::vector<HilReport>& reports) {
    std::string text;
    for (const auto& report : reports) append_pair(text, report);
    return text;
}

std::string text_of(const std::vector<HilReport>& reports) {
    std::string text;
    auto out = std::back_inserter(text);
    for (const auto& report : reports) {
        fmt::format_to(out, "vehicle {}: {}, {} of flight: {:.1f} s, {:.2f} times real time\n",
                       report.status.system.value, report.port, counted(report.steps.steps, "step"),
                       seconds(report.status.time), report.speed_reached);
        if (report.steps.answered != 0)
            fmt::format_to(out, "  each step: autopilot {:.1f} us (99 %: {:.1f}), simulator {:.1f} us (99 %: {:.1f})\n",
                           microseconds_in(report.answer_median), microseconds_in(report.answer_p99),
                           microseconds_in(report.own_median), microseconds_in(report.own_p99));
        for (const auto& count : counts_of_pair(report))
            if (count.value != 0 && count.name != "steps" && count.name != "answered")
                fmt::format_to(out, "  {}: {}\n", count.help, count.value);
    }
    return text;
}

}  // namespace mavloom::simserve
