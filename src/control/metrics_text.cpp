// SPDX-License-Identifier: MIT
#include "mavloom/control/metrics_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "mavloom/base/version.hpp"

namespace mavloom::control {

namespace {

// Loss is corrected when a frame arrives late or a source turns out to have restarted. These values can therefore
// decrease, which a Prometheus counter must not, so they are gauges.
std::string_view type_of(std::string_view name) {
    static constexpr std::array<std::string_view, 4> judged_again{"_lost_total", "_late_total", "_repeated_total",
                                                                  "_resync_total"};
    const auto ends = [&](std::string_view end) { return name.ends_with(end); };
    return std::ranges::any_of(judged_again, ends) ? "gauge" : "counter";
}

}  // namespace

std::string& MetricsText::family(std::string_view name, std::string_view help, std::string_view type) {
    auto at = std::ranges::find(families_, name, &std::pair<std::string, std::string>::first);
    if (at == families_.end())
        at = families_.insert(at,
                              {std::string(name), fmt::format("# HELP {0} {1}.\n# TYPE {0} {2}\n", name, help, type)});
    return at->second;
}

void MetricsText::add(std::string_view prefix, const link::NamedCount& count, std::string_view labels) {
    const auto metric = fmt::format("mavloom_{}_{}_total", prefix, count.name);
    auto& lines = family(metric, fmt::format("Of each {}: {}", prefix, count.help), type_of(metric));
    fmt::format_to(std::back_inserter(lines), "{}{{{}}} {}\n", metric, labels, count.value);
}

void MetricsText::add_gauge(std::string_view name, std::string_view help, std::string_view labels, double value) {
    const auto metric = fmt::format("mavloom_{}", name);
    fmt::format_to(std::back_inserter(family(metric, help, "gauge")), "{}{{{}}} {}\n", metric, labels, value);
}

std::string MetricsText::text() const {
    std::string all = fmt::format(
        "# HELP mavloom_build_info The version of Mavloom.\n# TYPE mavloom_build_info gauge\n"
        "mavloom_build_info{{{}}} 1\n",
        label("version", version()));
    for (const auto& [name, lines] : families_) all += lines;
    return all;
}

std::string MetricsText::label(std::string_view name, std::string_view value) {
    std::string escaped;
    for (const char c : value) {
        if (c == '\\' || c == '"') escaped += '\\';
        if (c == '\n') escaped += "\\n";
        else escaped += c;
    }
    return fmt::format("{}=\"{}\"", name, escaped);
}

}  // namespace mavloom::control
