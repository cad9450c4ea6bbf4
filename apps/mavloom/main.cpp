// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <optional>
#include <span>
#include <sstream>

#include "command.hpp"
#include "mavloom/base/shown.hpp"
#include "mavloom/base/suggest.hpp"
#include "mavloom/base/version.hpp"
#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/link/links.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "signals.hpp"
#include "wrapped.hpp"
#ifndef MAVLOOM_MINIMAL
#include "mavloom/ws/transport.hpp"
#endif

namespace mavloom::app {

namespace {

constexpr std::array commands{
    Command{"route", "forward frames unchanged between any number of links", declare_route, true, true},
#ifndef MAVLOOM_MINIMAL
    Command{"listen", "decode and print every message that arrives", declare_listen},
    Command{"relay", "decode frames, optionally edit them, re-encode and forward them", declare_relay, true, true},
    Command{"record", "write received frames to a .tlog file", declare_record},
    Command{"replay", "send a recording at its own pace", declare_replay},
    Command{"info", "summarize recordings: vehicles, modes, distance, battery, warnings, losses", declare_info},
    Command{"sim", "simulate vehicles that ground stations take for real", declare_sim},
    Command{"web", "show live telemetry to viewers (Foxglove, Lichtblick, PlotJuggler) and curl", declare_web, true,
            true},
    Command{"top", "show vehicles, messages, links and alarms in the terminal, live", declare_top},
    Command{"doctor", "say what is wrong with links or recordings, where, why, and what to do", declare_doctor},
    Command{"demo", "run the whole system on this machine: vehicle, router, Python, relay, page", declare_demo, true,
            true},
#endif
    Command{"ctl", "inspect and command a running router or simulator", declare_ctl, false},
    Command{"stat", "print the counters of a running router, simulator or ring", declare_stat, false},
#ifndef MAVLOOM_MINIMAL
    Command{"shm", "manage shared-memory rings: list, stat, write, read, remove", declare_shm, false},
    Command{"key", "make signing keys", declare_key, false},
    Command{"dialect", "look up and check message definitions", declare_dialect},
    Command{"check", "validate a configuration or scenario file", declare_check},
    Command{"bench", "measure Mavloom's throughput on this machine", declare_bench},
    Command{"manual", "print the command reference as a manual page or Markdown", declare_manual, false, false, true},
    Command{"completion", "print what a shell needs to complete Mavloom's command lines", declare_completion, false,
            false, true},
#endif
};

constexpr std::string_view rest_of_footer =
    "\nExample: mavloom route udpin://0.0.0.0:14550 tcpin://0.0.0.0:5760\n"
    "Exit status: 0 done, 1 failed, 2 wrong use, 3 bad input file, 4 loss or mismatch found, 130/143 ended by a "
    "signal.";

// Recordings are no links; every program writes them.
bool is_usable(const endpoint::SchemeRow& row) {
    return row.form == endpoint::Form::recording || link::Links::can_open(row.scheme);
}

std::string footer() {
    std::string text =
        "`mavloom help COMMAND` prints the options and examples of a command.\n\nEndpoints "
        "(docs/guide/endpoints.md):\n";
    for (const auto& row : endpoint::scheme_rows)
        if (is_usable(row)) text += fmt::format("  {:<28}{}\n", endpoint::form_of(row), row.help);
    return text.append(rest_of_footer);
}

void add_common(CLI::App& sub, Common& common, const Command& command) {
    auto* const verbose = sub.add_flag("-v,--verbose", common.verbose, "log more to stderr");
    if (!command.is_verbose) verbose->group("");  // taken, but not listed
    sub.add_flag("-q,--quiet", common.quiet, "log only errors to stderr; stdout stays the same");
    if (!command.uses_dialect) return;
    sub.add_option("--dialect", common.dialect_files,
                   "message definitions (MAVLink XML) to add to the built-in ones; may be repeated")
        ->type_name("FILE")
        ->allow_extra_args(false);
}

// CLI11 prints a description as one line, however long it is.
class HelpFormatter : public CLI::Formatter {
    [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override {
        return in_column(option->get_description());
    }
    [[nodiscard]] std::string make_subcommand(const CLI::App* command) const override {
        std::ostringstream text;
        CLI::detail::format_help(text, command->get_name(), in_column(command->get_description()), get_column_width());
        return text.str();
    }
    [[nodiscard]] std::string in_column(const std::string& description) const {
        constexpr int usual = 100, narrowest = 60, widest = 120;
        const int width = std::clamp(width_of_output(usual), narrowest, widest);
        auto text = wrapped(description, width - static_cast<int>(get_column_width()), 0);
        text.pop_back();
        return text;
    }
};

// Prints two lines to stderr: what is wrong, and where to find the help.
Exit wrong_use(std::string_view what, std::string_view command) {
    write_stderr_line(fmt::format("mavloom: {}", what));
    write_stderr_line(fmt::format("Try 'mavloom{}{} --help'.", command.empty() ? "" : " ", command));
    return Exit::wrong_use;
}

Exit unknown_command(std::string_view typed) {
    std::array<std::string_view, commands.size()> names;
    for (std::size_t i = 0; i < commands.size(); ++i) names[i] = commands[i].name;
    return wrong_use(fmt::format("unknown command '{}'{}", typed, did_you_mean(typed, names)), "");
}

// Rejects empty values: an empty option looks like one that was not given.
void refuse_empty_values(CLI::App& command) {
    for (auto* option : command.get_options([](const CLI::Option* o) { return o->nonpositional(); }))
        option->check([](const std::string& value) { return value.empty() ? "the value is empty" : ""; });
    for (auto* sub : command.get_subcommands([](const CLI::App*) { return true; })) refuse_empty_values(*sub);
}

// Returns the word that lacks "--to" in "mavloom replay flight.tlog udpout://...": one that is not expected, or the
// last of several sources of relay. Null if there is none.
const std::string* destination_without_option(const CLI::ParseError& error, const CLI::App& command,
                                              const std::vector<std::string>& left) {
    if (command.get_option_no_throw("--to") == nullptr) return nullptr;
    const auto* const sources = command.get_option_no_throw("source");
    const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    const std::string* word = left.empty() ? nullptr : &left.front();
    if (is_missing && sources != nullptr && sources->count() > 1) word = &sources->results().back();
    return word != nullptr && endpoint::parse_endpoint(*word) ? word : nullptr;
}

// For example "; to send to udpout://..., type mavloom replay flight.tlog --to udpout://...".
std::string destination_hint(std::span<const std::string> words, const std::string& destination) {
    std::string line = "mavloom";
    for (const auto& word : words.subspan(1))
        line += fmt::format(" {}{}", word == destination ? "--to " : "", shown(word));
    return fmt::format("; to send to {}, type {}", shown(destination), line);
}

// The options and subcommands of a command, and the options of its parents, which it also takes.
std::vector<std::string> known_words(const CLI::App& command, const CLI::App& app) {
    std::vector<std::string> known;
    const CLI::App* at = &command;
    do {
        for (const auto* option : at->get_options())
            for (const auto& name : option->get_lnames()) known.push_back("--" + name);
        at = at->get_parent();
    } while (at != nullptr && at != &app);
    for (const auto* sub : command.get_subcommands([](const CLI::App*) { return true; }))
        known.push_back(sub->get_name());
    return known;
}

// Returns CLI11's error text. For an unknown option or subcommand, suggests the nearest spelling.
std::string explain(const CLI::ParseError& error, const CLI::App& app, std::span<const std::string> words) {
    const CLI::App* command = &app;
    while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
    const auto left = app.remaining(true);
    const auto what = left.empty() ? std::string(error.what())
                                   : fmt::format("{} is not expected here", in_quotes(left.front()));
    if (const auto* to = destination_without_option(error, *command, left)) return what + destination_hint(words, *to);
    if (left.empty()) return what;
    const auto known = known_words(*command, app);
    return what + did_you_mean(left.front(), std::vector<std::string_view>(known.begin(), known.end()));
}

const Command* find_command(std::string_view name) {
    const auto* const found = std::ranges::find(commands, name, &Command::name);
    return found == commands.end() ? nullptr : &*found;
}

bool is_command(std::string_view word) { return find_command(word) != nullptr; }

// Returns an error text for an option before the command, as in "mavloom --dialect mine.xml listen ...".
std::optional<std::string> option_before_command(std::span<const std::string> arguments) {
    const std::string_view first = arguments.size() > 1 ? arguments[1] : std::string_view{};
    if (!first.starts_with('-') || first == "-h" || first == "--help") return std::nullopt;
    const auto command = std::ranges::find_if(arguments, is_command);
    if (command == arguments.end()) return std::nullopt;
    return fmt::format("{} comes before the command; options go after it: mavloom {} ... {}", in_quotes(first),
                       *command, shown(first));
}

constexpr std::string_view help_command = "help";

// "mavloom help" and "mavloom help COMMAND" are "mavloom --help" and "mavloom COMMAND --help".
std::vector<std::string> words_of(int argc, char** argv) {
    std::vector<std::string> words(argv, argv + argc);
    const bool wants_help = words.size() > 1 && words[1] == help_command;
    while (words.size() > 1 && words[1] == help_command) words.erase(words.begin() + 1);
    if (wants_help) words.emplace_back("--help");
    return words;
}

std::vector<const char*> pointers_to(std::span<const std::string> words) {
    std::vector<const char*> pointers;
    for (const auto& word : words) pointers.push_back(word.c_str());
    return pointers;
}

using Runs = std::vector<std::pair<CLI::App*, Run>>;

// Adds the command that `first` names, or the names of all: declaring all options of all commands takes milliseconds.
Runs add_commands(CLI::App& app, Common& common, std::string_view first) {
    const auto* const named = find_command(first);
    Runs runs;
    for (const auto& command : commands) {
        const bool is_declared = named != nullptr && (named == &command || named->knows_all);
        if (named != nullptr && !is_declared) continue;
        auto* const sub = app.add_subcommand(std::string(command.name), std::string(command.description));
        if (!is_declared) continue;
        add_common(*sub, common, command);
        runs.emplace_back(sub, command.declare(Arguments(sub), common));
        refuse_empty_values(*sub);
    }
    return runs;
}

Exit run(std::span<const std::string> words) {
    const std::string_view first = words.size() > 1 ? words[1] : std::string_view{};
    if (first == "--version") {
        fmt::print("mavloom {}\n", version());
        return Exit::done;
    }
    if (!first.empty() && first[0] != '-' && !is_command(first)) return unknown_command(first);
    if (const auto misplaced = option_before_command(words)) return wrong_use(*misplaced, "");

    Common common;
    CLI::App app{"Moves MAVLink telemetry between vehicles, ground stations, programs and recordings.", "mavloom"};
    app.formatter(std::make_shared<HelpFormatter>());
    app.footer(footer());
    app.require_subcommand(1);
    app.add_flag("--version")->description("print the version");
    const auto runs = add_commands(app, common, first);
    try {
        app.parse(static_cast<int>(words.size()), pointers_to(words).data());
    } catch (const CLI::Success& help) {
        app.exit(help);
        return Exit::done;
    } catch (const CLI::ParseError& error) {
        return wrong_use(explain(error, app, words), is_command(first) ? first : "");
    }
    for (const auto& [sub, run_command] : runs)
        if (sub->parsed()) return run_command();
    return Exit::wrong_use;
}

}  // namespace

Exit fail(const SetupError& error) {
    const auto status = error.code == SetupCode::usage       ? Exit::wrong_use
                        : error.code == SetupCode::bad_input ? Exit::bad_input
                                                             : Exit::failed;
    return fail(status, error.text);
}

SetupError of_input_file(SetupError error) {
    if (error.code != SetupCode::usage) error.code = SetupCode::bad_input;
    return error;
}

void write_stderr(std::string_view text) noexcept {
    while (!text.empty()) {
        const auto written = ::write(STDERR_FILENO, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return;  // stderr is closed or full
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void write_stderr_line(std::string_view line) { write_stderr(erase_progress() + printable(line) + "\n"); }

Exit fail(Exit status, std::string_view text) {
    write_stderr_line(fmt::format("mavloom: {}", text));
    return status;
}

void print_notice(const Common& common, std::string_view text) {
    if (!common.quiet) write_stderr_line(fmt::format("mavloom: {}", text));
}

// If the program starts with a standard descriptor closed, the first socket that it opens would get that number.
// /dev/null takes the number instead. It is opened for reading only, so that writing to it still fails.
void keep_standard_descriptors() noexcept {
    for (int fd = ::open("/dev/null", O_RDONLY); fd >= 0; fd = ::open("/dev/null", O_RDONLY)) {
        if (fd <= STDERR_FILENO) continue;
        ::close(fd);
        return;
    }
}

// Shells often allow 1,024 descriptors and let programs raise that. Each TCP client takes one.
void allow_many_descriptors() noexcept {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

SetupResult<dialect::Dialect> load_dialect(const Common& common) {
    dialect::Dialect all = dialect::default_dialect();
    for (const auto& file : common.dialect_files) {
        auto more = dialect::Dialect::load(file);
        if (!more) return tl::unexpected(of_input_file(std::move(more.error())));
        auto both = all.with(*more);
        if (!both) return tl::unexpected(std::move(both.error()));
        all = std::move(*both);
    }
    return all;
}

// Fixes malloc's thresholds at their first values, in bytes. Otherwise malloc raises them when large areas are freed,
// and keeps what a link's queue or a report needed once.
static void return_freed_memory() noexcept {
#ifdef __GLIBC__
    constexpr int threshold = 128 * 1024;
    ::mallopt(M_MMAP_THRESHOLD, threshold);
    ::mallopt(M_TRIM_THRESHOLD, threshold);
#endif
}

}  // namespace mavloom::app

int main(int argc, char** argv) {
    // A closed pipe and a file at its size limit are errors of write(), which each caller handles.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    mavloom::app::return_freed_memory();
    mavloom::app::Signals::watch();
    mavloom::app::Signals::survive_lost_rings();
    mavloom::app::keep_standard_descriptors();
    mavloom::app::allow_many_descriptors();
#ifndef MAVLOOM_MINIMAL
    mavloom::ws::register_transports();
#endif
    const auto status = mavloom::app::run(mavloom::app::words_of(argc, argv));
    if (std::fflush(stdout) != 0 && status == mavloom::app::Exit::done && errno != EPIPE)
        return static_cast<int>(
            mavloom::app::fail(mavloom::system_error("cannot write to standard output", errno).value()));
    return static_cast<int>(status);
}
