// SPDX-License-Identifier: MIT
// JSON for the control socket: one object per line, with the keys in insertion order.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace mavloom::router {

using Json = nlohmann::ordered_json;

// Formats one object as one line. Strings from outside, such as names in URLs, may hold any bytes; invalid UTF-8
// becomes U+FFFD.
[[nodiscard]] std::string line_of(const Json& object);

}  // namespace mavloom::router
