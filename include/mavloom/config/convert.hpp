// SPDX-License-Identifier: MIT
// Converts a mavlink-router configuration into a Mavloom configuration and notes what it could not carry over.
//
// The input is mavlink-router's main.conf: an INI file with [General], [UartEndpoint x], [UdpEndpoint x] and
// [TcpEndpoint x]. Keys and defaults follow mavlink-router's documented sample file; docs/guide/configuration.md has
// the table. Stateless free functions; they allocate.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/result.hpp"

namespace mavloom::config {

// A setting without a counterpart in Mavloom, or a choice that the converter made for the user.
struct ConversionNote {
    std::uint32_t line = 0;
    std::string section;  // as written in the file, without brackets
    std::string key;      // empty: concerns the whole section
    std::string text;
};

struct Conversion {
    std::string toml;                   // valid input for `parse_config`
    std::vector<ConversionNote> notes;  // sorted by line
};

// Errors are `bad_input` and begin with FILE:LINE:.
[[nodiscard]] SetupResult<Conversion> convert_mavlink_router(std::string_view text, std::string_view file_name);
[[nodiscard]] SetupResult<Conversion> convert_mavlink_router_file(const std::filesystem::path& file);

}  // namespace mavloom::config
