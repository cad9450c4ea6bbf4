// SPDX-License-Identifier: MIT
// Builds the address of a Unix socket from its path. Private to module net. Any thread; allocates nothing.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>
#include <filesystem>
#include <optional>

namespace mavloom::net {

// Returns nothing if the path is too long for an address (more than 107 bytes).
[[nodiscard]] inline std::optional<sockaddr_un> unix_address(const std::filesystem::path& path) noexcept {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (path.native().size() >= sizeof address.sun_path) return std::nullopt;
    std::memcpy(address.sun_path, path.c_str(), path.native().size());
    return address;
}

[[nodiscard]] inline const sockaddr* as_sockaddr(const sockaddr_un& address) noexcept {
    return reinterpret_cast<const sockaddr*>(&address);
}

}  // namespace mavloom::net
