// SPDX-License-Identifier: MIT
// Finds out whether a UDP port is closed: it sends an empty datagram, which no program takes for MAVLink, and the host
// reports a closed port by ICMP. One owner thread.
#pragma once

#include <optional>

#include "mavloom/endpoint/endpoint.hpp"
#include "mavloom/net/udp.hpp"

namespace mavloom::app {

class PortProbe {
public:
    // Does nothing if the endpoint calls no numeric UDP address.
    explicit PortProbe(const endpoint::Endpoint& endpoint);
    // Whether the host has reported a closed port so far.
    [[nodiscard]] bool is_refused();

private:
    std::optional<net::UdpSocket> socket_;
    bool is_refused_ = false;
};

}  // namespace mavloom::app
