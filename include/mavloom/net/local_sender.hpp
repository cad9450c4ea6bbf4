// SPDX-License-Identifier: MIT
// A sending Unix datagram socket, connected to one receiver on this machine. Non-blocking.
//
// The socket has an abstract address of its own, so that the receiver can tell senders apart. It leaves no file behind.
// One thread at a time; allocates only when opened.
#pragma once

#include <filesystem>
#include <string>

#include "mavloom/net/fd.hpp"
#include "mavloom/net/io_result.hpp"
#include "mavloom/net/udp.hpp"

namespace mavloom::net {

class LocalSender {
public:
    LocalSender() noexcept = default;
    // Returns `not_found` or `unreachable` if no program has the path open. The path has at most 107 bytes.
    [[nodiscard]] static SetupResult<LocalSender> connect(const std::filesystem::path& path);

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    // The address that the kernel assigned, in the usual notation: "@0001f".
    [[nodiscard]] std::string own_address() const;
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }

    // Sends batch[first...] and returns how many datagrams went out. The datagrams must have no address. Errors:
    // - `would_block`: the receiver's queue is full. The descriptor becomes writable when there is room.
    // - `refused` or `closed`: the receiver is gone.
    [[nodiscard]] IoResult<std::size_t> send(SendBatch& batch, std::size_t first) noexcept;

private:
    explicit LocalSender(Fd fd) noexcept : fd_(std::move(fd)) {}
    Fd fd_;
};

// Returns the process that has the Unix socket at `path` open, as far as /proc shows it. Returns nothing if that
// process belongs to another user.
[[nodiscard]] std::optional<int> process_serving(const std::filesystem::path& path);

}  // namespace mavloom::net
