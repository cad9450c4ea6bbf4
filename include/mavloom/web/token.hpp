// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "mavloom/base/result.hpp"

namespace mavloom::web {

// Returns the token in the file, for Options::token; "" if `file` is empty. Errors are those of read_secret_file, and a
// token that is shorter than 16 letters or has others than letters, digits and -._~, which need no escape in a URL.
[[nodiscard]] SetupResult<std::string> read_token(const std::string& file);

}  // namespace mavloom::web
