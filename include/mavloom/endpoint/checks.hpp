// SPDX-License-Identifier: MIT
// What can be said against an endpoint before it is opened. Pure functions, safe from any thread; errors are `usage` and name the endpoint.
#pragma once

#include <cstdint>
#include <optional>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::endpoint {

// Filters, groups, rates, tap= and private= of an endpoint: an error, or applied by the owner of the links (Router). The owner then also says
// which frames count for the link's loss: not the echoes, which only it knows.
enum class RoutingOptions : std::uint8_t { refused, by_owner };

// An error for a scheme or an option that live links do not honour, so that none is silently ignored.
[[nodiscard]] SetupResult<void> check_supported(const Endpoint& endpoint, RoutingOptions routing);
// An error for what nobody can send to: 0.0.0.0, port 0, a group or a broadcast address; the text says what to type.
[[nodiscard]] SetupResult<void> check_destination(const Endpoint& endpoint);
// Both, and a bind= that does not go with the destination: what can be said of an endpoint before it is opened.
[[nodiscard]] SetupResult<void> check_link(const Endpoint& endpoint, RoutingOptions routing);
// bind=HOST:PORT as an address; nothing where it is not set.
[[nodiscard]] SetupResult<std::optional<net::Address>> local_address(const Endpoint& endpoint);

// An error for options of a recording that is read, where a router writes it.
[[nodiscard]] SetupResult<void> check_written(const Endpoint& recording);

}  // namespace mavloom::endpoint
