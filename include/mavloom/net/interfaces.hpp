// SPDX-License-Identifier: MIT
// Looks up network interfaces by name, and checks whether an address belongs to this machine or is a broadcast
// address of its networks.
//
// A multicast or broadcast socket uses the check to recognise its own datagrams. One thread at a time. OwnAddresses
// allocates when it reads the list of addresses, at most once a second.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::net {

// Returns the index of the interface `name`, which may also be its number. `not_found` lists the interfaces that exist.
[[nodiscard]] SetupResult<std::uint32_t> interface_index(const std::string& name);

// An address at which other machines reach this one: that of the interface of the default route, else of any network,
// IPv4 first. Empty if there is none. Sends nothing.
[[nodiscard]] std::optional<Address> address_on_network();

class OwnAddresses {
public:
    // Returns whether `address` is one of this machine's. Ignores the port.
    [[nodiscard]] bool contains(const Address& address, MonoTime now);
    // Returns whether `address` is a broadcast address: that of one of this machine's networks, or 255.255.255.255.
    // Ignores the port.
    [[nodiscard]] bool has_broadcast(const Address& address, MonoTime now);

private:
    // Addresses change over time (DHCP), so the list is read again, but at most once per interval.
    static constexpr std::chrono::seconds refresh_interval{1};

    [[nodiscard]] bool find(const std::vector<Address>& in, const Address& address, MonoTime now);

    std::vector<Address> known_, broadcasts_;  // all with port 0
    MonoTime read_at_{};
};

}  // namespace mavloom::net
