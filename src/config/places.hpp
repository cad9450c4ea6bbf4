// SPDX-License-Identifier: MIT
// Finds endpoints that would use the same port or file on this machine. Private to module config; pure functions.
#pragma once

#include <string_view>

#include "mavloom/config/config.hpp"

namespace mavloom::config::detail {

// Returns the line of the first key in `keys` that the file sets; 0 if it sets none of them.
[[nodiscard]] std::uint32_t line_of(const Section& section, std::span<const std::string_view> keys);

// Calls `use(endpoint, its section)` for each endpoint, and stops at the first error.
template <class Use>
SetupResult<void> each_endpoint(const Config& config, Use&& use) {
    auto endpoint = config.endpoints.begin();
    for (const Section& section : config.sections) {
        if (section.name != "endpoint") continue;
        if (auto done = use(*endpoint++, section); !done) return done;
    }
    return {};
}

// Refuses two recordings to the same file.
[[nodiscard]] SetupResult<void> check_recordings(const Config& config, std::string_view file_name);

}  // namespace mavloom::config::detail
