// SPDX-License-Identifier: MIT
// Non-blocking UDP sockets that read and write many datagrams per system call (recvmmsg, sendmmsg).
//
// Received datagrams are whole and carry the kernel's receive time. A datagram to send is a list of pieces, which the
// kernel joins. One thread at a time; allocates only when opened.
#pragma once

#include <sys/socket.h>
#include <sys/uio.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mavloom/base/bytes.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/address.hpp"
#include "mavloom/net/fd.hpp"
#include "mavloom/net/io_result.hpp"

namespace mavloom::net {

struct Datagram {
    ByteView bytes;
    const Address* from = nullptr;
    WallTime time{};  // set by the kernel (SO_TIMESTAMPNS); the epoch if it gave none
};

// Buffers for the datagrams of one recvmmsg. A slot holds the longest possible datagram, so none is cut. Slots take up
// memory only as far as datagrams fill them. Several sockets may share one batch if they are read one after the other.
class ReceiveBatch {
public:
    static constexpr std::size_t slots = 64;
    static constexpr std::size_t slot_bytes = 65536;

    [[nodiscard]] static SetupResult<ReceiveBatch> create();
    ReceiveBatch(ReceiveBatch&&) noexcept;
    ReceiveBatch& operator=(ReceiveBatch&&) noexcept;
    ~ReceiveBatch();

    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    // Of all datagrams together.
    [[nodiscard]] std::size_t bytes() const noexcept;
    // Valid until the next receive with this batch.
    [[nodiscard]] Datagram operator[](std::size_t index) const noexcept;

private:
    friend class UdpSocket;
    struct Slots;
    ReceiveBatch(std::unique_ptr<Slots> headers, std::uint8_t* memory) noexcept;
    void rearm(std::size_t count) noexcept;

    std::unique_ptr<Slots> headers_;
    std::uint8_t* memory_ = nullptr;
    std::size_t count_ = 0;
};

// Datagrams to send. Each is a list of pieces, whose memory must stay valid until they are sent.
class SendBatch {
public:
    static constexpr std::size_t max_datagrams = 256;
    static constexpr std::size_t max_pieces = 1024;

    SendBatch();
    void clear() noexcept { count_ = pieces_ = 0; }
    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] bool full() const noexcept { return count_ == max_datagrams || pieces_ == max_pieces; }
    // Write the pieces of the next datagram here. Then call `add`, which takes the first `pieces` of them.
    [[nodiscard]] std::span<iovec> room() noexcept { return std::span(iovecs_).subspan(pieces_); }
    // `to` must stay valid until the datagram is sent; pass null for a connected socket. The batch must not be full.
    void add(const Address* to, std::size_t pieces) noexcept;

private:
    friend class LocalSender;
    friend class UdpSocket;
    std::vector<mmsghdr> messages_;
    std::vector<iovec> iovecs_;
    std::size_t count_ = 0, pieces_ = 0;
};

struct UdpOptions {
    std::uint64_t receive_buffer_bytes = 32u << 20;
    bool v6_only = false;             // if false, a socket on :: also receives IPv4
    bool broadcast = false;           // allows sending to broadcast addresses
    bool reuse_address = false;       // other sockets with this flag may bind the same address; the newest receives
    std::string device;               // the only interface to use (SO_BINDTODEVICE); empty: all
    std::optional<std::uint8_t> ttl;  // hop limit; 0 (this machine only) applies to multicast only
    // The multicast group to join. Other programs on this machine may join it too. Set `local` to the group, so that
    // the socket receives nothing else.
    std::optional<Address> group;
    std::uint32_t group_interface = 0;  // interface for multicast; 0: chosen by the routing table
};

class UdpSocket {
public:
    UdpSocket() noexcept = default;
    // Binds to `local` (port 0: any free port). The receive buffer is as large as the system allows, up to the
    // requested size.
    [[nodiscard]] static SetupResult<UdpSocket> open(const Address& local, const UdpOptions& options);

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
    [[nodiscard]] const Address& local() const noexcept { return local_; }
    // The size as the kernel reports it, which includes its own overhead.
    [[nodiscard]] std::uint64_t receive_buffer_bytes() const noexcept { return receive_buffer_bytes_; }

    // Reads the waiting datagrams, at most one batch. Returns would_block if there are none.
    [[nodiscard]] IoResult<std::size_t> receive(ReceiveBatch& batch, std::size_t most = ReceiveBatch::slots) noexcept;
    // Sends batch[first...] and returns how many datagrams went out. After an error nothing was sent, and the error
    // concerns batch[first]. The exceptions are `refused` and `unreachable`: they may concern any earlier datagram
    // (ICMP). They are then reported once.
    [[nodiscard]] IoResult<std::size_t> send(SendBatch& batch, std::size_t first) noexcept;

    // Removes and returns the oldest queued ICMP error about an earlier datagram. Returns nothing if there is none.
    struct Failure {
        Address to;        // the datagram's destination
        Address reporter;  // the host that reported the failure
        IoError error = IoError::other;
    };
    [[nodiscard]] std::optional<Failure> take_failure() noexcept;
    // Datagrams that the kernel has dropped on this socket for lack of buffer space, in total (SO_MEMINFO). Wraps at
    // 2^32.
    [[nodiscard]] std::uint32_t kernel_drops() const noexcept;

private:
    Fd fd_;
    Address local_;
    std::uint64_t receive_buffer_bytes_ = 0;
};

}  // namespace mavloom::net
