// SPDX-License-Identifier: MIT
// The routes of routers, as their control sockets report them. Pure.
#pragma once

#include <span>
#include <vector>

#include "mavloom/view/snapshot.hpp"
#include "mavloom/web/server.hpp"

namespace mavloom::app {

// By router, then by sender.
[[nodiscard]] std::vector<view::Route> routes_to_show(std::span<const web::RoutesOf> routers);

}  // namespace mavloom::app
