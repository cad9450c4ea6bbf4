// SPDX-License-Identifier: MIT
// One subcommand a file: each gives a function that declares its options and returns what to run once they are parsed.
// The table in main.cpp is the list of commands, and help comes from it.
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

// DESIGN.md section 5.
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

// Options that every command has.
struct Common {
    int verbose = 0;
    bool quiet = false;
    std::vector<std::string> dialect_files;  // --dialect FILE, may be repeated
};

using Run = std::function<Exit()>;
// Declares options and returns the function to run. `common` lives as long as the program.
using Declare = Run (*)(Arguments command, const Common& common);

struct Command {
    std::string_view name;
    std::string_view description;
    Declare declare;
    bool uses_dialect = true;  // takes --dialect
};

Run declare_route(Arguments, const Common&);
Run declare_ctl(Arguments, const Common&);
Run declare_stat(Arguments, const Common&);
Run declare_key(Arguments, const Common&);
Run declare_listen(Arguments, const Common&);
Run declare_relay(Arguments, const Common&);
Run declare_record(Arguments, const Common&);
Run declare_replay(Arguments, const Common&);
Run declare_dialect(Arguments, const Common&);
Run declare_check(Arguments, const Common&);
Run declare_shm(Arguments, const Common&);
Run declare_bench(Arguments, const Common&);

// Prints "mavloom: TEXT" to stderr and gives the status that belongs to the kind of error.
Exit fail(const SetupError& error);
Exit fail(Exit status, std::string_view text);
// A file that the user named as input: missing or unreadable is status 3 like a file with wrong content.
SetupError of_input_file(SetupError error);
// Raw text on stderr. A closed or full stderr never ends a command.
void talk(std::string_view text) noexcept;
// One line on stderr in which control characters, of names and values from outside, are replaced.
void tell(std::string_view line);
void keep_standard_descriptors() noexcept;
// "mavloom: TEXT" on stderr, unless --quiet.
void say(const Common& common, std::string_view text);

// The built-in definitions with every --dialect file added.
SetupResult<dialect::Dialect> load_dialect(const Common& common);

}  // namespace mavloom::app
