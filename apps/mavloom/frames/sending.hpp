// SPDX-License-Identifier: MIT
// The output side of relay, replay and record: opens the destinations of --to and --output, and reports how many frames
// each of them received.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "command.hpp"
#include "mavloom/feed/destinations.hpp"

namespace mavloom::app {

using Json = nlohmann::ordered_json;

// Creates the recording of a tlog:// destination. If the file exists, renames it and logs its new name. Error texts
// begin with `option`.
[[nodiscard]] SetupResult<record::RotatingWriter> create_recording(const Common& common,
                                                                   const endpoint::Endpoint& endpoint,
                                                                   std::string_view option);
// Opens the endpoints of --to; `links` must outlive the result. Logs the ports that the system chose.
[[nodiscard]] SetupResult<feed::Destinations> open_destinations(const Common& common,
                                                                std::span<const endpoint::Endpoint> to,
                                                                link::Links& links);

// Logs "udpout://…: 40087 frames, 1834899 bytes sent" for each destination, then how many frames were lost and why.
void log_sums(const Common& common, const feed::Destinations& destinations);
// Returns the same totals as a JSON array. docs/guide/relay.md lists the keys.
[[nodiscard]] Json sums_json(const feed::Destinations& destinations);

// Logs the totals of a recording: "x.tlog: 12 frames, 348 bytes written".
void log_recorded(const Common& common, const record::RotatingWriter& file);
[[nodiscard]] Json recorded_json(const record::RotatingWriter& file);

}  // namespace mavloom::app
