// SPDX-License-Identifier: MIT
#include "mavloom/net/neighbours.hpp"

#include <linux/neighbour.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <optional>

namespace mavloom::net {

static constexpr std::size_t buffer_bytes = 16384;  // the kernel writes less at once
static constexpr int queue_bytes = 4 << 20;         // for some thousand announcements
static constexpr int reads_at_once = 256;
// NUD_VALID of the kernel.
static constexpr int valid = NUD_PERMANENT | NUD_NOARP | NUD_REACHABLE | NUD_PROBE | NUD_STALE | NUD_DELAY;

SetupResult<NeighbourWatch> NeighbourWatch::open() {
    NeighbourWatch watch;
    watch.fd_ = Fd(::socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE));
    sockaddr_nl local{};
    local.nl_family = AF_NETLINK;
    local.nl_groups = RTMGRP_NEIGH;
    if (!watch.fd_ || ::bind(watch.fd(), reinterpret_cast<const sockaddr*>(&local), sizeof local) != 0)
        return system_error("cannot watch the table of neighbours", errno);
    if (::setsockopt(watch.fd(), SOL_SOCKET, SO_RCVBUFFORCE, &queue_bytes, sizeof queue_bytes) != 0)
        ::setsockopt(watch.fd(), SOL_SOCKET, SO_RCVBUF, &queue_bytes, sizeof queue_bytes);
    watch.buffer_.resize(buffer_bytes);
    return watch;
}

std::span<const NeighbourWatch::Change> NeighbourWatch::read() {
    changes_.clear();
    for (int i = 0; i < reads_at_once; ++i) {
        sockaddr_nl from{};
        socklen_t length = sizeof from;
        const ssize_t size = ::recvfrom(fd(), buffer_.data(), buffer_.size(), 0, reinterpret_cast<sockaddr*>(&from),
                                        &length);
        if (size < 0) break;
        const bool is_of_kernel = from.nl_pid == 0;
        if (is_of_kernel) parse(ByteView(buffer_).first(static_cast<std::size_t>(size)), changes_);
    }
    return changes_;
}

namespace {

template <class T>
std::optional<T> begin_of(ByteView bytes) noexcept {
    T value;
    if (bytes.size() < sizeof value) return std::nullopt;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
}

// Skips a part of this length, and the padding to the next multiple of 4 bytes.
ByteView behind(ByteView bytes, std::size_t length) noexcept {
    return bytes.subspan(std::min(bytes.size(), NLMSG_ALIGN(length)));
}

std::optional<Address> address_of(const ndmsg& about, ByteView bytes) noexcept {
    sockaddr_in v4{};
    sockaddr_in6 v6{};
    if (about.ndm_family == AF_INET && bytes.size() == sizeof v4.sin_addr) {
        v4.sin_family = AF_INET;
        std::memcpy(&v4.sin_addr, bytes.data(), bytes.size());
        return Address::from_sockaddr(reinterpret_cast<const sockaddr*>(&v4), sizeof v4);
    }
    if (about.ndm_family != AF_INET6 || bytes.size() != sizeof v6.sin6_addr) return std::nullopt;
    v6.sin6_family = AF_INET6;
    std::memcpy(&v6.sin6_addr, bytes.data(), bytes.size());
    if (IN6_IS_ADDR_LINKLOCAL(&v6.sin6_addr)) v6.sin6_scope_id = static_cast<std::uint32_t>(about.ndm_ifindex);
    return Address::from_sockaddr(reinterpret_cast<const sockaddr*>(&v6), sizeof v6);
}

// Returns the payload of the first attribute of this type, or an empty view.
ByteView attribute_of(ByteView attributes, std::uint16_t type) noexcept {
    while (const auto header = begin_of<rtattr>(attributes)) {
        if (header->rta_len < sizeof(rtattr) || header->rta_len > attributes.size()) break;
        if (header->rta_type == type) return attributes.first(header->rta_len).subspan(sizeof(rtattr));
        attributes = behind(attributes, header->rta_len);
    }
    return {};
}

std::optional<NeighbourWatch::Change> change_of(ByteView body) noexcept {
    const auto about = begin_of<ndmsg>(body);
    if (!about || (about->ndm_state & (valid | NUD_FAILED)) == 0) return std::nullopt;
    const auto host = address_of(*about, attribute_of(behind(body, sizeof(ndmsg)), NDA_DST));
    if (!host) return std::nullopt;
    return NeighbourWatch::Change{*host, static_cast<std::uint32_t>(about->ndm_ifindex),
                                  (about->ndm_state & valid) != 0};
}

// Views the bytes of the IP address, in network order.
ByteView bytes_of(const Address& address) noexcept {
    const auto* const v4 = &reinterpret_cast<const sockaddr_in*>(address.data())->sin_addr;
    const auto* const v6 = &reinterpret_cast<const sockaddr_in6*>(address.data())->sin6_addr;
    return address.is_v4() ? ByteView(reinterpret_cast<const std::uint8_t*>(v4), sizeof *v4)
                           : ByteView(reinterpret_cast<const std::uint8_t*>(v6), sizeof *v6);
}

// Asks for the route to a host: an nlmsghdr, an rtmsg and attributes.
class RouteRequest {
public:
    RouteRequest(const Address& host, const Address& from, std::uint32_t bound) noexcept {
        about_.rtm_family = static_cast<std::uint8_t>(host.family());
        about_.rtm_dst_len = append(RTA_DST, bytes_of(host));
        if (!from.is_any() && from.family() == host.family()) about_.rtm_src_len = append(RTA_SRC, bytes_of(from));
        if (bound != 0) append(RTA_OIF, ByteView(reinterpret_cast<const std::uint8_t*>(&bound), sizeof bound));
        header_.nlmsg_type = RTM_GETROUTE;
        header_.nlmsg_flags = NLM_F_REQUEST;
        header_.nlmsg_len = static_cast<std::uint32_t>(offsetof(RouteRequest, attributes_) + size_);
    }
    [[nodiscard]] ByteView bytes() const noexcept {
        return {reinterpret_cast<const std::uint8_t*>(this), header_.nlmsg_len};
    }

private:
    // Returns the length of the payload in bits.
    std::uint8_t append(std::uint16_t type, ByteView payload) noexcept {
        const rtattr header{static_cast<std::uint16_t>(sizeof header + payload.size()), type};
        std::memcpy(attributes_.data() + size_, &header, sizeof header);
        std::memcpy(attributes_.data() + size_ + sizeof header, payload.data(), payload.size());
        size_ += header.rta_len;  // a multiple of 4: no padding
        return static_cast<std::uint8_t>(8 * payload.size());
    }

    nlmsghdr header_{};
    rtmsg about_{};
    std::array<std::uint8_t, 3 * (sizeof(rtattr) + 16)> attributes_{};
    std::size_t size_ = 0;
};

std::uint32_t interface_of_route(ByteView datagram) noexcept {
    const auto header = begin_of<nlmsghdr>(datagram);
    if (!header || header->nlmsg_type != RTM_NEWROUTE) return 0;
    const ByteView attributes = behind(datagram, sizeof(nlmsghdr) + sizeof(rtmsg));
    return begin_of<std::uint32_t>(attribute_of(attributes, RTA_OIF)).value_or(0);
}

}  // namespace

void NeighbourWatch::parse(ByteView datagram, std::vector<Change>& changes) {
    while (const auto header = begin_of<nlmsghdr>(datagram)) {
        if (header->nlmsg_len < sizeof(nlmsghdr) || header->nlmsg_len > datagram.size()) break;
        if (header->nlmsg_type == RTM_NEWNEIGH) {
            const auto change = change_of(datagram.first(header->nlmsg_len).subspan(sizeof(nlmsghdr)));
            if (change) changes.push_back(*change);
        }
        datagram = behind(datagram, header->nlmsg_len);
    }
}

static std::uint32_t ask(const RouteRequest& request) noexcept {
    const Fd fd(::socket(AF_NETLINK, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, NETLINK_ROUTE));
    if (!fd || ::send(fd.get(), request.bytes().data(), request.bytes().size(), 0) < 0) return 0;
    std::array<std::uint8_t, 4096> answer{};  // the kernel has answered when send returns
    const ssize_t size = ::recv(fd.get(), answer.data(), answer.size(), 0);
    return size <= 0 ? 0 : interface_of_route(ByteView(answer).first(static_cast<std::size_t>(size)));
}

std::uint32_t interface_to(const Address& host, const Address& from, std::uint32_t bound) noexcept {
    if (host.scope() != 0) return host.scope();
    const Address to = host.unmapped();
    // By IPv6, the answer for a source need not be the interface to which it is bound.
    if (bound != 0) return ask({to, Address(), bound});
    const std::uint32_t by_source = ask({to, from.unmapped(), 0});
    // A socket may be bound to a broadcast address. The kernel then sends from another one, so it knows no such route.
    return by_source != 0 ? by_source : ask({to, Address(), 0});
}

// While the kernel looks for the host, the datagram takes room only in the send buffer of this socket.
void look_for(const Address& host, std::uint32_t interface) noexcept {
    static constexpr std::uint16_t discard = 9;
    const Address to = host.unmapped().with_port(discard);
    const Fd fd(::socket(to.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    ::setsockopt(fd.get(), SOL_SOCKET, SO_BINDTOIFINDEX, &interface, sizeof interface);
    ::sendto(fd.get(), nullptr, 0, 0, to.data(), to.size());
}

}  // namespace mavloom::net
