// SPDX-License-Identifier: MIT
// Reports what a command received and lost: by link, source and message (`listen --stats`), or as totals.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "command.hpp"
#include "mavloom/feed/receiver.hpp"
#include "mavloom/observe/hop.hpp"
#include "mavloom/observe/latest_table.hpp"

namespace mavloom::app {

using Json = nlohmann::ordered_json;

// Returns every loss counter by name, including those that are 0.
[[nodiscard]] Json losses_json(const feed::Totals& totals);
// Returns the counters of frames that are missing here, with a text for people.
[[nodiscard]] std::vector<observe::NamedCount> loss_counts(const feed::Totals& totals);
// Returns {"stats":...} and a newline, the form of a command's summary on stdout.
[[nodiscard]] std::string stats_line(Json stats);

// Returns a table for people. Join `receiver` first.
std::string traffic_text(const observe::LatestTable& traffic, feed::Receiver& receiver);
// Returns one JSON object, {"stats":{…}}, and a newline. docs/guide/listen.md lists the keys. `unprinted` is the number
// of messages that were received but not printed because the output stalled.
std::string traffic_json(const observe::LatestTable& traffic, feed::Receiver& receiver, std::uint64_t unprinted);
// Logs one line for each kind of loss or damage that occurred.
void log_losses(const Common& common, const feed::Totals& totals);

}  // namespace mavloom::app
