// SPDX-License-Identifier: MIT
// The parts of `mavloom shm`. Each has its own file with one function, which declares the options and returns the
// function to run, as a command does (command.hpp). The table in shm.cpp lists all parts.
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

// How often a part that waits for a ring checks whether a signal arrived.
inline constexpr Nanoseconds look_at_signals = std::chrono::milliseconds{100};

// Arguments that several parts take.
inline void add_name(Arguments part, std::string& name) {
    part.add_option("NAME", name, "the ring: letters, digits, _ and -").required();
}
inline void add_json(Arguments part, bool& json) { part.add_flag("--json", json, "one JSON object a line"); }

}  // namespace mavloom::app::shm_parts
