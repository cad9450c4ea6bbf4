// SPDX-License-Identifier: MIT
#include "mavloom/net/local.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "net/kernel_time.hpp"
#include "net/socket_options.hpp"
#include "net/unix_address.hpp"

namespace mavloom::net {

struct LocalSocket::Slots {
    // Holds the receive time and nothing else. Passed descriptors (SCM_RIGHTS) come after it, so the kernel discards
    // them.
    struct Control {
        alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(sizeof(timespec))> bytes;
    };
    std::array<mmsghdr, slots> messages{};
    std::array<iovec, slots> iovecs{};
    std::array<sockaddr_un, slots> from{};
    std::array<Control, slots> control{};
    // Becomes resident only as far as datagrams are long.
    std::unique_ptr<std::uint8_t[]> memory{new std::uint8_t[slots * slot_bytes]};
};

LocalSocket::LocalSocket(Fd fd, std::unique_ptr<Slots> slots_of) : fd_(std::move(fd)), slots_(std::move(slots_of)) {
    for (std::size_t i = 0; i < slots; ++i) {
        slots_->iovecs[i] = {slots_->memory.get() + i * slot_bytes, slot_bytes};
        msghdr& header = slots_->messages[i].msg_hdr;
        header.msg_iov = &slots_->iovecs[i];
        header.msg_iovlen = 1;
        header.msg_name = &slots_->from[i];
        header.msg_control = slots_->control[i].bytes.data();
    }
}

LocalSocket::LocalSocket(LocalSocket&&) noexcept = default;
LocalSocket& LocalSocket::operator=(LocalSocket&&) noexcept = default;
LocalSocket::~LocalSocket() = default;

SetupResult<LocalSocket> LocalSocket::open(const std::filesystem::path& path, unsigned mode) {
    const auto address = unix_address(path);
    if (!address) return system_error(fmt::format("cannot create a socket at {}", path.string()), ENAMETOOLONG);
    Fd fd(::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!fd) return system_error("cannot create a Unix socket", errno);
    set_option(fd.get(), SOL_SOCKET, SO_TIMESTAMPNS, 1);
    // fchmod before bind closes the gap in which other users could connect. chmod after bind restores the bits that the
    // umask removed.
    if (::fchmod(fd.get(), mode) != 0 || ::bind(fd.get(), as_sockaddr(*address), sizeof *address) != 0 ||
        ::chmod(path.c_str(), mode) != 0)
        return system_error(fmt::format("cannot create a socket at {}", path.string()), errno);
    return LocalSocket(std::move(fd), std::make_unique<Slots>());
}

IoResult<std::size_t> LocalSocket::receive() noexcept {
    for (mmsghdr& message : slots_->messages) {
        message.msg_hdr.msg_namelen = sizeof(sockaddr_un);
        message.msg_hdr.msg_controllen = sizeof(Slots::Control::bytes);
    }
    const int count = ::recvmmsg(fd_.get(), slots_->messages.data(), slots, MSG_TRUNC, nullptr);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    return static_cast<std::size_t>(count);
}

// The kernel's length may or may not include the NUL after a path.
static std::string_view sender(const sockaddr_un& from, socklen_t length) noexcept {
    constexpr std::size_t begin = offsetof(sockaddr_un, sun_path);
    if (length <= begin) return {};
    const std::string_view name(from.sun_path, std::min<std::size_t>(length - begin, sizeof from.sun_path));
    return name.front() == '\0' ? name : name.substr(0, name.find('\0'));
}

LocalDatagram LocalSocket::operator[](std::size_t index) const noexcept {
    assert(index < slots);
    const mmsghdr& message = slots_->messages[index];
    const std::size_t size = std::min<std::size_t>(message.msg_len, slot_bytes);
    return {{static_cast<const std::uint8_t*>(slots_->iovecs[index].iov_base), size},
            message.msg_len - size,
            sender(slots_->from[index], message.msg_hdr.msg_namelen),
            kernel_time(message.msg_hdr)};
}

}  // namespace mavloom::net
