// SPDX-License-Identifier: MIT
// A Unix datagram socket that sends to one other on this machine. Non-blocking. It has an address of its own, so that the far side tells senders apart;
// none that is left in a folder. One thread at a time; allocates when opened only.
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
    // `not_found` and `unreachable` while nobody has opened the path. A path of at most 107 bytes.
    [[nodiscard]] static SetupResult<LocalSender> connect(const std::filesystem::path& path);

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    // What the kernel gave it, as people write it: "@0001f".
    [[nodiscard]] std::string own_address() const;
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }

    // Sends batch[first...], whose datagrams have no address; returns how many went. `would_block`: the far side's queue is full, and the descriptor
    // becomes writable when it is not. `refused` or `closed`: the far side went.
    [[nodiscard]] IoResult<std::size_t> send(SendBatch& batch, std::size_t first) noexcept;

private:
    explicit LocalSender(Fd fd) noexcept : fd_(std::move(fd)) {}
    Fd fd_;
};

// The process that has the Unix socket at `path` open, as far as /proc shows it to us: nothing for another user's.
[[nodiscard]] std::optional<int> process_serving(const std::filesystem::path& path);

}  // namespace mavloom::net
