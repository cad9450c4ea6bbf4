// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include "manual/pages.hpp"

namespace mavloom::app {

namespace {

// A vertical bar would end the cell of a table.
std::string cell(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '|') out += '\\';
        out += c == '\n' ? ' ' : c;
    }
    return out;
}

std::string invocation(const DeclaredOption& option) {
    if (option.is_positional) return option.placeholder + (option.is_repeatable ? "..." : "");
    const auto names = fmt::format("{}", fmt::join(option.names, ", "));
    return option.placeholder.empty() ? names : names + " " + option.placeholder;
}

void add_command(std::string& text, const DeclaredCommand& command, const std::string& path) {
    text += fmt::format("\n## {}\n\n{}\n\n| option | does |\n|---|---|\n", path, command.description);
    for (const auto& option : command.options) {
        if (option.names.back() == "--help") continue;
        auto description = option.description;
        if (!option.choices.empty()) description += fmt::format(": {}", fmt::join(option.choices, ", "));
        text += fmt::format("| `{}` | {} |\n", cell(invocation(option)), cell(description));
    }
    if (!command.footer.empty()) text += fmt::format("\n```\n{}\n```\n", command.footer);
    for (const auto& sub : command.subcommands) add_command(text, sub, path + " " + sub.name);
}

}  // namespace

std::string markdown_page(const DeclaredCommand& program) {
    std::string text =
        "# Command reference\n\n`mavloom manual markdown` prints this page from the program's own options. `-q, "
        "--quiet` logs\nonly errors. `mavloom COMMAND --help` prints the same for one command.\n";
    for (const auto& command : program.subcommands) add_command(text, command, "mavloom " + command.name);
    return text;
}

}  // namespace mavloom::app
