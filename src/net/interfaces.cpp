// SPDX-License-Identifier: MIT
#include "mavloom/net/interfaces.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <cerrno>

namespace mavloom::net {

static std::string all_names() {
    std::string names;
    struct if_nameindex* const all = if_nameindex();
    if (all == nullptr) return names;
    for (const auto* it = all; it->if_index != 0; ++it)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", it->if_name);
    if_freenameindex(all);
    return names;
}

SetupResult<std::uint32_t> interface_index(const std::string& name) {
    const std::uint32_t index = if_nametoindex(name.c_str());
    if (index != 0) return index;
    return setup_error(SetupCode::not_found, fmt::format("there is no interface '{}'; there are {}", name, all_names()));
}

static std::vector<Address> read_addresses() {
    std::vector<Address> found;
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return found;
    for (const ifaddrs* it = list; it != nullptr; it = it->ifa_next) {
        if (it->ifa_addr == nullptr) continue;
        if (const auto address = Address::from_sockaddr(it->ifa_addr, Address::capacity))
            found.push_back(address->with_port(0));
    }
    freeifaddrs(list);
    return found;
}

bool OwnAddresses::contains(const Address& address, MonoTime now) {
    const Address host = address.with_port(0);
    const auto is_known = [&] { return std::find(known_.begin(), known_.end(), host) != known_.end(); };
    if (is_known()) return true;
    if (read_at_ != MonoTime{} && now - read_at_ < refresh_interval) return false;
    known_ = read_addresses();
    read_at_ = now;
    return is_known();
}

}  // namespace mavloom::net
