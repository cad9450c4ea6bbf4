// SPDX-License-Identifier: MIT
// Reads the text of a configuration, bounded: a recording or a device was meant for something else. Private to module config.
#pragma once

#include <filesystem>
#include <string>

#include "mavloom/base/result.hpp"

namespace mavloom::config::detail {

[[nodiscard]] SetupResult<std::string> read_config_text(const std::filesystem::path& file);

}  // namespace mavloom::config::detail
