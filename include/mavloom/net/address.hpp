// SPDX-License-Identifier: MIT
// An IPv4 or IPv6 socket address and port, stored as the kernel's own sockaddr.
//
// An address that recvmmsg wrote can be compared, hashed and passed to sendmmsg without conversion. This class does not
// look up host names; resolver.hpp does. An Address is a plain value: threads may read one at the same time. Only the
// functions that return text allocate.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "mavloom/base/secret_hash.hpp"

namespace mavloom::net {

// Returns the index of the interface of a zone, such as "eth0" or "2" (without "%"). Returns 0 if no interface has that
// name and it is no number; does not check that the number exists.
[[nodiscard]] std::uint32_t index_of_zone(const std::string& zone);

class Address {
public:
    Address() noexcept { std::memset(&storage_, 0, sizeof storage_); }

    // Parses "127.0.0.1", "::1" or "fe80::1%eth0", without brackets. Returns nothing for a host name.
    [[nodiscard]] static std::optional<Address> parse(std::string_view host, std::uint16_t port);
    // Returns nothing if the family is neither IPv4 nor IPv6, or if `length` is too short for the family.
    [[nodiscard]] static std::optional<Address> from_sockaddr(const sockaddr* address, socklen_t length) noexcept;

    [[nodiscard]] bool is_v4() const noexcept { return storage_.base.sa_family == AF_INET; }
    [[nodiscard]] bool is_v6() const noexcept { return storage_.base.sa_family == AF_INET6; }
    [[nodiscard]] int family() const noexcept { return storage_.base.sa_family; }
    [[nodiscard]] std::uint16_t port() const noexcept;
    [[nodiscard]] Address with_port(std::uint16_t port) const noexcept;
    // Interface index of a link-local IPv6 address (the "%eth0" part). 0 means none; always 0 for IPv4.
    [[nodiscard]] std::uint32_t scope() const noexcept { return is_v6() ? storage_.v6.sin6_scope_id : 0; }
    [[nodiscard]] Address with_scope(std::uint32_t interface) const noexcept;
    // Returns 1.2.3.4 for ::ffff:1.2.3.4, the IPv4 peer of a dual-stack socket. Returns other addresses unchanged.
    [[nodiscard]] Address unmapped() const noexcept;
    // Returns the part that identifies a host, with port 0: an IPv4 address, the first 64 bits of an IPv6 address, or a
    // whole link-local address.
    [[nodiscard]] Address host_part() const noexcept;

    [[nodiscard]] bool is_any() const noexcept;        // 0.0.0.0 or ::
    [[nodiscard]] bool is_loopback() const noexcept;   // 127.0.0.0/8, also as ::ffff:127.0.0.1, or ::1
    [[nodiscard]] bool is_multicast() const noexcept;  // 224.0.0.0/4 or ff00::/8
    [[nodiscard]] bool is_broadcast() const noexcept;  // 255.255.255.255

    // Returns "127.0.0.1:14550" or "[::1]:14550". The IPv4 peer of a dual-stack socket (::ffff:1.2.3.4) is shown as
    // IPv4.
    [[nodiscard]] std::string text() const;
    [[nodiscard]] std::string host_text() const;

    [[nodiscard]] const sockaddr* data() const noexcept { return &storage_.base; }
    [[nodiscard]] socklen_t size() const noexcept { return is_v6() ? sizeof(sockaddr_in6) : sizeof(sockaddr_in); }

    // Storage for system calls that write an address. Call `normalize` afterwards, so that equal addresses have equal
    // bytes.
    [[nodiscard]] sockaddr* writable() noexcept { return &storage_.base; }
    static constexpr socklen_t capacity = sizeof(sockaddr_in6);
    void normalize() noexcept {
        if (is_v6()) storage_.v6.sin6_flowinfo = 0;
    }

    [[nodiscard]] std::size_t hash() const noexcept {
        const std::uint64_t h = secret_hash(word(0));
        return static_cast<std::size_t>(is_v6() ? secret_hash(secret_hash(h, word(8)), word(16)) : h);
    }
    friend bool operator==(const Address& a, const Address& b) noexcept {
        if (a.word(0) != b.word(0)) return false;  // family, port and the IPv4 address
        return !a.is_v6() || (a.word(8) == b.word(8) && a.word(16) == b.word(16) &&
                              a.storage_.v6.sin6_scope_id == b.storage_.v6.sin6_scope_id);
    }

private:
    [[nodiscard]] std::uint64_t word(std::size_t offset) const noexcept {
        std::uint64_t w;
        std::memcpy(&w, reinterpret_cast<const char*>(&storage_) + offset, sizeof w);
        return w;
    }

    union {
        sockaddr base;
        sockaddr_in v4;
        sockaddr_in6 v6;
    } storage_;
};

}  // namespace mavloom::net
