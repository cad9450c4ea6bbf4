// SPDX-License-Identifier: MIT
#include "net/socket_options.hpp"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <limits>

namespace mavloom::net {

void set_option(int fd, int level, int name, int value) noexcept { setsockopt(fd, level, name, &value, sizeof value); }

static int read_option(int fd, int level, int name) noexcept {
    int value = 0;
    socklen_t length = sizeof value;
    return getsockopt(fd, level, name, &value, &length) == 0 ? value : 0;
}

std::uint64_t largest_receive_buffer(int fd, std::uint64_t bytes) noexcept {
    const int ask = static_cast<int>(std::min<std::uint64_t>(bytes, std::numeric_limits<int>::max() / 2));
    // SO_RCVBUFFORCE needs CAP_NET_ADMIN. The kernel limits SO_RCVBUF to net.core.rmem_max.
    if (setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &ask, sizeof ask) != 0) set_option(fd, SOL_SOCKET, SO_RCVBUF, ask);
    return static_cast<std::uint64_t>(read_option(fd, SOL_SOCKET, SO_RCVBUF));
}

SetupResult<Address> local_address(int fd) {
    Address address;
    socklen_t length = Address::capacity;
    if (getsockname(fd, address.writable(), &length) != 0) return system_error("cannot read a socket's address", errno);
    address.normalize();
    return address;
}

}  // namespace mavloom::net
