// SPDX-License-Identifier: MIT
// JSON with its keys in the order in which they are given. Private to module web.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace mavloom::web {

using Json = nlohmann::ordered_json;

// Bytes that are not UTF-8 become U+FFFD.
inline std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace mavloom::web
