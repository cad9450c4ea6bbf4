// SPDX-License-Identifier: MIT
// Status reports of a router: JSON, one object a line, for `mavloom ctl` and `mavloom stat`, and Prometheus text.
// docs/guide/route.md documents the keys.
//
// Call these functions on the router's thread, between two turns. They only copy counters, which takes a few
// milliseconds for the largest tables. The function that they return makes the text, which takes about a hundred times
// as long. Call it on any one thread, as long as the router's dialect exists. Both steps allocate.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mavloom/router/router.hpp"

namespace mavloom::router {

using control::Later;
using control::Lines;

// One {"kind":"link",...} line for each current link.
[[nodiscard]] Later<Lines> report_links(Router& router);
// One {"kind":"route",...} line for each system and component on each link where it was heard.
[[nodiscard]] Later<Lines> report_routes(Router& router);
// All statistics: one "router" line, then "endpoint", "gone", "link", "source", "message", "recording" and
// "unknown_target" lines.
[[nodiscard]] Later<Lines> report_stats(Router& router);
// Prometheus' text exposition format, version 0.0.4.
[[nodiscard]] Later<std::string> report_metrics(Router& router);

// Parses an endpoint for a router. Rejects port 0 with `usage`, because other programs must know a router's port.
[[nodiscard]] SetupResult<endpoint::Endpoint> parse_router_endpoint(std::string_view text);

// Implements Router::answer. Executes one request line, for example {"cmd":"links"}, {"cmd":"add","url":"udpout://…"}
// or {"cmd":"remove","name":"…"}. Returns the lines of the answer; the last is {"ok":true} or {"ok":false,"error":"…"}.
[[nodiscard]] Later<Lines> answer_request(Router& router, std::string_view request);

}  // namespace mavloom::router
