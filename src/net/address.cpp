// SPDX-License-Identifier: MIT
#include "mavloom/net/address.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <net/if.h>

#include <charconv>

namespace mavloom::net {

std::uint32_t index_of_zone(const std::string& zone) {
    if (const std::uint32_t index = if_nametoindex(zone.c_str()); index != 0) return index;
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(zone.data(), zone.data() + zone.size(), number);
    return error == std::errc{} && end == zone.data() + zone.size() ? number : 0;
}

std::optional<Address> Address::parse(std::string_view host, std::uint16_t port) {
    Address address;
    const auto percent = host.find('%');
    const std::string number(host.substr(0, percent));
    if (percent == std::string_view::npos && inet_pton(AF_INET, number.c_str(), &address.storage_.v4.sin_addr) == 1) {
        address.storage_.v4.sin_family = AF_INET;
        address.storage_.v4.sin_port = htons(port);
        return address;
    }
    if (inet_pton(AF_INET6, number.c_str(), &address.storage_.v6.sin6_addr) != 1) return std::nullopt;
    address.storage_.v6.sin6_family = AF_INET6;
    address.storage_.v6.sin6_port = htons(port);
    if (percent != std::string_view::npos) {
        address.storage_.v6.sin6_scope_id = index_of_zone(std::string(host.substr(percent + 1)));
        if (address.storage_.v6.sin6_scope_id == 0) return std::nullopt;
    }
    return address;
}

std::optional<Address> Address::from_sockaddr(const sockaddr* from, socklen_t length) noexcept {
    Address address;
    if (from == nullptr || length < sizeof(sa_family_t)) return std::nullopt;
    const std::size_t need = from->sa_family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
    if ((from->sa_family != AF_INET && from->sa_family != AF_INET6) || length < need) return std::nullopt;
    std::memcpy(&address.storage_, from, need);
    if (address.is_v4()) std::memset(address.storage_.v4.sin_zero, 0, sizeof address.storage_.v4.sin_zero);
    address.normalize();
    return address;
}

std::uint16_t Address::port() const noexcept {
    static_assert(offsetof(sockaddr_in, sin_port) == offsetof(sockaddr_in6, sin6_port));
    return ntohs(storage_.v4.sin_port);
}

Address Address::with_port(std::uint16_t port) const noexcept {
    Address copy = *this;
    copy.storage_.v4.sin_port = htons(port);
    return copy;
}

Address Address::with_scope(std::uint32_t interface) const noexcept {
    Address copy = *this;
    if (is_v6()) copy.storage_.v6.sin6_scope_id = interface;
    return copy;
}

bool Address::is_any() const noexcept {
    if (is_v4()) return storage_.v4.sin_addr.s_addr == INADDR_ANY;
    return is_v6() && IN6_IS_ADDR_UNSPECIFIED(&storage_.v6.sin6_addr);
}

bool Address::is_loopback() const noexcept {
    if (is_v4()) return (ntohl(storage_.v4.sin_addr.s_addr) >> 24) == 127;
    const in6_addr& v6 = storage_.v6.sin6_addr;
    return is_v6() && (IN6_IS_ADDR_LOOPBACK(&v6) || (IN6_IS_ADDR_V4MAPPED(&v6) && v6.s6_addr[12] == 127));
}

Address Address::unmapped() const noexcept {
    if (!is_v6() || !IN6_IS_ADDR_V4MAPPED(&storage_.v6.sin6_addr)) return *this;
    Address v4;
    v4.storage_.v4.sin_family = AF_INET;
    v4.storage_.v4.sin_port = storage_.v6.sin6_port;
    std::memcpy(&v4.storage_.v4.sin_addr, &storage_.v6.sin6_addr.s6_addr[12], sizeof v4.storage_.v4.sin_addr);
    return v4;
}

Address Address::host_part() const noexcept {
    Address part = unmapped().with_port(0);
    if (part.is_v6() && !IN6_IS_ADDR_LINKLOCAL(&part.storage_.v6.sin6_addr))
        std::memset(&part.storage_.v6.sin6_addr.s6_addr[8], 0, 8);
    return part;
}

bool Address::is_multicast() const noexcept {
    if (is_v4()) return (ntohl(storage_.v4.sin_addr.s_addr) >> 28) == 0xe;
    return is_v6() && IN6_IS_ADDR_MULTICAST(&storage_.v6.sin6_addr);
}

bool Address::is_broadcast() const noexcept { return is_v4() && storage_.v4.sin_addr.s_addr == INADDR_BROADCAST; }

std::string Address::host_text() const {
    char text[INET6_ADDRSTRLEN] = "";
    if (is_v4()) {
        inet_ntop(AF_INET, &storage_.v4.sin_addr, text, sizeof text);
    } else if (is_v6() && IN6_IS_ADDR_V4MAPPED(&storage_.v6.sin6_addr)) {
        inet_ntop(AF_INET, &storage_.v6.sin6_addr.s6_addr[12], text, sizeof text);
    } else if (is_v6()) {
        inet_ntop(AF_INET6, &storage_.v6.sin6_addr, text, sizeof text);
        if (storage_.v6.sin6_scope_id != 0) return fmt::format("{}%{}", text, storage_.v6.sin6_scope_id);
    }
    return text;
}

std::string Address::text() const {
    const std::string host = host_text();
    return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port())
                                               : fmt::format("[{}]:{}", host, port());
}

}  // namespace mavloom::net
