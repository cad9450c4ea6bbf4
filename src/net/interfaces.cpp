// SPDX-License-Identifier: MIT
#include "mavloom/net/interfaces.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>

#include <algorithm>
#include <array>
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
    std::array<char, IF_NAMESIZE> known{};
    const std::uint32_t index = index_of_zone(name);
    if (index != 0 && if_indextoname(index, known.data()) != nullptr) return index;
    return setup_error(SetupCode::not_found, fmt::format("there is no interface '{}'; there are {}", name, all_names()));
}

static void add_to(std::vector<Address>& list, const sockaddr* address) {
    if (address == nullptr) return;
    if (const auto found = Address::from_sockaddr(address, Address::capacity)) list.push_back(found->with_port(0));
}

static void read_addresses(std::vector<Address>& own, std::vector<Address>& broadcasts) {
    own.clear();
    broadcasts.clear();
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return;
    for (const ifaddrs* it = list; it != nullptr; it = it->ifa_next) {
        add_to(own, it->ifa_addr);
        if ((it->ifa_flags & IFF_BROADCAST) != 0) add_to(broadcasts, it->ifa_broadaddr);
    }
    freeifaddrs(list);
}

bool OwnAddresses::find(const std::vector<Address>& in, const Address& address, MonoTime now) {
    const Address host = address.with_port(0);
    const auto is_known = [&] { return std::find(in.begin(), in.end(), host) != in.end(); };
    if (is_known()) return true;
    if (read_at_ != MonoTime{} && now - read_at_ < refresh_interval) return false;
    read_addresses(known_, broadcasts_);
    read_at_ = now;
    return is_known();
}

bool OwnAddresses::contains(const Address& address, MonoTime now) { return find(known_, address, now); }

bool OwnAddresses::has_broadcast(const Address& address, MonoTime now) {
    return address.is_broadcast() || find(broadcasts_, address, now);
}

}  // namespace mavloom::net
