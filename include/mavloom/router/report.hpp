// SPDX-License-Identifier: MIT
// Status reports of a router: JSON, one object per line, for `mavloom ctl` and `mavloom stat`, and Prometheus text.
// docs/guide/route.md documents the keys.
//
// Call these functions and Report::copy_more on the router's thread, between two turns. Each call copies at most one
// piece (docs/design/turn.md). Report::next_text makes the text, which takes about a hundred times as long. Reports may
// share the copied data, so call next_text of all reports on one thread, while the router's dialect exists. Both steps
// allocate.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mavloom/router/router.hpp"

namespace mavloom::router {

using control::Report;

// `report_links`, `report_routes` and `report_stats` end with the line {"ok":true}.

// One {"kind":"link",...} line for each current link.
[[nodiscard]] Report report_links(Router& router);
// One {"kind":"route",...} line for each system and component on each link where it was heard.
[[nodiscard]] Report report_routes(Router& router);
// All statistics: one "router" line, then "endpoint", "gone", "link", "source", "message", "recording" and
// "unknown_target" lines.
[[nodiscard]] Report report_stats(Router& router);
// Prometheus' text exposition format, version 0.0.4. Senders choose their ids and addresses, so the number of series is
// bounded: the busiest are listed, and the rest are summed under the label "other" (docs/guide/route.md).
[[nodiscard]] Report report_metrics(Router& router);

// Parses an endpoint for a router. Rejects port 0 with `usage`, because other programs must know a router's port.
[[nodiscard]] SetupResult<endpoint::Endpoint> parse_router_endpoint(std::string_view text);

// Implements Router::answer. Executes one request line, for example {"cmd":"links"}, {"cmd":"add","url":"udpout://…"}
// or {"cmd":"remove","name":"…"}. Returns the lines of the answer; the last is {"ok":true} or {"ok":false,"error":"…"}.
[[nodiscard]] Report answer_request(Router& router, std::string_view request);

}  // namespace mavloom::router
