// SPDX-License-Identifier: MIT
// Log lines for people. Private to module router.
#pragma once

#include <functional>
#include <string_view>

#include "mavloom/base/line_budget.hpp"
#include "mavloom/config/config.hpp"

namespace mavloom::router {

using Notice = std::function<void(config::LogLevel, std::string_view)>;

}  // namespace mavloom::router
