// SPDX-License-Identifier: MIT
// The network interfaces of this machine by name, and the addresses that are its own: what a socket hears from them is what it sent itself.
// One thread at a time; allocates when the list of addresses is read, at most once a second.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"

namespace mavloom::net {

// `not_found` names those that there are.
[[nodiscard]] SetupResult<std::uint32_t> interface_index(const std::string& name);

class OwnAddresses {
public:
    // Whether the address, its port aside, is one of this machine's.
    [[nodiscard]] bool contains(const Address& address, MonoTime now);

private:
    // Addresses come and go (DHCP); a stranger's must not cost a look at the list each time.
    static constexpr std::chrono::seconds refresh_interval{1};

    std::vector<Address> known_;  // port 0
    MonoTime read_at_{};
};

}  // namespace mavloom::net
