// SPDX-License-Identifier: MIT
// What a router says of itself: JSON objects, one a line, for `mavloom ctl` and `stat`, and Prometheus' text form. Keys are documented in
// docs/guide/route.md.
//
// Called on the router's thread, between two turns, where it copies counters and nothing more (a few milliseconds for the largest tables). What
// it returns makes the text, which takes a hundred times as long, on any one thread while the router's dialect is there. Allocates.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mavloom/router/router.hpp"

namespace mavloom::router {

using control::Later;
using control::Lines;

// {"kind":"link",...} for each link that is there.
[[nodiscard]] Later<Lines> report_links(Router& router);
// {"kind":"route",...} for each system and component, and the link that it was heard on.
[[nodiscard]] Later<Lines> report_routes(Router& router);
// All there is: one "router" line, then "endpoint", "gone", "link", "source", "message", "recording" and "unknown_target" lines.
[[nodiscard]] Later<Lines> report_stats(Router& router);
// Prometheus' text exposition format, version 0.0.4.
[[nodiscard]] Later<std::string> report_metrics(Router& router);

// An endpoint as a router takes it: port 0 is refused, because a router's port is known to others.
[[nodiscard]] SetupResult<endpoint::Endpoint> parse_router_endpoint(std::string_view text);

// Router::answer: what one request line asks for ({"cmd":"links"}, {"cmd":"add","url":"udpout://…"}, {"cmd":"remove","name":"…"}) and gives the answer's
// lines, the last of which is {"ok":true} or {"ok":false,"error":"…"}.
[[nodiscard]] Later<Lines> answer_request(Router& router, std::string_view request);

}  // namespace mavloom::router
