// SPDX-License-Identifier: MIT
// How `mavloom dialect` shows definitions: for people in columns, for programs one JSON object a line (keys: docs/guide/dialects.md).
// Each function appends to `out`.
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

// A JSON string. `text` is UTF-8.
[[nodiscard]] std::string json_quoted(std::string_view text);

}  // namespace mavloom::app
