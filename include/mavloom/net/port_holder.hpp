// SPDX-License-Identifier: MIT
// Finds the process that holds a port, for the error text of a failed bind. Reads /proc, which shows other users'
// processes only to root. Stateless functions; they allocate.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::net {

enum class Transport : std::uint8_t { udp, tcp };

// "mavproxy.py (process 1234)" or "this process". Empty if no process is visible that holds the port.
[[nodiscard]] std::string port_holder(Transport transport, std::uint16_t port);

// The error of a bind() that failed with `err`, with the holder of the port if the port is in use. `what` begins its
// text.
[[nodiscard]] tl::unexpected<SetupError> bind_error(std::string_view what, int err, Transport transport,
                                                    std::uint16_t port);

}  // namespace mavloom::net
