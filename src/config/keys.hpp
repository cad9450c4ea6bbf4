// SPDX-License-Identifier: MIT
// The table of configuration keys outside [[endpoint]]: section, name, default, and how to parse the text. Private to
// module config.
#pragma once

#include <span>
#include <string_view>

#include "mavloom/config/config.hpp"

namespace mavloom::config::detail {

struct ConfigKey {
    std::string_view section, name;
    std::string_view default_text;  // empty: not set
    SetupResult<void> (*set)(Config&, std::string_view);
};

[[nodiscard]] std::span<const ConfigKey> config_keys() noexcept;
// "router", "ring", "record", "log", "web".
[[nodiscard]] std::span<const std::string_view> config_sections() noexcept;

}  // namespace mavloom::config::detail
