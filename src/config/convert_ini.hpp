// SPDX-License-Identifier: MIT
// The INI form that mavlink-router reads: sections, `key = value`, comments on lines of their own. Names keep their case; a section that is
// opened again goes on, a key that is given again has the last value. Private to module config.
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

    // Case is ignored, as mavlink-router does.
    [[nodiscard]] const IniEntry* find(std::string_view key) const noexcept;
};

// Errors are `bad_input` and begin with FILE:LINE:.
[[nodiscard]] SetupResult<std::vector<IniSection>> parse_ini(std::string_view text, std::string_view file_name);

[[nodiscard]] bool same_word(std::string_view a, std::string_view b) noexcept;  // but for the case of ASCII letters

}  // namespace mavloom::config::detail
