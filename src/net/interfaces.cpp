// SPDX-License-Identifier: MIT
#include "mavloom/net/interfaces.hpp"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "mavloom/net/fd.hpp"

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
    // An interface without a broadcast address, as after `ip addr add` without `brd`, reports its own address as one.
    std::erase_if(broadcasts, [&](const Address& a) { return std::ranges::find(own, a) != own.end(); });
}

// The address from which packets to other networks leave. A datagram socket that is connected sends nothing.
static std::optional<Address> address_of_default_route() {
    const auto far = Address::parse("192.0.2.1", 9);  // of no machine: RFC 5737
    const Fd socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (!socket || ::connect(socket.get(), far->data(), far->size()) != 0) return std::nullopt;
    Address own;
    socklen_t length = Address::capacity;
    if (::getsockname(socket.get(), own.writable(), &length) != 0) return std::nullopt;
    own.normalize();
    return own.with_port(0);
}

static bool is_link_local(const Address& address) {
    return address.scope() != 0 || address.host_text().starts_with("169.254.");
}

std::optional<Address> address_on_network() {
    if (auto address = address_of_default_route(); address && !address->is_loopback()) return address;
    std::vector<Address> own, broadcasts;
    read_addresses(own, broadcasts);
    std::erase_if(own, [](const Address& a) { return a.is_loopback() || is_link_local(a); });
    std::stable_partition(own.begin(), own.end(), [](const Address& a) { return a.is_v4(); });
    return own.empty() ? std::nullopt : std::optional(own.front());
}

bool OwnAddresses::find(const std::vector<Address>& in, const Address& address, MonoTime now) {
    const Address host = address.with_port(0);
    if (read_at_ == MonoTime{} || now - read_at_ >= refresh_interval) {
        read_addresses(known_, broadcasts_);
        read_at_ = now;
    }
    return std::find(in.begin(), in.end(), host) != in.end();
}

bool OwnAddresses::contains(const Address& address, MonoTime now) { return find(known_, address, now); }

bool OwnAddresses::has_broadcast(const Address& address, MonoTime now) {
    return address.is_broadcast() || find(broadcasts_, address, now);
}

}  // namespace mavloom::net
