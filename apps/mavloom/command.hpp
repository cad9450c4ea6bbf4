// SPDX-License-Identifier: MIT
// The interface between main() and the subcommands.
// Each subcommand has its own source file with one function. That function declares the options and returns the
// function to run after parsing. The table in main.cpp lists all commands; the help text is generated from it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "arguments.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"

namespace mavloom::app {

// Exit statuses of every command. Values from 129 up are 128 plus the number of the signal that ended the command.
enum class Exit : int {
    done = 0,
    failed = 1,
    wrong_use = 2,
    bad_input = 3,
    mismatch = 4,
    hung_up = 129,
    interrupted = 130,
    terminated = 143
};

// Options that the commands share.
struct Common {
    int verbose = 0;
    bool quiet = false;
    std::vector<std::string> dialect_files;  // --dialect FILE, repeatable; only if Command::uses_dialect
};

using Run = std::function<Exit()>;
// Declares the options and returns the function to run. `common` outlives that function.
using Declare = Run (*)(Arguments command, const Common& common);

struct Command {
    std::string_view name;
    std::string_view description;
    Declare declare;
    bool uses_dialect = true;  // accepts --dialect
    bool is_verbose = false;   // --verbose has an effect
    bool knows_all = false;    // reads the declarations of all commands
};

Run declare_route(Arguments, const Common&);
Run declare_sim(Arguments, const Common&);
Run declare_web(Arguments, const Common&);
Run declare_top(Arguments, const Common&);
Run declare_doctor(Arguments, const Common&);
Run declare_demo(Arguments, const Common&);
Run declare_ctl(Arguments, const Common&);
Run declare_stat(Arguments, const Common&);
Run declare_key(Arguments, const Common&);
Run declare_listen(Arguments, const Common&);
Run declare_relay(Arguments, const Common&);
Run declare_record(Arguments, const Common&);
Run declare_replay(Arguments, const Common&);
Run declare_info(Arguments, const Common&);
Run declare_dialect(Arguments, const Common&);
Run declare_check(Arguments, const Common&);
Run declare_shm(Arguments, const Common&);
Run declare_bench(Arguments, const Common&);
Run declare_manual(Arguments, const Common&);
Run declare_completion(Arguments, const Common&);

// Prints "mavloom: TEXT" to stderr and returns the exit status for the error.
Exit fail(const SetupError& error);
Exit fail(Exit status, std::string_view text);
// Converts an error of an input file. Every error except a usage error becomes bad_input (status 3), so a missing or
// unreadable file is treated like one with wrong content.
SetupError of_input_file(SetupError error);
// Writes raw text to stderr. Ignores write errors: a closed or full stderr never ends a command.
void write_stderr(std::string_view text) noexcept;
// Writes one line to stderr. Replaces control characters, which names and values from outside may contain.
void write_stderr_line(std::string_view line);
// Opens /dev/null for each standard descriptor that was closed at start.
void keep_standard_descriptors() noexcept;
// Prints "mavloom: TEXT" to stderr, unless --quiet.
void print_notice(const Common& common, std::string_view text);
// Prints "mavloom: 2026-11-28 12:34:56 TEXT" to stderr, in local time, unless --quiet. The journal keeps the time
// itself, so there the line has none. For what a command reports while it runs, not at its start or end.
void print_event(const Common& common, std::string_view text);

// Returns the built-in definitions with those of every --dialect file added.
SetupResult<dialect::Dialect> load_dialect(const Common& common);

}  // namespace mavloom::app
