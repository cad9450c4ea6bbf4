// SPDX-License-Identifier: MIT
// JSON as the control socket speaks it: one object a line, keys in the order they were put in.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace mavloom::router {

using Json = nlohmann::ordered_json;

// Text from outside (names in URLs) may be any bytes: what is not UTF-8 is shown as U+FFFD.
[[nodiscard]] std::string line_of(const Json& object);

}  // namespace mavloom::router
