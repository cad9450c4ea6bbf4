// SPDX-License-Identifier: MIT
// Writes the command reference from the declarations of the commands.
#pragma once

#include <string>

#include "manual/declared.hpp"

namespace mavloom::app {

// A manual page in mdoc(7) of section 1: of `command`, or of the program if it is null. `date` is that of the page, for
// example "November 29, 2026".
[[nodiscard]] std::string manual_page(const DeclaredCommand& program, const DeclaredCommand* command,
                                      const std::string& date);
// All commands on one page of Markdown.
[[nodiscard]] std::string markdown_page(const DeclaredCommand& program);

}  // namespace mavloom::app
