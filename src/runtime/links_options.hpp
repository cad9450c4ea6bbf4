// SPDX-License-Identifier: MIT
// What Links checks in an endpoint before it opens it. Private to module runtime.
#pragma once

#include <optional>

#include "mavloom/net/address.hpp"
#include "mavloom/runtime/links.hpp"

namespace mavloom::runtime::detail {

// An error for a scheme or an option that these links do not honour, so that none is silently ignored.
[[nodiscard]] SetupResult<void> check_supported(const Endpoint& endpoint, RoutingOptions routing);
// An error for what nobody can send to: 0.0.0.0, port 0, a group or a broadcast address; the text says what to type.
[[nodiscard]] SetupResult<void> check_destination(const Endpoint& endpoint);
// Both, and a bind= that does not go with the destination: what can be said of an endpoint before it is opened.
[[nodiscard]] SetupResult<void> check_link(const Endpoint& endpoint, RoutingOptions routing);
// bind=HOST:PORT as an address; nothing where it is not set.
[[nodiscard]] SetupResult<std::optional<net::Address>> local_address(const Endpoint& endpoint);

}  // namespace mavloom::runtime::detail
