// SPDX-License-Identifier: MIT
// The table of configuration keys outside [[endpoint]]. The file, the environment, the options of `mavloom route` and
// `mavloom check` all use it. Constant data.
#pragma once

#include <span>
#include <string_view>

#include "mavloom/config/config.hpp"

namespace mavloom::config {

// The option of `mavloom route` that sets a key.
struct KeyOption {
    const char* name = nullptr;         // "--dedup-ms"; null: no option
    const char* placeholder = nullptr;  // null: a flag, which sets "true"
    const char* description = nullptr;
};

struct ConfigKey {
    std::string_view section, name;
    std::string_view default_text;  // empty: not set
    SetupResult<void> (*set)(Config&, std::string_view);
    KeyOption option{};
};

[[nodiscard]] std::span<const ConfigKey> config_keys() noexcept;
// "router", "ring", "record", "log", "web".
[[nodiscard]] std::span<const std::string_view> config_sections() noexcept;

// The keys of [web], which scenarios have too. Lists are separated by commas.
[[nodiscard]] SetupResult<void> set_web_listen(WebConfig& web, std::string_view text);
[[nodiscard]] SetupResult<void> set_web_origins(WebConfig& web, std::string_view text);
[[nodiscard]] SetupResult<void> set_web_hosts(WebConfig& web, std::string_view text);
[[nodiscard]] SetupResult<void> set_web_token_file(WebConfig& web, std::string_view text);

}  // namespace mavloom::config
