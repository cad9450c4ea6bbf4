// SPDX-License-Identifier: MIT
// Formats message definitions for `mavloom dialect`: columns for people, one JSON object per line for programs.
// Each function appends to `out`. docs/guide/dialects.md lists the JSON keys.
#pragma once

#include <fmt/format.h>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::app {

void print_list(fmt::memory_buffer& out, const dialect::Dialect& dialect);
void print_message(fmt::memory_buffer& out, const dialect::Message& message);
void print_enum(fmt::memory_buffer& out, const dialect::Enum& e);
void print_entry(fmt::memory_buffer& out, const dialect::Enum& owner, const dialect::EnumEntry& entry);

void json_list(fmt::memory_buffer& out, const dialect::Dialect& dialect);
void json_message(fmt::memory_buffer& out, const dialect::Message& message);
void json_enum(fmt::memory_buffer& out, const dialect::Enum& e);
void json_entry(fmt::memory_buffer& out, const dialect::Enum& owner, const dialect::EnumEntry& entry);

// Returns `text`, which is UTF-8, as a quoted JSON string.
[[nodiscard]] std::string json_quoted(std::string_view text);

}  // namespace mavloom::app
