// SPDX-License-Identifier: MIT
// Checks an endpoint before it is opened. Pure functions, safe from any thread. Errors are `usage` and name the
// endpoint.
#pragma once

#include <cstdint>
#include <optional>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::endpoint {

// How to treat an endpoint's routing options: filters, groups, rates, tap=, private= and heartbeat=. With `refused`,
// they are an error. With `by_owner`, the owner of the links (the router) applies them. That owner then also decides
// which frames count towards a link's loss, because only the owner recognises echoes.
enum class RoutingOptions : std::uint8_t { refused, by_owner };

// Refuses a scheme or option that live links do not support, so that none is silently ignored.
[[nodiscard]] SetupResult<void> check_supported(const Endpoint& endpoint, RoutingOptions routing);
// Refuses an address that cannot be a destination: 0.0.0.0, port 0, a multicast group, or a broadcast address outside
// udpbcast. The error text suggests what to type.
[[nodiscard]] SetupResult<void> check_destination(const Endpoint& endpoint);
// Runs both checks above, as far as they apply to the scheme. Also refuses a bind= whose address family differs from
// the destination's.
[[nodiscard]] SetupResult<void> check_link(const Endpoint& endpoint, RoutingOptions routing);
// bind=HOST:PORT as an address; empty if bind= is not set.
[[nodiscard]] SetupResult<std::optional<net::Address>> local_address(const Endpoint& endpoint);

// Returns true if frames sent to `to` would arrive at `source`: at a ring, or at an endpoint that listens on `port` of
// this machine. Looks up no names.
[[nodiscard]] bool leads_back(const Endpoint& source, std::uint16_t port, const Endpoint& to);
// Refuses two endpoints of one router if one of them calls the port of the other. Broadcasts are allowed: other
// machines hear them too.
[[nodiscard]] SetupResult<void> check_not_called(const Endpoint& a, const Endpoint& b);

// Refuses the name of a log that flight controllers write to their own storage (ULog, DataFlash) where an endpoint is
// expected. The error names the programs that read it. A command that opens any file looks at the file's first bytes.
[[nodiscard]] SetupResult<void> check_recording_name(std::string_view path);
// Refuses the option `speed` for a recording that is to be written. Only recordings that are read have it.
[[nodiscard]] SetupResult<void> check_written(const Endpoint& recording);

}  // namespace mavloom::endpoint
