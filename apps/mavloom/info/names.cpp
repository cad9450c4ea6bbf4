// SPDX-License-Identifier: MIT
#include <fmt/chrono.h>

#include "info/reports.hpp"
#include "mavloom/dialect/entry_name.hpp"

namespace mavloom::app {

std::string entry_text(const dialect::Dialect& dialect, std::string_view enum_name, std::uint64_t value) {
    const auto name = dialect::short_entry_name(dialect, enum_name, value);
    return name.empty() ? fmt::format("{}", value) : std::string(name);
}

std::string kind_text(const observe::SenderSummary& sender, const dialect::Dialect& dialect) {
    constexpr std::uint8_t no_autopilot = 8;  // MAV_AUTOPILOT_INVALID
    if (!sender.has_heartbeat) return "-";
    const auto type = entry_text(dialect, "MAV_TYPE", sender.type);
    if (sender.autopilot == no_autopilot) return type;
    return fmt::format("{} {}", entry_text(dialect, "MAV_AUTOPILOT", sender.autopilot), type);
}

std::string utc_text(WallTime time) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
    return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
}

}  // namespace mavloom::app
