// SPDX-License-Identifier: MIT
// The subcommands of `mavloom shm`: list, stat, write, read and remove.
// Each has its own source file with one function. That function declares the options and returns the function to run,
// like those in command.hpp. The table in shm.cpp lists all subcommands.
#pragma once

#include <chrono>
#include <string>

#include "command.hpp"
#include "mavloom/base/clock.hpp"

namespace mavloom::app::shm_parts {

Run declare_list(Arguments, const Common&);
Run declare_stat(Arguments, const Common&);
Run declare_write(Arguments, const Common&);
Run declare_read(Arguments, const Common&);
Run declare_remove(Arguments, const Common&);

// How often a subcommand that waits for a ring checks for signals.
inline constexpr Nanoseconds signal_poll_interval = std::chrono::milliseconds{100};

// Arguments that several subcommands take.
inline void add_name(Arguments part, std::string& name) {
    part.add_option("NAME", "TEXT", name, "the ring: letters, digits, _ and -").required();
}
inline void add_json(Arguments part, bool& json) { part.add_flag("--json", json, "print one JSON object per line"); }

}  // namespace mavloom::app::shm_parts
