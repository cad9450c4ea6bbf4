// SPDX-License-Identifier: MIT
#include "mavloom/control/metrics_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "control/metrics_help.hpp"
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

void MetricsText::add_total(std::string_view prefix, std::string_view name, std::string_view labels,
                            std::uint64_t value) {
    const auto metric = fmt::format("mavloom_{}_{}_total", prefix, name);
    auto at = std::ranges::find(families_, metric, &std::pair<std::string, std::string>::first);
    if (at == families_.end())
        at = families_.insert(at, {metric, fmt::format("# HELP {0} Of each {1}: {2}.\n# TYPE {0} {3}\n", metric, prefix,
                                                       help_of(name), type_of(metric))});
    fmt::format_to(std::back_inserter(at->second), "{}{{{}}} {}\n", metric, labels, value);
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
