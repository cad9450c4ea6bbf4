// SPDX-License-Identifier: MIT
// Reads the values of requests of `mavloom ctl`. Private to module simserve; pure functions. Errors are `usage`.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "control/json_request.hpp"
#include "mavloom/base/ids.hpp"
#include "mavloom/base/result.hpp"

namespace mavloom::simserve {

// Empty if the request does not have the key.
[[nodiscard]] inline SetupResult<std::optional<double>> number_at(const control::Json& request, const char* key) {
    const auto at = request.find(key);
    if (at == request.end()) return std::nullopt;
    if (!at->is_number()) return setup_error(SetupCode::usage, fmt::format("'{}' is not a number", key));
    return at->get<double>();
}

// The system id of the vehicle that the request is for; empty: all.
[[nodiscard]] inline SetupResult<std::optional<SystemId>> system_at(const control::Json& request) {
    const auto number = number_at(request, "system");
    if (!number) return tl::unexpected(number.error());
    if (!*number) return std::nullopt;
    const double id = **number;
    const bool is_id = id >= 1 && id <= 255 && id == std::floor(id);
    if (!is_id) return setup_error(SetupCode::usage, fmt::format("there is no vehicle {}", id));
    return SystemId{static_cast<std::uint8_t>(id)};
}

// The vehicles that the request is for, which `find(system)` finds.
template <class Find>
[[nodiscard]] auto vehicles_at(const control::Json& request, Find&& find)
    -> SetupResult<decltype(find(std::optional<SystemId>()))> {
    const auto system = system_at(request);
    if (!system) return tl::unexpected(system.error());
    auto found = find(*system);
    if (*system && found.empty())
        return setup_error(SetupCode::usage, fmt::format("there is no vehicle {}", (*system)->value));
    return found;
}

// False if the request does not have the key.
[[nodiscard]] inline SetupResult<bool> flag_at(const control::Json& request, const char* key) {
    const auto at = request.find(key);
    if (at == request.end()) return false;
    if (!at->is_boolean()) return setup_error(SetupCode::usage, fmt::format("'{}' is neither true nor false", key));
    return at->get<bool>();
}

}  // namespace mavloom::simserve
