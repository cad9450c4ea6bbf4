// SPDX-License-Identifier: MIT
// Durations as numbers, for reports. Pure.
#pragma once

#include <chrono>

#include "mavloom/base/clock.hpp"

namespace mavloom {

[[nodiscard]] constexpr double seconds(Nanoseconds time) noexcept {
    return std::chrono::duration<double>(time).count();
}
[[nodiscard]] constexpr double milliseconds(Nanoseconds time) noexcept {
    return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace mavloom
