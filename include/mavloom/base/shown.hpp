// SPDX-License-Identifier: MIT
// Makes text from users and files safe to print in messages. Pure; allocates the result.
#pragma once

#include <string>
#include <string_view>

namespace mavloom {

// Replaces control characters with '?': C0, DEL, and C1 in UTF-8.
[[nodiscard]] std::string printable(std::string_view text);
// Like `printable`, but cuts text longer than 120 bytes and appends "...".
[[nodiscard]] std::string shown(std::string_view text);
// Like `shown`, in single quotes.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace mavloom
