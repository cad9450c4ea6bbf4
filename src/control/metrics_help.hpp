// SPDX-License-Identifier: MIT
// The HELP texts of the metrics. Private to module control; constant data.
#pragma once

#include <string_view>

namespace mavloom::control {

// Returns the meaning of the counter, or its name if the table does not have it.
[[nodiscard]] std::string_view help_of(std::string_view counter) noexcept;

}  // namespace mavloom::control
