// SPDX-License-Identifier: MIT
// The options of the stage as they are applied to frames: every word looked up once. Private to module edit.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/rate_limiter.hpp"
#include "mavloom/edit/stage.hpp"

namespace mavloom::edit {

// Bytes of one field, to be copied over those of each message of this id.
struct Patch {
    std::uint32_t id = 0;
    std::uint8_t offset = 0, size = 0;
    std::array<std::uint8_t, wire::max_payload_length> bytes{};
};

using SystemMap = std::array<std::uint8_t, 256>;  // what each system id becomes

[[nodiscard]] SystemMap identity_map() noexcept;

struct Plan {
    std::vector<std::uint32_t> only;  // by rising id; empty: all
    std::vector<Patch> patches;       // by rising id
    dialect::RateLimiter<WallTime> limiter;
    SystemMap forward = identity_map(), backward = identity_map();
    bool remaps = false;
    std::vector<std::string> warnings;  // rates that break protocols

    [[nodiscard]] bool admits(std::uint32_t id) const noexcept {
        return only.empty() || std::binary_search(only.begin(), only.end(), id);
    }
};

// Errors are `usage` and begin with the option.
[[nodiscard]] SetupResult<Plan> make_plan(const dialect::Dialect& dialect, const Options& options);

}  // namespace mavloom::edit
