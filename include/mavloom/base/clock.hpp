// SPDX-License-Identifier: MIT
// The two clocks: monotonic time for intervals and deadlines, wall time for timestamps only.
// Other code takes the time as a parameter, so that tests control it. Safe from any thread.
#pragma once

#include <chrono>

namespace mavloom {

using Nanoseconds = std::chrono::nanoseconds;
using MonoTime = std::chrono::time_point<std::chrono::steady_clock, Nanoseconds>;
using WallTime = std::chrono::time_point<std::chrono::system_clock, Nanoseconds>;  // since the Unix epoch

[[nodiscard]] inline MonoTime mono_now() { return std::chrono::steady_clock::now(); }
[[nodiscard]] inline WallTime wall_now() {
    return std::chrono::time_point_cast<Nanoseconds>(std::chrono::system_clock::now());
}

[[nodiscard]] constexpr WallTime wall_from_us(std::uint64_t unix_us) noexcept {
    return WallTime{Nanoseconds{static_cast<std::int64_t>(unix_us) * 1000}};
}
[[nodiscard]] constexpr std::int64_t unix_us(WallTime t) noexcept {
    return std::chrono::floor<std::chrono::microseconds>(t).time_since_epoch().count();
}

}  // namespace mavloom
