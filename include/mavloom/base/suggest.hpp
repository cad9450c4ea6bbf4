// SPDX-License-Identifier: MIT
// "Did you mean ...?": finds the known name that is closest to an unknown one. Pure; allocates.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace mavloom {

// Returns the candidate with the smallest edit distance to `typed`, ignoring case. It may differ in at most a third of
// the letters of `typed`. If one of the two begins or ends with the other, and has at most twice as many letters, that
// counts as one edit: `baudrate` means `baud`, and `play` means `replay`. If no candidate is that close, returns one
// that starts with `typed`, but only if `typed` has at least three letters. Otherwise returns an empty view.
[[nodiscard]] std::string_view nearest(std::string_view typed, std::span<const std::string_view> candidates);

// Returns ", did you mean 'X'?", or an empty string if nothing is close.
[[nodiscard]] std::string did_you_mean(std::string_view typed, std::span<const std::string_view> candidates);

}  // namespace mavloom
