// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "arguments.hpp"

namespace mavloom::app {

// --fault-log of the commands whose links take faults; for fault::log_to.
inline void declare_fault_log(Arguments& command, std::string& file) {
    command.add_option("--fault-log", "FILE", file,
                       "write a line for each fault that links have on purpose (docs/guide/faults.md)");
}

}  // namespace mavloom::app
