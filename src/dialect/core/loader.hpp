// SPDX-License-Identifier: MIT
// Follows includes from a top file, breadth first, each file once (so that circles and diamonds are harmless), and merges what the files say
// into one set of records. Bounded in files and bytes. Merging follows pymavlink's mavgen: enums of one name become one; an entry whose value was not
// given moves out of the way of one whose value was.
#pragma once

#include <filesystem>

#include "definitions.hpp"
#include "records.hpp"

namespace mavloom::dialect {

inline constexpr std::size_t max_files = 200;
inline constexpr std::size_t max_total_bytes = 32u << 20;
inline constexpr std::size_t max_messages = 20'000;

// Everything from the top file and its includes, in the order of the files.
[[nodiscard]] SetupResult<FileDefinitions> read_with_includes(const std::filesystem::path& top, Records& records);

// Fills `records.enums` and `records.messages`.
[[nodiscard]] SetupResult<void> merge(FileDefinitions definitions, Records& records);

}  // namespace mavloom::dialect
