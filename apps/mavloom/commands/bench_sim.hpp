// SPDX-License-Identifier: MIT
// `mavloom bench sim`: how fast simulated vehicles step and send, without sockets and without waiting.
#pragma once

#include <string>

#include "command.hpp"

namespace mavloom::app {

struct SimBenchOptions {
    int vehicles = 1;
    int seconds = 60;  // simulated
    int turns = 5;
    std::string profile = "px4-normal";
    std::string kind = "quad";
    std::string autopilot = "px4";
    bool flies = false;
    bool json = false;
};

Arguments declare_sim_bench(Arguments command, SimBenchOptions& options);
Exit run_sim_bench(const SimBenchOptions& options);

}  // namespace mavloom::app
