// SPDX-License-Identifier: MIT
// The request {"cmd":"fault"} of `mavloom ctl`. Modules router and simserve include this header.
#pragma once

#include <functional>
#include <string>

#include "control/json_request.hpp"
#include "mavloom/link/links.hpp"

namespace mavloom::control {

// Replaces the faults of the endpoint or link `name`: those `in`, `out` or both, with `seed` if it is there. `report`
// gets a line for the log. Refuses a request without a direction, or with a value of the wrong kind.
[[nodiscard]] Report set_faults(link::Links& links, const Json& request,
                                const std::function<void(const std::string& text)>& report);

}  // namespace mavloom::control
