// SPDX-License-Identifier: MIT
// Amounts of bytes as text for people. Pure.
#pragma once

#include <string>

namespace mavloom {

// "12 B", "4.2 kB", "123 MB".
[[nodiscard]] std::string amount_text(double bytes);

}  // namespace mavloom
