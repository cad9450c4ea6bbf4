// SPDX-License-Identifier: MIT
// Files that hold one short secret, such as a key or a token.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"

namespace mavloom {

inline constexpr std::size_t longest_secret_bytes = 1023;

// Returns the file's text. Fails with SetupCode::bad_input if it cannot be read, is no regular file, can be read by
// others, or is longer than `longest_secret_bytes`. `what` names it in errors, as in "key file". Any thread.
[[nodiscard]] SetupResult<std::string> read_secret_file(const std::filesystem::path& file, std::string_view what);

}  // namespace mavloom
