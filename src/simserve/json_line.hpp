// SPDX-License-Identifier: MIT
// JSON for the control socket: one object per line, with the keys in insertion order. Private to module simserve.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mavloom::simserve {

using Json = nlohmann::ordered_json;

// Formats one object as one line. Strings from outside may hold any bytes; invalid UTF-8 becomes U+FFFD.
[[nodiscard]] inline std::string line_of(const Json& object) {
    return object.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace mavloom::simserve
