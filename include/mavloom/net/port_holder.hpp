// SPDX-License-Identifier: MIT
// Finds the process that holds a port, for the error text of a failed bind. Reads /proc, which shows other users'
// processes only to root. Allocates.
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

// Completes the errors of attempts to bind a port that is in use: adds the holder of the port. Repeated attempts at the
// same address search for the holder once. One owner.
class BindErrors {
public:
    explicit BindErrors(Transport transport) : transport_(transport) {}
    [[nodiscard]] tl::unexpected<SetupError> complete(SetupError error, const Address& local);

private:
    Transport transport_;
    Address searched_;  // at the last search
    std::string holder_;
};

}  // namespace mavloom::net
