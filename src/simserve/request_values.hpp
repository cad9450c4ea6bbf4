// SPDX-License-Identifier: MIT
// Reads the values of requests of `mavloom ctl`. Private to module simserve; pure functions. Errors are `usage`.
#pragma once

#include <fmt/format.h>

#include <optional>

#include "control/json_request.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::simserve {

// Empty if the request does not have the key.
[[nodiscard]] inline SetupResult<std::optional<double>> number_at(const control::Json& request, const char* key) {
    const auto at = request.find(key);
    if (at == request.end()) return std::nullopt;
    if (!at->is_number()) return setup_error(SetupCode::usage, fmt::format("'{}' is not a number", key));
    return at->get<double>();
}

// False if the request does not have the key.
[[nodiscard]] inline SetupResult<bool> flag_at(const control::Json& request, const char* key) {
    const auto at = request.find(key);
    if (at == request.end()) return false;
    if (!at->is_boolean()) return setup_error(SetupCode::usage, fmt::format("'{}' is neither true nor false", key));
    return at->get<bool>();
}

}  // namespace mavloom::simserve
