// SPDX-License-Identifier: MIT
// A Unix datagram socket at a place in the file system that any number of programs of this machine send to. Reads many datagrams in one system
// call (recvmmsg), with the kernel's receive time. Non-blocking. One thread; allocates when opened only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/fd.hpp"
#include "mavloom/net/io_result.hpp"

namespace mavloom::net {

struct LocalDatagram {
    ByteView bytes;
    std::size_t cut = 0;    // bytes that it had more than a slot holds
    std::string_view from;  // a path, or NUL and an abstract name; empty where the sender is not bound
    WallTime time{};        // the kernel's; the epoch when it gave none
};

class LocalSocket {
public:
    static constexpr std::size_t slots = 32;  // datagrams of one receive
    static constexpr std::size_t slot_bytes = 65536;

    // Binds to `path`, where nothing may be yet; `mode`: who may send, whatever the umask.
    [[nodiscard]] static SetupResult<LocalSocket> open(const std::filesystem::path& path, unsigned mode);
    LocalSocket(LocalSocket&&) noexcept;
    LocalSocket& operator=(LocalSocket&&) noexcept;
    ~LocalSocket();  // leaves what stands at the path

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    // Reads what is there, up to `slots`. would_block when there is nothing. Descriptors that somebody sends along are closed unseen.
    [[nodiscard]] IoResult<std::size_t> receive() noexcept;
    // Valid until the next receive.
    [[nodiscard]] LocalDatagram operator[](std::size_t index) const noexcept;

private:
    struct Slots;
    LocalSocket(Fd fd, std::unique_ptr<Slots> slots_of);

    Fd fd_;
    std::unique_ptr<Slots> slots_;
};

}  // namespace mavloom::net
