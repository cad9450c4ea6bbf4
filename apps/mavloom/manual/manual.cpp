// SPDX-License-Identifier: MIT
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "command.hpp"
#include "manual/pages.hpp"
#include "mavloom/base/shown.hpp"
#include "output.hpp"

namespace mavloom::app {

namespace {

struct ManualOptions {
    std::string format, command;
};

std::string today() {
    const std::time_t now = std::time(nullptr);
    return fmt::format("{:%B %d, %Y}", fmt::gmtime(now));
}

Exit print_manual(const Arguments& self, const ManualOptions& options) {
    const auto program = self.program();
    if (options.format == "markdown") return print_at_end(markdown_page(program), Exit::done);
    const DeclaredCommand* command = nullptr;
    if (!options.command.empty()) {
        const auto found = std::ranges::find(program.subcommands, options.command, &DeclaredCommand::name);
        if (found == program.subcommands.end())
            return fail(Exit::wrong_use, fmt::format("there is no command {}", in_quotes(options.command)));
        command = &*found;
    }
    return print_at_end(manual_page(program, command, today()), Exit::done);
}

}  // namespace

Run declare_manual(Arguments command, const Common& /*common*/) {
    auto options = std::make_shared<ManualOptions>();
    command.add_option("format", "FORMAT", options->format, "mdoc: a manual page; markdown: all commands on one page")
        .required()
        .members({"mdoc", "markdown"});
    command.add_option("command", "COMMAND", options->command, "the command of the manual page; default: the program");
    command.footer("Example: mavloom manual mdoc route | man -l -");
    return [options, command] { return print_manual(command, *options); };
}

}  // namespace mavloom::app
