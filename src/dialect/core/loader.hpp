// SPDX-License-Identifier: MIT
// Reads an XML file with all its includes, and merges the definitions into one set of records. An included file that
// does not exist is replaced by the public file of that name. Includes are followed breadth first and each file is read
// once, so circular and repeated includes are harmless. The number of files and their total size are limited. Merging
// follows pymavlink's mavgen: enums with the same name become one enum. If the value ranges of two files overlap,
// entries without an explicit value are renumbered.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "definitions.hpp"
#include "records.hpp"

namespace mavloom::dialect {

inline constexpr std::size_t max_files = 200;
inline constexpr std::size_t max_total_bytes = 32u << 20;
inline constexpr std::size_t max_messages = 20'000;

// A definition file in memory, such as "common.xml".
struct PublicFile {
    std::string_view name, text;
};

// Returns all definitions of the top file and its includes, in the order in which the files were read.
[[nodiscard]] SetupResult<FileDefinitions> read_with_includes(const std::filesystem::path& top,
                                                              std::span<const PublicFile> public_files,
                                                              Records& records);

// Fills `records.enums` and `records.messages`. Conflicting definitions are `bad_input`.
[[nodiscard]] SetupResult<void> merge(FileDefinitions definitions, Records& records);

// The files of `dialects/` that are compiled into the binary. Not defined in `mavloom::dialect_core`.
[[nodiscard]] std::span<const PublicFile> builtin_files() noexcept;

}  // namespace mavloom::dialect
