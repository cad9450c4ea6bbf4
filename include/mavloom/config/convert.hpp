// SPDX-License-Identifier: MIT
// Turns a configuration of mavlink-router (main.conf: an INI file with [General], [UartEndpoint x], [UdpEndpoint x], [TcpEndpoint x]) into
// ours, and names what it could not carry over. Keys and defaults are those of mavlink-router's documented sample; docs/guide/configuration.md
// has the table. Free functions without state; they allocate.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/result.hpp"

namespace mavloom::config {

// Something of the old file that has no counterpart, or that was decided for the user.
struct ConversionNote {
    std::uint32_t line = 0;
    std::string section;  // as it is written there, without brackets
    std::string key;      // empty: the section as a whole
    std::string text;
};

struct Conversion {
    std::string toml;                   // a configuration that `parse_config` takes
    std::vector<ConversionNote> notes;  // in the order of the file
};

// Errors are `bad_input` and begin with FILE:LINE:.
[[nodiscard]] SetupResult<Conversion> convert_mavlink_router(std::string_view text, std::string_view file_name);
[[nodiscard]] SetupResult<Conversion> convert_mavlink_router_file(const std::filesystem::path& file);

}  // namespace mavloom::config
