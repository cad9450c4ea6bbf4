// SPDX-License-Identifier: MIT
// Reports of a simulator: JSON, one object per line, for `mavloom ctl` and `mavloom sim --json`; text for people;
// metrics. docs/guide/sim.md documents the keys.
//
// Call the functions that return a Report on the simulator's thread. They only copy data, apart from `answer_request`,
// which executes the request. Report::next_text makes the text, on any thread. All of them allocate.
#pragma once

#include <string>
#include <vector>

#include "mavloom/simserve/simulator.hpp"

namespace mavloom::simserve {

using control::Report;

// All but the metrics end with the line {"ok":true}.

// One {"kind":"vehicle",...} line for each of the vehicles.
[[nodiscard]] Report report_state(const std::vector<sim::Vehicle*>& vehicles);
// One "clock" line.
[[nodiscard]] Report report_clock(Simulator& simulator);
// One "link" line for each current link.
[[nodiscard]] Report report_links(Simulator& simulator);
// One "stream" line for each stream of each link.
[[nodiscard]] Report report_streams(Simulator& simulator);
// One "sim" line, then "endpoint", "gone", "link", "source" and "vehicle" lines.
[[nodiscard]] Report report_stats(Simulator& simulator);
// Prometheus' text exposition format, version 0.0.4.
[[nodiscard]] Report report_metrics(Simulator& simulator);

// The report at the end of a run, as JSON: a "stream" line for each stream, then a "link_total" line for each link.
[[nodiscard]] std::string json_of(const std::vector<LinkReport>& reports, double speed);
// The same report as a table for people.
[[nodiscard]] std::string text_of(const std::vector<LinkReport>& reports, double speed);

// Implements Simulator::answer. Executes one request line, for example {"cmd":"arm","system":1}. Returns the lines of
// the answer; the last is {"ok":true} or {"ok":false,"error":"..."}.
[[nodiscard]] Report answer_request(Simulator& simulator, std::string_view request);

}  // namespace mavloom::simserve
