// SPDX-License-Identifier: MIT
// Date and time of day of a UTC instant, for names of logs. Private to module sim; pure.
#pragma once

#include <chrono>
#include <cstdint>

#include "mavloom/base/clock.hpp"

namespace mavloom::sim {

struct Calendar {
    int year = 1970;
    unsigned month = 1, day = 1, hour = 0, minute = 0, second = 0;
};

[[nodiscard]] inline Calendar calendar_of(WallTime time) noexcept {
    const auto days = std::chrono::floor<std::chrono::days>(time);
    const std::chrono::year_month_day date(days);
    const auto seconds = static_cast<unsigned>(std::chrono::floor<std::chrono::seconds>(time - days).count());
    return {.year = static_cast<int>(date.year()),
            .month = static_cast<unsigned>(date.month()),
            .day = static_cast<unsigned>(date.day()),
            .hour = seconds / 3600,
            .minute = seconds / 60 % 60,
            .second = seconds % 60};
}

}  // namespace mavloom::sim
