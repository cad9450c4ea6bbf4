// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cctype>
#include <sstream>

#include "manual/pages.hpp"
#include "mavloom/base/version.hpp"

namespace mavloom::app {

namespace {

// mdoc takes lines that begin with a dot or an apostrophe for macros, and a backslash for an escape.
std::string literal(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n')) out += "\\&";
        if (c == '\\') out += "\\e";
        else if (c == '-') out += "\\-";
        else out += c;
    }
    return out;
}

// An argument of a macro: short words could be the names of macros, and brackets delimiters.
std::string argument(std::string_view text) {
    std::string out = "\\&";
    for (const char c : text) out += c == ' ' ? std::string("\\ ") : literal(std::string_view(&c, 1));
    return out;
}

std::string upper(std::string text) {
    for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return text;
}

// "Fl o , Fl \-output Ar FILE"
std::string names_of(const DeclaredOption& option) {
    std::string text;
    for (const auto& name : option.names) {
        if (!text.empty()) text += " , ";
        text += option.is_positional ? "Ar " + argument(option.placeholder)
                                     : "Fl " + literal(std::string_view(name).substr(1));
    }
    if (!option.is_positional && !option.placeholder.empty()) text += " Ar " + argument(option.placeholder);
    return text;
}

void add_synopsis(std::string& text, const DeclaredCommand& command) {
    for (const auto& option : command.options) {
        const std::string more = option.is_repeatable ? " ..." : "";
        text += fmt::format(".{}{}{}\n", option.is_required ? "" : "Op ", names_of(option), more);
    }
    if (!command.subcommands.empty()) text += ".Ar command ...\n";
}

void add_options(std::string& text, const DeclaredCommand& command) {
    if (command.options.empty()) return;
    text += ".Bl -tag -width Ds\n";
    for (const auto& option : command.options) {
        text += fmt::format(".It {}\n{}\n", names_of(option), literal(option.description));
        if (!option.choices.empty()) text += literal(fmt::format("One of: {}.\n", fmt::join(option.choices, ", ")));
    }
    text += ".El\n";
}

// Lines stay as they are: footers have tables and examples.
void add_footer(std::string& text, const std::string& footer) {
    if (footer.empty()) return;
    text += ".Sh NOTES\n.Bd -literal\n";
    std::istringstream lines(footer);
    for (std::string line; std::getline(lines, line);) text += literal(line) + "\n";
    text += ".Ed\n";
}

void add_commands(std::string& text, const DeclaredCommand& command, bool have_pages) {
    if (command.subcommands.empty()) return;
    text += ".Sh COMMANDS\n.Bl -tag -width Ds\n";
    for (const auto& sub : command.subcommands) {
        text += have_pages ? fmt::format(".It Xr mavloom-{} 1\n", sub.name)
                           : fmt::format(".It Cm {}", argument(sub.name));
        if (!have_pages) {
            for (const auto& option : sub.options)
                if (option.is_positional) text += " Ar " + argument(option.placeholder);
            text += "\n";
        }
        text += literal(sub.description) + "\n";
        if (have_pages) continue;
        add_options(text, sub);
    }
    text += ".El\n";
}

}  // namespace

std::string manual_page(const DeclaredCommand& program, const DeclaredCommand* command, const std::string& date) {
    const auto& shown = command == nullptr ? program : *command;
    const auto name = command == nullptr ? std::string("mavloom") : "mavloom-" + command->name;
    const auto about = literal(shown.description.substr(0, shown.description.find_last_not_of('.') + 1));
    std::string text = fmt::format(".Dd {}\n.Dt {} 1\n.Os Mavloom {}\n.Sh NAME\n.Nm {}\n.Nd {}\n.Sh SYNOPSIS\n", date,
                                   upper(name), version(), name, about);
    text += command == nullptr ? ".Nm mavloom\n" : fmt::format(".Nm mavloom {}\n", command->name);
    add_synopsis(text, shown);
    text += fmt::format(".Sh DESCRIPTION\n{}{}.\n", static_cast<char>(std::toupper(about.front())), about.substr(1));
    add_options(text, shown);
    add_commands(text, shown, command == nullptr);
    add_footer(text, shown.footer);
    text += command == nullptr ? ".Sh SEE ALSO\nThe guides are in\n.Pa /usr/share/doc/mavloom\n"
                               : ".Sh EXIT STATUS\n0 done, 1 failed, 2 wrong use, 3 bad input file, 4 loss or mismatch "
                                 "found, 130 or 143 ended by a signal.\n.Sh SEE ALSO\n.Xr mavloom 1\n";
    return text;
}

}  // namespace mavloom::app
