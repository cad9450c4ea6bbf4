// SPDX-License-Identifier: MIT
// TCP listeners and streams, non-blocking throughout: connecting never waits, reading and writing take what there is. Streams have
// keepalive (a dead far side is found in about 25 s) and no delay. One thread at a time; allocates nothing per call.
#pragma once

#include <sys/uio.h>

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/net/fd.hpp"
#include "mavloom/net/io_result.hpp"

namespace mavloom::net {

class TcpStream {
public:
    TcpStream() noexcept = default;

    // Begins to connect, from `local` where given; when the descriptor becomes writable, `finish_connect` tells the outcome.
    [[nodiscard]] static SetupResult<TcpStream> start_connect(const Address& remote,
                                                              const std::optional<Address>& local = std::nullopt);
    [[nodiscard]] SetupResult<void> finish_connect();
    // For callers that may wait: true when `finish_connect` has an outcome within `limit`.
    [[nodiscard]] bool wait_connected(std::chrono::milliseconds limit) const noexcept;

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
    [[nodiscard]] const Address& remote() const noexcept { return remote_; }

    // At least one byte, or would_block, closed (also for a reset), other.
    [[nodiscard]] IoResult<std::size_t> read(ByteSpan room) noexcept;
    // Some of the bytes, or would_block, closed, other.
    [[nodiscard]] IoResult<std::size_t> write(std::span<const iovec> pieces) noexcept;

private:
    friend class TcpListener;
    TcpStream(Fd fd, const Address& remote) noexcept : fd_(std::move(fd)), remote_(remote) {}

    Fd fd_;
    Address remote_;
};

class TcpListener {
public:
    TcpListener() noexcept = default;
    [[nodiscard]] static SetupResult<TcpListener> open(const Address& local, bool v6_only);

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] const Address& local() const noexcept { return local_; }
    // would_block when nobody waits; no_descriptors when the process has none or only a few left (the client then waits on).
    [[nodiscard]] IoResult<TcpStream> accept() noexcept;

private:
    Fd fd_;
    Address local_;
};

}  // namespace mavloom::net
