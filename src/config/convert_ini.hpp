// SPDX-License-Identifier: MIT
// Reads the INI dialect of mavlink-router: sections, `key = value`, and comments on their own lines. A repeated section
// continues the first one. If a key is repeated, the last value wins. Names keep their case, but look-ups ignore the
// case. Private to module config; stateless.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/result.hpp"

namespace mavloom::config::detail {

struct IniEntry {
    std::string key, value;
    std::uint32_t line = 0;
};

struct IniSection {
    std::string name;
    std::uint32_t line = 0;
    std::vector<IniEntry> entries;
    std::vector<std::uint32_t> continued{};  // the lines of its further headings

    // Ignores case, as mavlink-router does.
    [[nodiscard]] const IniEntry* find(std::string_view key) const noexcept;
};

// Errors are `bad_input` and begin with FILE:LINE:.
[[nodiscard]] SetupResult<std::vector<IniSection>> parse_ini(std::string_view text, std::string_view file_name);

}  // namespace mavloom::config::detail
