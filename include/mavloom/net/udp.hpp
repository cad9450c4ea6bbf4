// SPDX-License-Identifier: MIT
// UDP sockets that read and write many datagrams in one system call (recvmmsg, sendmmsg). Datagrams arrive whole, with the kernel's receive
// time; datagrams leave gathered from pieces. Non-blocking throughout. One thread at a time; allocates when opened only.
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
    WallTime time{};  // the kernel's (SO_TIMESTAMPNS); the epoch when it gave none
};

// Room for the datagrams of one recvmmsg. Each slot holds the longest datagram there is, so that none is cut; memory is touched only as far
// as datagrams are long. May be shared by any number of sockets that are read in turn.
class ReceiveBatch {
public:
    static constexpr std::size_t slots = 64;
    static constexpr std::size_t slot_bytes = 65536;

    [[nodiscard]] static SetupResult<ReceiveBatch> create();
    ReceiveBatch(ReceiveBatch&&) noexcept;
    ReceiveBatch& operator=(ReceiveBatch&&) noexcept;
    ~ReceiveBatch();

    [[nodiscard]] std::size_t size() const noexcept { return count_; }
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

// Datagrams to send: each a list of pieces that must stay until they are sent.
class SendBatch {
public:
    static constexpr std::size_t max_datagrams = 256;
    static constexpr std::size_t max_pieces = 1024;

    SendBatch();
    void clear() noexcept { count_ = pieces_ = 0; }
    [[nodiscard]] std::size_t size() const noexcept { return count_; }
    [[nodiscard]] bool full() const noexcept { return count_ == max_datagrams || pieces_ == max_pieces; }
    // Where the next datagram's pieces are to be written; `add` then takes the first `pieces` of them.
    [[nodiscard]] std::span<iovec> room() noexcept { return std::span(iovecs_).subspan(pieces_); }
    // `to` must stay until sent; null for a connected socket. The batch must not be full.
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
    bool v6_only = false;             // else a socket on :: also hears IPv4
    bool broadcast = false;           // may send to broadcast addresses
    std::string device;               // sends and hears by this interface only (SO_BINDTODEVICE); empty: by all
    std::optional<std::uint8_t> ttl;  // hops; 0 only for groups: this machine
    // A multicast group to hear; others of this machine may hear it too. `local` is then the group, so that nothing else is heard.
    std::optional<Address> group;
    std::uint32_t group_interface = 0;  // by which groups are heard and sent to; 0: as the routes say
};

class UdpSocket {
public:
    UdpSocket() noexcept = default;
    // Bound to `local` (port 0: any free one), with the largest receive buffer that the system gives up to the one asked.
    [[nodiscard]] static SetupResult<UdpSocket> open(const Address& local, const UdpOptions& options);

    [[nodiscard]] int fd() const noexcept { return fd_.get(); }
    [[nodiscard]] explicit operator bool() const noexcept { return static_cast<bool>(fd_); }
    [[nodiscard]] const Address& local() const noexcept { return local_; }
    // As the kernel counts it, its own overhead included.
    [[nodiscard]] std::uint64_t receive_buffer_bytes() const noexcept { return receive_buffer_bytes_; }

    // Reads what is there, up to a batch. would_block when there is nothing.
    [[nodiscard]] IoResult<std::size_t> receive(ReceiveBatch& batch) noexcept;
    // Sends batch[first...]; returns how many went. An error is about batch[first], and nothing went; but `refused` may be about any earlier
    // datagram, whose port was closed (ICMP), and is told once.
    [[nodiscard]] IoResult<std::size_t> send(SendBatch& batch, std::size_t first) noexcept;

    // Takes the oldest ICMP error about an earlier datagram off its queue; nothing where there is none.
    struct Failure {
        Address to;  // where the datagram was sent
        IoError error = IoError::other;
    };
    [[nodiscard]] std::optional<Failure> take_failure() noexcept;
    // Datagrams that the kernel dropped on this socket for lack of room, ever (SO_MEMINFO; wraps at 2^32).
    [[nodiscard]] std::uint32_t kernel_drops() const noexcept;

private:
    Fd fd_;
    Address local_;
    std::uint64_t receive_buffer_bytes_ = 0;
};

}  // namespace mavloom::net
