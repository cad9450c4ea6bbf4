// SPDX-License-Identifier: MIT
// What the endpoints of a configuration take of this machine. Private to module config; pure.
#pragma once

#include <string_view>

#include "mavloom/config/config.hpp"

namespace mavloom::config::detail {

// Where the file gives the first of these keys; 0 where it gives none.
[[nodiscard]] std::uint32_t line_of(const Section& section, std::span<const std::string_view> keys);

// Calls `use(endpoint, its section)` for each endpoint of the file until an error.
template <class Use>
SetupResult<void> each_endpoint(const Config& config, Use&& use) {
    auto endpoint = config.endpoints.begin();
    for (const Section& section : config.sections) {
        if (section.name != "endpoint") continue;
        if (auto done = use(*endpoint++, section); !done) return done;
    }
    return {};
}

// Refuses (`bad_input`, with file and line) two endpoints that bind the same port, as far as that can be said without looking a name up.
[[nodiscard]] SetupResult<void> check_ports(const Config& config, std::string_view file_name);

// Refuses two recordings in one file.
[[nodiscard]] SetupResult<void> check_recordings(const Config& config, std::string_view file_name);

}  // namespace mavloom::config::detail
