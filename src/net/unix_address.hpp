// SPDX-License-Identifier: MIT
// The address of a Unix socket at a path.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <cstring>
#include <filesystem>
#include <optional>

namespace mavloom::net {

// Empty where the path is longer than an address takes (107 bytes).
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
