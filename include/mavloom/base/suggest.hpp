// SPDX-License-Identifier: MIT
// "Did you mean": the nearest valid spelling for a name that is not known (DESIGN.md rule 8).
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mavloom {

// The candidate with the smallest edit distance to `typed` (case ignored), or one that begins with it (three letters at least), or empty when
// none is near (over a third of its letters wrong).
[[nodiscard]] std::string_view nearest(std::string_view typed, std::span<const std::string_view> candidates);

// ", did you mean 'X'?" or an empty string.
[[nodiscard]] std::string did_you_mean(std::string_view typed, std::span<const std::string_view> candidates);

}  // namespace mavloom
