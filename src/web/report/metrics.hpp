// SPDX-License-Identifier: MIT
// The text of /metrics, in Prometheus' format. docs/guide/web.md lists the names. Private to module web. Pure.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "mavloom/observe/alarm.hpp"
#include "mavloom/observe/hop.hpp"
#include "mavloom/observe/vehicle_table.hpp"
#include "web/report/reports.hpp"

namespace mavloom::web {

// At most `max_message_series` series have a message of their own, the most frequent ones. The others are summed.
// `server`: what the server itself counted.
inline constexpr std::size_t max_message_series = 1024;
[[nodiscard]] std::string metrics_text(const std::vector<TrafficLine>& rows, std::span<const observe::Vehicle> vehicles,
                                       std::span<const observe::Hop> hops, std::span<const observe::Alarm> alarms,
                                       std::span<const observe::NamedCount> server);

}  // namespace mavloom::web
