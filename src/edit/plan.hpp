// SPDX-License-Identifier: MIT
// The options of the editing stage, parsed and looked up once, ready to apply to frames.
// Private to the module edit. Building a plan allocates.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mavloom/base/result.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/dialect/rate_limiter.hpp"
#include "mavloom/edit/stage.hpp"

namespace mavloom::edit {

// A value of `--set`: bytes to copy into the payload of each message with this id.
struct Patch {
    std::uint32_t id = 0;
    std::uint8_t offset = 0, size = 0;
    std::array<std::uint8_t, wire::max_payload_length> bytes{};
};

using SystemMap = std::array<std::uint8_t, 256>;  // index: old system id; value: new one

[[nodiscard]] SystemMap identity_map() noexcept;

struct Plan {
    std::vector<Patch> patches;  // by ascending id
    dialect::RateLimiter<WallTime> limiter;
    SystemMap forward = identity_map(), backward = identity_map();
    bool remaps = false;
    std::vector<std::string> warnings;  // rates that interfere with protocols
};

// Errors are `usage`; their text starts with the name of the option.
[[nodiscard]] SetupResult<Plan> make_plan(const dialect::Dialect& dialect, const Options& options);

}  // namespace mavloom::edit
