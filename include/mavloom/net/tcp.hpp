// SPDX-License-Identifier: MIT
// Non-blocking TCP listeners and streams. Connecting never waits; reads and writes transfer what they can at once.
//
// Streams disable Nagle's algorithm (TCP_NODELAY) and use keepalive, which detects a dead peer in about 25 s. One
// thread at a time; no call allocates on success.
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

    // Starts to connect, from the address `local` if given. When the descriptor becomes writable, `finish_connect`
    // returns the outcome.
    [[nodiscard]] static SetupResult<TcpStream> start_connect(const Address& remote,
                                                              const std::optional<Address>& local = std::nullopt);
    [[nodiscard]] SetupResult<void> finish_connect();
    // For callers that may block: waits up to `limit`. Returns true if `finish_connect` has an outcome.
    [[nodiscard]] bool wait_connected(std::chrono::milliseconds limit) const noexcept;

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
    [[nodiscard]] const Address& remote() const noexcept { return remote_; }

    // Reads at least one byte. Errors: would_block, closed (also after a reset), other.
    [[nodiscard]] IoResult<std::size_t> read(ByteSpan room) noexcept;
    // Writes some of the bytes. Errors: would_block, closed, other.
    [[nodiscard]] IoResult<std::size_t> write(std::span<const iovec> pieces) noexcept;

private:
    friend class TcpListener;
    TcpStream(Fd fd, const Address& remote) noexcept : fd_(std::move(fd)), remote_(remote) {}

    Fd fd_;
    Address remote_;
};

// The process keeps its last descriptors for its control socket, recordings and look-ups. Returns true if only these
// are left, so that no further client may be accepted. `any`: any open descriptor of the process.
[[nodiscard]] bool few_descriptors_left(int any) noexcept;

// Sets what streams have, for a stream that was made elsewhere: no delay, keepalive, and at most so many bytes that
// wait in the kernel, where they cannot expire.
void set_stream_options(int fd, int unsent_bytes) noexcept;

class TcpListener {
public:
    TcpListener() noexcept = default;
    [[nodiscard]] static SetupResult<TcpListener> open(const Address& local, bool v6_only);

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] const Address& local() const noexcept { return local_; }
    // Accepts one client. Returns would_block if no client is waiting. Returns no_descriptors if a client is waiting,
    // but the process has few or no descriptors left. The client then stays in the backlog.
    [[nodiscard]] IoResult<TcpStream> accept() noexcept;

private:
    Fd fd_;
    Address local_;
};

}  // namespace mavloom::net
