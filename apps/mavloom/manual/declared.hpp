// SPDX-License-Identifier: MIT
// What the program's commands and options are called, as plain data: for the manual pages, the command reference and
// the completion of shells.
#pragma once

#include <string>
#include <vector>

namespace mavloom::app {

struct DeclaredOption {
    std::vector<std::string> names{};  // with dashes; one without dashes if it is positional
    std::string placeholder{};         // empty for a flag
    std::vector<std::string> choices{};
    std::string description{};
    bool is_positional = false, is_required = false, is_repeatable = false;
};

struct DeclaredCommand {
    std::string name, description, footer;
    std::vector<DeclaredOption> options{};
    std::vector<DeclaredCommand> subcommands{};
};

}  // namespace mavloom::app
