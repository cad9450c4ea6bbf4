// SPDX-License-Identifier: MIT
#include "runtime/json_line.hpp"

#include <nlohmann/json.hpp>

namespace mavloom::runtime {

std::string line_of(const Json& object) { return object.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace mavloom::runtime
