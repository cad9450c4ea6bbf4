// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace mavloom::app {

// The names of all actions of `mavloom ctl`.
[[nodiscard]] std::vector<std::string> ctl_actions();

}  // namespace mavloom::app
