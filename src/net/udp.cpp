// SPDX-License-Identifier: MIT
#include "mavloom/net/udp.hpp"

#include <fmt/format.h>
#include <linux/errqueue.h>
#include <linux/sock_diag.h>
#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "net/kernel_time.hpp"
#include "net/socket_options.hpp"

#ifndef SO_MEMINFO  // Linux 4.12; missing from glibc's headers on some architectures
#define SO_MEMINFO 55
#endif

namespace mavloom::net {

// The stride is a little more than 64 KiB. With exactly 64 KiB, all slots would start in the same cache set.
static constexpr std::size_t slot_stride = ReceiveBatch::slot_bytes + 4096 + 192;
static constexpr std::size_t batch_bytes = slot_stride * ReceiveBatch::slots;

struct ReceiveBatch::Slots {
    struct Control {
        alignas(cmsghdr) std::array<std::uint8_t, CMSG_SPACE(sizeof(timespec))> bytes;
    };
    std::array<mmsghdr, slots> messages{};
    std::array<iovec, slots> iovecs{};
    std::array<Address, slots> from{};
    std::array<Control, slots> control{};
};

SetupResult<ReceiveBatch> ReceiveBatch::create() {
    void* memory = mmap(nullptr, batch_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1,
                        0);
    if (memory == MAP_FAILED) return system_error("cannot allocate memory for received datagrams", errno);
    // Transparent huge pages would make every slot fully resident.
    madvise(memory, batch_bytes, MADV_NOHUGEPAGE);
    return ReceiveBatch(std::make_unique<Slots>(), static_cast<std::uint8_t*>(memory));
}

ReceiveBatch::ReceiveBatch(std::unique_ptr<Slots> headers, std::uint8_t* memory) noexcept
    : headers_(std::move(headers)), memory_(memory) {
    for (std::size_t i = 0; i < slots; ++i) {
        headers_->iovecs[i] = {memory_ + i * slot_stride, slot_bytes};
        msghdr& header = headers_->messages[i].msg_hdr;
        header.msg_iov = &headers_->iovecs[i];
        header.msg_iovlen = 1;
        header.msg_name = headers_->from[i].writable();
        header.msg_control = headers_->control[i].bytes.data();
    }
    rearm(slots);
}

ReceiveBatch::ReceiveBatch(ReceiveBatch&& other) noexcept
    : headers_(std::move(other.headers_)),
      memory_(std::exchange(other.memory_, nullptr)),
      count_(std::exchange(other.count_, 0)) {}

ReceiveBatch& ReceiveBatch::operator=(ReceiveBatch&& other) noexcept {
    std::swap(headers_, other.headers_);
    std::swap(memory_, other.memory_);
    std::swap(count_, other.count_);
    return *this;
}

ReceiveBatch::~ReceiveBatch() {
    if (memory_ != nullptr) munmap(memory_, batch_bytes);
}

// Restores the buffer lengths, which the kernel replaced with the used lengths.
void ReceiveBatch::rearm(std::size_t count) noexcept {
    assert(count <= slots);
    for (std::size_t i = 0; i < count; ++i) {
        msghdr& header = headers_->messages[i].msg_hdr;
        header.msg_namelen = Address::capacity;
        header.msg_controllen = sizeof(Slots::Control::bytes);
        header.msg_flags = 0;
    }
}

Datagram ReceiveBatch::operator[](std::size_t index) const noexcept {
    assert(index < count_);
    const mmsghdr& message = headers_->messages[index];
    return {{static_cast<const std::uint8_t*>(headers_->iovecs[index].iov_base), message.msg_len},
            &headers_->from[index],
            kernel_time(message.msg_hdr)};
}

std::size_t ReceiveBatch::bytes() const noexcept {
    std::size_t sum = 0;
    for (std::size_t i = 0; i < count_; ++i) sum += headers_->messages[i].msg_len;
    return sum;
}

SendBatch::SendBatch() : messages_(max_datagrams), iovecs_(max_pieces) {}

void SendBatch::add(const Address* to, std::size_t pieces) noexcept {
    assert(!full() && pieces != 0 && pieces_ + pieces <= max_pieces);
    msghdr& header = messages_[count_++].msg_hdr;
    header = {};
    header.msg_iov = &iovecs_[pieces_];
    header.msg_iovlen = pieces;
    if (to != nullptr) {
        header.msg_name = const_cast<sockaddr*>(to->data());  // only read by sendmmsg
        header.msg_namelen = to->size();
    }
    pieces_ += pieces;
}

static void set_hops(int fd, bool v6, std::uint8_t hops) noexcept {
    set_option(fd, IPPROTO_IP, IP_MULTICAST_TTL, hops);
    if (v6) set_option(fd, IPPROTO_IPV6, IPV6_MULTICAST_HOPS, hops);
    if (hops == 0) return;  // multicast only: unicast needs at least one hop
    set_option(fd, IPPROTO_IP, IP_TTL, hops);
    if (v6) set_option(fd, IPPROTO_IPV6, IPV6_UNICAST_HOPS, hops);
}

static SetupResult<void> bind_to_device(int fd, const std::string& device) {
    if (device.empty()) return {};
    if (setsockopt(fd, SOL_SOCKET, SO_BINDTODEVICE, device.c_str(), static_cast<socklen_t>(device.size())) == 0)
        return {};
    return system_error(fmt::format("cannot use the interface '{}'", device), errno);
}

// Enables loopback of sent multicast, so that other programs on this machine receive it.
static SetupResult<void> choose_group_interface(int fd, bool v6, std::uint32_t index) {
    set_option(fd, IPPROTO_IP, IP_MULTICAST_LOOP, 1);
    if (v6) set_option(fd, IPPROTO_IPV6, IPV6_MULTICAST_LOOP, 1);
    if (index == 0) return {};
    ip_mreqn v4{};
    v4.imr_ifindex = static_cast<int>(index);
    const int v6_index = static_cast<int>(index);
    const int failed = v6 ? setsockopt(fd, IPPROTO_IPV6, IPV6_MULTICAST_IF, &v6_index, sizeof v6_index)
                          : setsockopt(fd, IPPROTO_IP, IP_MULTICAST_IF, &v4, sizeof v4);
    if (failed != 0) return system_error("cannot send to multicast groups through this interface", errno);
    return {};
}

static SetupResult<void> join(int fd, const Address& group, std::uint32_t index) {
    group_req request{};
    request.gr_interface = index;
    std::memcpy(&request.gr_group, group.data(), group.size());
    const int level = group.is_v6() ? int{IPPROTO_IPV6} : int{IPPROTO_IP};
    if (setsockopt(fd, level, MCAST_JOIN_GROUP, &request, sizeof request) != 0) {
        return system_error(fmt::format("cannot join the group {}", group.host_text()), errno);
    }
    return {};
}

SetupResult<UdpSocket> UdpSocket::open(const Address& local, const UdpOptions& options) {
    UdpSocket socket;
    socket.fd_ = Fd(::socket(local.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
    if (!socket.fd_) return system_error("cannot create a UDP socket", errno);
    const int fd = socket.fd();
    if (local.is_v6()) set_option(fd, IPPROTO_IPV6, IPV6_V6ONLY, options.v6_only ? 1 : 0);
    set_option(fd, SOL_SOCKET, SO_TIMESTAMPNS, 1);
    // Without this option the kernel hides closed ports (ICMP). It also reports datagrams as sent that a full device
    // queue dropped.
    set_option(fd, IPPROTO_IP, IP_RECVERR, 1);  // for IPv4 peers, also of an IPv6 socket
    if (local.is_v6()) set_option(fd, IPPROTO_IPV6, IPV6_RECVERR, 1);
    socket.receive_buffer_bytes_ = largest_receive_buffer(fd, options.receive_buffer_bytes);
    if (options.broadcast) set_option(fd, SOL_SOCKET, SO_BROADCAST, 1);
    if (options.group || options.reuse_address) set_option(fd, SOL_SOCKET, SO_REUSEADDR, 1);
    if (options.ttl) set_hops(fd, local.is_v6(), *options.ttl);
    if (auto done = bind_to_device(fd, options.device); !done) return tl::unexpected(std::move(done).error());
    if (auto done = choose_group_interface(fd, local.is_v6(), options.group_interface); !done)
        return tl::unexpected(std::move(done).error());
    if (::bind(fd, local.data(), local.size()) != 0)
        return system_error(fmt::format("cannot bind UDP {}", local.text()), errno);
    if (options.group) {
        if (auto done = join(fd, *options.group, options.group_interface); !done)
            return tl::unexpected(std::move(done).error());
    }
    auto bound = local_address(fd);
    if (!bound) return tl::unexpected(std::move(bound).error());
    socket.local_ = *bound;
    return socket;
}

IoResult<std::size_t> UdpSocket::receive(ReceiveBatch& batch, std::size_t most) noexcept {
    assert(most != 0);
    batch.rearm(batch.count_);
    batch.count_ = 0;
    const int count = recvmmsg(fd_.get(), batch.headers_->messages.data(),
                               static_cast<unsigned>(std::min(most, ReceiveBatch::slots)), 0, nullptr);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    batch.count_ = static_cast<std::size_t>(count);
    assert(batch.count_ <= most);
    for (std::size_t i = 0; i < batch.count_; ++i) batch.headers_->from[i].normalize();
    return batch.count_;
}

IoResult<std::size_t> UdpSocket::send(SendBatch& batch, std::size_t first) noexcept {
    assert(first < batch.size());
    const auto left = static_cast<unsigned>(batch.size() - first);
    const int count = sendmmsg(fd_.get(), batch.messages_.data() + first, left, MSG_NOSIGNAL);
    if (count < 0) return tl::unexpected(io_error_of(errno));
    return static_cast<std::size_t>(count);
}

// The kernel writes a sock_extended_err and behind it the reporter's address.
static void read_report(msghdr& header, UdpSocket::Failure& failure) noexcept {
    for (cmsghdr* control = CMSG_FIRSTHDR(&header); control != nullptr; control = CMSG_NXTHDR(&header, control)) {
        const bool is_error = (control->cmsg_level == IPPROTO_IP && control->cmsg_type == IP_RECVERR) ||
                              (control->cmsg_level == IPPROTO_IPV6 && control->cmsg_type == IPV6_RECVERR);
        if (!is_error) continue;
        sock_extended_err error;
        std::memcpy(&error, CMSG_DATA(control), sizeof error);
        failure.error = io_error_of(static_cast<int>(error.ee_errno));
        const std::size_t rest = std::min<std::size_t>(control->cmsg_len - CMSG_LEN(sizeof error), Address::capacity);
        std::memcpy(failure.reporter.writable(), CMSG_DATA(control) + sizeof error, rest);
        failure.reporter.normalize();
        return;
    }
}

std::optional<UdpSocket::Failure> UdpSocket::take_failure() noexcept {
    Failure failure;
    alignas(cmsghdr) std::array<std::uint8_t, 512> control;
    // Begin of the datagram that failed. Without room for it, qemu-user reports a success each time.
    std::uint8_t sent = 0;
    iovec payload{&sent, sizeof sent};
    msghdr header{};
    header.msg_name = failure.to.writable();
    header.msg_namelen = Address::capacity;
    header.msg_iov = &payload;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    if (recvmsg(fd_.get(), &header, MSG_ERRQUEUE | MSG_DONTWAIT) < 0) return std::nullopt;
    failure.to.normalize();
    read_report(header, failure);
    return failure;
}

std::uint32_t UdpSocket::kernel_drops() const noexcept {
    std::array<std::uint32_t, SK_MEMINFO_VARS> info{};
    socklen_t length = sizeof info;
    if (getsockopt(fd_.get(), SOL_SOCKET, SO_MEMINFO, info.data(), &length) != 0) return 0;
    return info[SK_MEMINFO_DROPS];
}

}  // namespace mavloom::net
