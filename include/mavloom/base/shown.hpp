// SPDX-License-Identifier: MIT
// What a user typed, or a file holds, fit for a message about it. Pure; allocates the result.
#pragma once

#include <string>
#include <string_view>

namespace mavloom {

// Control characters replaced: C0, DEL, and C1 as UTF-8 writes them.
[[nodiscard]] std::string printable(std::string_view text);
// The same, cut when long.
[[nodiscard]] std::string shown(std::string_view text);
// 'text', shown.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace mavloom
