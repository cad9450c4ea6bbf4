// SPDX-License-Identifier: MIT
#include <fmt/chrono.h>

#include "entry_text.hpp"
#include "info/reports.hpp"

namespace mavloom::app {

std::string kind_text(const observe::SenderSummary& sender, const dialect::Dialect& dialect) {
    return sender.has_heartbeat ? kind_text(dialect, sender.type, sender.autopilot) : "-";
}

std::string utc_text(WallTime time) {
    const auto seconds = std::chrono::floor<std::chrono::seconds>(time);
    return fmt::format("{:%Y-%m-%d %H:%M:%S}", fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)));
}

}  // namespace mavloom::app
