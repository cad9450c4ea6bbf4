// SPDX-License-Identifier: MIT
#include <array>

#include "mavloom/msg/heartbeat.hpp"
#include "sim/telemetry/streams.hpp"

namespace mavloom::sim {

namespace {

constexpr std::array lite{StreamRate{msg::Heartbeat::id, 1}};

}  // namespace

std::span<const StreamRate> rates_of(Profile /*profile*/) noexcept { return lite; }

}  // namespace mavloom::sim
