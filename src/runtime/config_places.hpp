// SPDX-License-Identifier: MIT
// What the endpoints of a configuration take of this machine. Private to module runtime; pure.
#pragma once

#include <string_view>

#include "mavloom/runtime/config.hpp"

namespace mavloom::runtime::detail {

// Refuses (`bad_input`, with file and line) two endpoints that bind the same port, as far as that can be said without looking a name up.
[[nodiscard]] SetupResult<void> check_ports(const Config& config, std::string_view file_name);

// Refuses two recordings in one file.
[[nodiscard]] SetupResult<void> check_recordings(const Config& config, std::string_view file_name);

}  // namespace mavloom::runtime::detail
