// SPDX-License-Identifier: MIT
// The end of `listen --stats` and of other commands that received: what was heard, by link, source and message, and what was lost where.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "command.hpp"
#include "mavloom/feed/receiver.hpp"
#include "mavloom/observe/traffic_table.hpp"

namespace mavloom::app {

using Json = nlohmann::ordered_json;

// Every loss by its name, 0 included.
[[nodiscard]] Json losses_json(const feed::Totals& totals);
// {"stats":...} and a newline: how a command's summary stands on stdout.
[[nodiscard]] std::string stats_line(Json stats);

// A table for people. `receiver` has been joined.
std::string traffic_text(const observe::TrafficTable& traffic, feed::Receiver& receiver,
                         const dialect::Dialect& dialect);
// One JSON object, {"stats":{…}} and a newline; its keys are documented in docs/guide/listen.md. `unprinted`: messages that were received and
// not printed, since nobody took them.
std::string traffic_json(const observe::TrafficTable& traffic, feed::Receiver& receiver,
                         const dialect::Dialect& dialect, std::uint64_t unprinted);
// Lines on stderr for whatever was lost or damaged; nothing when all is well.
void say_losses(const Common& common, const feed::Totals& totals);

}  // namespace mavloom::app
