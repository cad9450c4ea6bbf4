// SPDX-License-Identifier: MIT
// Answers of routers and simulators (docs/guide/route.md) as JSON lines and as text for people.
#pragma once

#include <chrono>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command.hpp"

namespace mavloom::app {

using Json = nlohmann::ordered_json;
using Lines = std::vector<std::string>;

// Asks a running program; the errors are those of control::send_request.
[[nodiscard]] SetupResult<Lines> ask(std::string_view name, const Json& request);
// Prints the lines as they are.
[[nodiscard]] Exit print_lines(const Lines& lines);

// Every nonzero counter of an object as "name 12", except those in `left_out`.
[[nodiscard]] std::string nonzero(const Json& object, std::span<const std::string_view> left_out);

// One paragraph for each object, for `stat`. Objects of unknown kinds are left out.
[[nodiscard]] std::string paragraphs_of(const Lines& lines);

// Tables for `ctl`, one for each kind of object, of lines of at most `width` characters.
[[nodiscard]] std::string tables_of(const Lines& lines, int width);

}  // namespace mavloom::app
