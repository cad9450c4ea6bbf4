// SPDX-License-Identifier: MIT
// Numbers with their nouns, for people. Pure; allocates the result.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace mavloom::app {

// "frame" or "frames"; `many` where the plural is not made with an s.
[[nodiscard]] inline std::string plural(std::uint64_t count, std::string_view one, std::string_view many = {}) {
    if (count == 1) return std::string(one);
    return many.empty() ? fmt::format("{}s", one) : std::string(many);
}

// "1 frame", "2 frames".
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {}) {
    return fmt::format("{} {}", count, plural(count, one, many));
}

}  // namespace mavloom::app
