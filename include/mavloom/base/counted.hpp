// SPDX-License-Identifier: MIT
// Formats numbers together with their nouns, such as "2 frames", and amounts of bytes. Pure functions that return a new
// string.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

namespace mavloom {

// Returns "frame" or "frames". Pass `many` if the plural is not formed with an s.
[[nodiscard]] inline std::string plural(std::uint64_t count, std::string_view one, std::string_view many = {}) {
    if (count == 1) return std::string(one);
    return many.empty() ? fmt::format("{}s", one) : std::string(many);
}

// Returns "1 frame" or "2 frames".
[[nodiscard]] inline std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {}) {
    return fmt::format("{} {}", count, plural(count, one, many));
}

// "12 B", "4.2 kB", "123 MB".
[[nodiscard]] std::string amount_text(double bytes);

}  // namespace mavloom
