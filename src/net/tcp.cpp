// SPDX-License-Identifier: MIT
#include "mavloom/net/tcp.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>

#include <algorithm>
#include <cassert>
#include <cerrno>

#include "net/socket_options.hpp"

namespace mavloom::net {

// Limit for unsent bytes in the kernel. Everything beyond it waits in the owner's queue, where it can expire.
static constexpr int max_unsent_bytes = 128 * 1024;

void set_stream_options(int fd, int unsent_bytes) noexcept {
    set_option(fd, IPPROTO_TCP, TCP_NODELAY, 1);
    set_option(fd, IPPROTO_TCP, TCP_NOTSENT_LOWAT, unsent_bytes);
    set_option(fd, SOL_SOCKET, SO_KEEPALIVE, 1);
    set_option(fd, IPPROTO_TCP, TCP_KEEPIDLE, 10);
    set_option(fd, IPPROTO_TCP, TCP_KEEPINTVL, 5);
    set_option(fd, IPPROTO_TCP, TCP_KEEPCNT, 3);
}

SetupResult<TcpStream> TcpStream::start_connect(const Address& remote, const std::optional<Address>& local) {
    Fd fd(::socket(remote.family(), SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd) return system_error("cannot create a TCP socket", errno);
    set_stream_options(fd.get(), max_unsent_bytes);
    if (local) {
        set_option(fd.get(), SOL_SOCKET, SO_REUSEADDR, 1);
        if (::bind(fd.get(), local->data(), local->size()) != 0)
            return system_error(fmt::format("cannot bind TCP {}", local->text()), errno);
    }
    if (::connect(fd.get(), remote.data(), remote.size()) != 0 && errno != EINPROGRESS) {
        return system_error(fmt::format("cannot connect to {}", remote.text()), errno);
    }
    return TcpStream(std::move(fd), remote);
}

SetupResult<void> TcpStream::finish_connect() {
    int error = 0;
    socklen_t length = sizeof error;
    if (getsockopt(fd_.get(), SOL_SOCKET, SO_ERROR, &error, &length) != 0) error = errno;
    if (error != 0) return system_error(fmt::format("cannot connect to {}", remote_.text()), error);
    return {};
}

bool TcpStream::wait_connected(std::chrono::milliseconds limit) const noexcept {
    pollfd wanted{fd_.get(), POLLOUT, 0};
    return ::poll(&wanted, 1, static_cast<int>(limit.count())) == 1;
}

IoResult<std::size_t> TcpStream::read(ByteSpan room) noexcept {
    assert(!room.empty() && "0 bytes mean that the stream has ended");
    const ssize_t count = ::recv(fd_.get(), room.data(), room.size(), 0);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    if (count == 0) return tl::unexpected(IoError::closed);
    return static_cast<std::size_t>(count);
}

IoResult<std::size_t> TcpStream::write(std::span<const iovec> pieces) noexcept {
    assert(!pieces.empty());
    msghdr header{};
    header.msg_iov = const_cast<iovec*>(pieces.data());  // only read by sendmsg
    header.msg_iovlen = pieces.size();
    const ssize_t count = ::sendmsg(fd_.get(), &header, MSG_NOSIGNAL);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    return static_cast<std::size_t>(count);
}

SetupResult<TcpListener> TcpListener::open(const Address& local, bool v6_only) {
    TcpListener listener;
    listener.fd_ = Fd(::socket(local.family(), SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!listener.fd_) return system_error("cannot create a TCP socket", errno);
    const int fd = listener.fd();
    if (local.is_v6()) set_option(fd, IPPROTO_IPV6, IPV6_V6ONLY, v6_only ? 1 : 0);
    // Lets a restarted program reuse its port while old connections linger. A port with an active listener is still
    // refused.
    set_option(fd, SOL_SOCKET, SO_REUSEADDR, 1);
    if (::bind(fd, local.data(), local.size()) != 0 || ::listen(fd, SOMAXCONN) != 0) {
        return system_error(fmt::format("cannot listen on TCP {}", local.text()), errno);
    }
    auto bound = local_address(fd);
    if (!bound) return tl::unexpected(std::move(bound).error());
    listener.local_ = *bound;
    return listener;
}

// The kernel assigns the lowest free number, so that number shows how many are left.
bool few_descriptors_left(int any) noexcept {
    constexpr rlim_t kept = 16;
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return false;
    const Fd lowest(fcntl(any, F_DUPFD_CLOEXEC, 0));
    return !lowest || static_cast<rlim_t>(lowest.get()) >= limit.rlim_cur - std::min(kept, limit.rlim_cur / 4);
}

static bool has_waiting_client(int listening) noexcept {
    pollfd wanted{listening, POLLIN, 0};
    return ::poll(&wanted, 1, 0) == 1;
}

IoResult<TcpStream> TcpListener::accept() noexcept {
    if (few_descriptors_left(fd_.get()))
        return tl::unexpected(has_waiting_client(fd_.get()) ? IoError::no_descriptors : IoError::would_block);
    Address remote;
    socklen_t length = Address::capacity;
    Fd fd(::accept4(fd_.get(), remote.writable(), &length, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!fd) return tl::unexpected(io_error_of(errno));
    remote.normalize();
    set_stream_options(fd.get(), max_unsent_bytes);
    return TcpStream(std::move(fd), remote);
}

}  // namespace mavloom::net
