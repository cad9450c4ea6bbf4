// SPDX-License-Identifier: MIT
#include "router/report/json_line.hpp"

#include <nlohmann/json.hpp>

namespace mavloom::router {

std::string line_of(const Json& object) { return object.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace mavloom::router
