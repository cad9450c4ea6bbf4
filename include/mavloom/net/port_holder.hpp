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

// "mavproxy.py (process 1234)" or "this process": who holds the port at this address, or at all addresses. Empty if no
// such process is visible. Takes milliseconds.
[[nodiscard]] std::string port_holder(Transport transport, const Address& local);

// The error of a bind() that failed with `err`, with the holder of the port if the port is in use. `what` begins its
// text.
[[nodiscard]] tl::unexpected<SetupError> bind_error(std::string_view what, int err, Transport transport,
                                                    const Address& local);

}  // namespace mavloom::net
