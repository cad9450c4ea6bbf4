// SPDX-License-Identifier: MIT
// What the server reports of the link itself, as JSON: the channels /mavloom/NAME and the answers of /api/v1/NAME.
// docs/guide/web.md lists the keys. Private to module web. Pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/hop.hpp"
#include "mavloom/observe/vehicle_table.hpp"

namespace mavloom::web {

enum class Report : std::uint8_t { vehicles, traffic, links, alarms };
inline constexpr std::array reports{Report::vehicles, Report::traffic, Report::links, Report::alarms};

[[nodiscard]] std::string_view name_of(Report report) noexcept;
// Far above the ids of messages' channels.
[[nodiscard]] constexpr std::uint32_t channel_of(Report report) noexcept {
    return 1'000'000'001 + static_cast<std::uint32_t>(report);
}
[[nodiscard]] const Report* report_of(std::uint32_t channel) noexcept;
// The Foxglove protocol's text that announces the channels of all reports.
[[nodiscard]] std::string advertise_reports();

// One row of /mavloom/traffic.
struct TrafficLine {
    std::string topic, link;
    std::string_view name;  // empty: not known
    std::optional<std::string> instance{};
    Source source;
    MessageId id;
    std::uint64_t count = 0, bytes = 0;
    double hz = 0, share = 0;
    Nanoseconds gap_min{}, gap_max{}, jitter{}, age{};
    std::optional<Nanoseconds> silent_after{};
};

struct ReportTime {
    WallTime wall;
    MonoTime mono;
};

[[nodiscard]] std::string vehicles_json(ReportTime now, std::span<const observe::Vehicle> vehicles,
                                        const dialect::Dialect& dialect);
[[nodiscard]] std::string traffic_json(ReportTime now, std::span<const TrafficLine> rows);
[[nodiscard]] std::string links_json(ReportTime now, std::span<const observe::Hop> hops);
[[nodiscard]] std::string alarms_json(ReportTime now, std::span<const observe::Alarm> alarms, std::uint64_t evicted = 0);

}  // namespace mavloom::web
