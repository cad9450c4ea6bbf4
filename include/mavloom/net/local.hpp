// SPDX-License-Identifier: MIT
// A receiving Unix datagram socket, bound to a path, to which any number of local programs can send.
//
// One system call (recvmmsg) reads many datagrams with the kernel's receive time. Non-blocking. One thread; allocates
// only when opened.
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
    std::size_t cut = 0;  // how many bytes were cut off because the datagram exceeded the slot
    // The sender's address: a path, or a NUL and an abstract name. Empty if the sender is not bound.
    std::string_view from;
    WallTime time{};  // set by the kernel; the epoch if the kernel gave none
};

class LocalSocket {
public:
    static constexpr std::size_t slots = 32;  // datagrams per receive
    static constexpr std::size_t slot_bytes = 65536;

    // Binds to `path`, which must not exist. `mode` sets the file mode, which decides who may send, regardless of the
    // umask.
    [[nodiscard]] static SetupResult<LocalSocket> open(const std::filesystem::path& path, unsigned mode);
    LocalSocket(LocalSocket&&) noexcept;
    LocalSocket& operator=(LocalSocket&&) noexcept;
    ~LocalSocket();  // does not remove the file at the path

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    // Reads the waiting datagrams, at most `slots`. Returns would_block if there are none. Descriptors that a sender
    // passes along (SCM_RIGHTS) are discarded.
    [[nodiscard]] IoResult<std::size_t> receive() noexcept;
    // Returns one datagram of the last receive. Valid until the next receive.
    [[nodiscard]] LocalDatagram operator[](std::size_t index) const noexcept;

private:
    struct Slots;
    LocalSocket(Fd fd, std::unique_ptr<Slots> slots_of);

    Fd fd_;
    std::unique_ptr<Slots> slots_;
};

}  // namespace mavloom::net
