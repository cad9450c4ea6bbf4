// SPDX-License-Identifier: MIT
// Names of enum entries for reports. Pure.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "mavloom/dialect/entry_name.hpp"

namespace mavloom::app {

// The short name, such as "QUADROTOR", or the number if there is no such entry.
[[nodiscard]] inline std::string entry_text(const dialect::Dialect& dialect, std::string_view enum_name,
                                            std::uint64_t value) {
    const auto name = dialect::short_entry_name(dialect, enum_name, value);
    return name.empty() ? fmt::format("{}", value) : std::string(name);
}

// The kind of a HEARTBEAT's sender: "PX4 QUADROTOR", or "GCS" without an autopilot.
[[nodiscard]] inline std::string kind_text(const dialect::Dialect& dialect, std::uint8_t type, std::uint8_t autopilot) {
    constexpr std::uint8_t no_autopilot = 8;  // MAV_AUTOPILOT_INVALID
    auto type_text = entry_text(dialect, "MAV_TYPE", type);
    if (autopilot == no_autopilot) return type_text;
    return fmt::format("{} {}", entry_text(dialect, "MAV_AUTOPILOT", autopilot), type_text);
}

}  // namespace mavloom::app
