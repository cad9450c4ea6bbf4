// SPDX-License-Identifier: MIT
// Reads a configuration file as text, up to 4 MiB. A larger file is an error, because it is probably a recording or a
// device. Private to module config.
#pragma once

#include <filesystem>
#include <string>

#include "mavloom/base/result.hpp"

namespace mavloom::config::detail {

[[nodiscard]] SetupResult<std::string> read_config_text(const std::filesystem::path& file);

}  // namespace mavloom::config::detail
