// SPDX-License-Identifier: MIT
#include "mavloom/net/local_sender.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <string_view>
#include <utility>

#include "mavloom/base/shown.hpp"
#include "net/unix_address.hpp"

namespace mavloom::net {

SetupResult<LocalSender> LocalSender::connect(const std::filesystem::path& path) {
    const auto far = unix_address(path);
    if (!far) return setup_error(SetupCode::usage, fmt::format("{} is too long for a socket's path", path.string()));
    Fd fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd) return system_error("cannot make a local socket", errno);
    sockaddr_un own{};  // without a name: the kernel gives one that is free, and no file
    own.sun_family = AF_UNIX;
    if (::bind(fd.get(), as_sockaddr(own), sizeof own.sun_family) != 0)
        return system_error("cannot bind a local socket", errno);
    if (::connect(fd.get(), as_sockaddr(*far), sizeof *far) != 0)
        return system_error(fmt::format("cannot send to {}", path.string()), errno);
    return LocalSender(std::move(fd));
}

std::string LocalSender::own_address() const {
    sockaddr_un own{};
    socklen_t length = sizeof own;
    constexpr std::size_t before = offsetof(sockaddr_un, sun_path) + 1;  // the NUL of an abstract name
    if (::getsockname(fd_.get(), reinterpret_cast<sockaddr*>(&own), &length) != 0 || length <= before) return {};
    return fmt::format("@{}", printable(std::string_view(own.sun_path + 1, length - before)));
}

IoResult<std::size_t> LocalSender::send(SendBatch& batch, std::size_t first) noexcept {
    const auto left = static_cast<unsigned>(batch.size() - first);
    const int count = ::sendmmsg(fd_.get(), batch.messages_.data() + first, left, MSG_NOSIGNAL);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    return static_cast<std::size_t>(count);
}

}  // namespace mavloom::net
