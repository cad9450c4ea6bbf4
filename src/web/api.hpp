// SPDX-License-Identifier: MIT
// The JSON of /api/v1. Private to module web. `mutex` guards the channels. It is held while some are copied, never
// while they are formatted.
#pragma once

#include <mutex>
#include <span>
#include <string>

#include "mavloom/base/clock.hpp"
#include "mavloom/dialect/dialect.hpp"
#include "mavloom/observe/vehicle_table.hpp"
#include "mavloom/web/server.hpp"
#include "web/channels.hpp"

namespace mavloom::web {

// One object for each component that sent a HEARTBEAT.
[[nodiscard]] std::string systems_json(std::span<const observe::Vehicle> vehicles, const dialect::Dialect& dialect);
// One object for each channel, with the fields of its latest message.
[[nodiscard]] std::string messages_json(const Channels& channels, std::mutex& mutex, WallTime now);
// One object for each router.
[[nodiscard]] std::string routes_json(std::span<const RoutesOf> routers);

}  // namespace mavloom::web
