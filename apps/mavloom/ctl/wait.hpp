// SPDX-License-Identifier: MIT
// `mavloom ctl NAME wait`: waits until simulated vehicles are in a state.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "command.hpp"
#include "mavloom/base/clock.hpp"

namespace mavloom::app {

// Asks for the state of the vehicles: lines of JSON.
using AskState = std::function<SetupResult<std::vector<std::string>>()>;

// `words`: ready, armed, disarmed, landed, or alt and the metres above home. Returns the first answer in which all
// vehicles are in that state. A state that does not come within `limit` is an error.
[[nodiscard]] SetupResult<std::vector<std::string>> wait_for_state(const std::vector<std::string>& words,
                                                                   Nanoseconds limit, const AskState& ask);

}  // namespace mavloom::app
