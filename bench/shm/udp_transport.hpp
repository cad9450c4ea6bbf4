// SPDX-License-Identifier: MIT
// UDP on loopback at its best: 64 datagrams per system call, and never more in flight than the receive buffer holds, so
// that none is lost.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "mavloom/base/bytes.hpp"

namespace mavloom::bench {

class UdpTransport {
    static constexpr unsigned batch = 64;
    static constexpr std::uint64_t counted =
        1024;  // upper bound for the buffer memory that the kernel charges per datagram (768 here)
    // net.core.netdev_max_backlog is 1000; loopback uses that queue, too, and so may other programs.
    static constexpr std::uint64_t backlog = 500;
    static constexpr std::size_t longest = 512;

    struct Batch {
        Batch() {
            for (unsigned i = 0; i < batch; ++i) {
                pieces[i] = {bytes[i].data(), longest};
                messages[i].msg_hdr.msg_iov = &pieces[i];
                messages[i].msg_hdr.msg_iovlen = 1;
            }
        }
        Batch(const Batch&) = delete;
        Batch& operator=(const Batch&) = delete;

        std::array<std::array<std::uint8_t, longest>, batch> bytes;
        std::array<iovec, batch> pieces{};
        std::array<mmsghdr, batch> messages{};
    };

public:
    explicit UdpTransport(unsigned readers) {
        for (unsigned i = 0; i < readers; ++i) {
            sockaddr_in any{.sin_family = AF_INET, .sin_port = 0, .sin_addr = {htonl(INADDR_LOOPBACK)}, .sin_zero = {}};
            socklen_t size = sizeof any;
            const int in = ::socket(AF_INET, SOCK_DGRAM, 0), out = ::socket(AF_INET, SOCK_DGRAM, 0);
            auto* const address = reinterpret_cast<sockaddr*>(&any);
            if (::bind(in, address, size) != 0 || ::getsockname(in, address, &size) != 0 ||
                ::connect(out, address, size) != 0)
                std::abort();
            const int wanted = 4 << 20;
            if (::setsockopt(in, SOL_SOCKET, SO_RCVBUFFORCE, &wanted, sizeof wanted) != 0)
                ::setsockopt(in, SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
            int got = 0;
            socklen_t size_of_got = sizeof got;
            ::getsockopt(in, SOL_SOCKET, SO_RCVBUF, &got, &size_of_got);
            max_in_flight_ = std::min(static_cast<std::uint64_t>(got) / counted,
                                      std::max<std::uint64_t>(batch, backlog / readers));
            in_.push_back(in);
            out_.push_back(out);
        }
    }

    class Writer {
    public:
        Writer(const std::vector<int>& sockets, std::uint64_t most)
            : sockets_(sockets), max_in_flight_(most), batch_(std::make_unique<Batch>()) {}
        template <class Shared>
        void write(const Shared& shared, ByteView record) {
            std::memcpy(batch_->bytes[filled_].data(), record.data(), record.size());
            batch_->pieces[filled_].iov_len = record.size();
            if (++filled_ == batch) flush(shared);
        }
        template <class Shared>
        void flush(const Shared& shared) {
            while (sent_ + filled_ - shared.slowest() > max_in_flight_) ::sched_yield();
            for (const int socket : sockets_) send_all(socket);
            sent_ += filled_;
            filled_ = 0;
        }

    private:
        void send_all(int socket) {
            for (unsigned done = 0; done < filled_;) {
                const int count = ::sendmmsg(socket, batch_->messages.data() + done, filled_ - done, 0);
                if (count < 0) std::abort();
                done += static_cast<unsigned>(count);
            }
        }
        const std::vector<int>& sockets_;
        std::uint64_t max_in_flight_;
        std::unique_ptr<Batch> batch_;
        std::uint64_t sent_ = 0;
        unsigned filled_ = 0;
    };

    class Reader {
    public:
        explicit Reader(int socket) : socket_(socket), batch_(std::make_unique<Batch>()) {}
        template <class Each>
        void poll(Each&& each) {
            const int count = ::recvmmsg(socket_, batch_->messages.data(), batch, MSG_WAITFORONE, nullptr);
            for (int i = 0; i < count; ++i) each(ByteView(batch_->bytes[i].data(), batch_->messages[i].msg_len));
        }

    private:
        int socket_;
        std::unique_ptr<Batch> batch_;
    };

    [[nodiscard]] Writer writer() const { return {out_, max_in_flight_}; }
    [[nodiscard]] Reader reader(unsigned number) const { return Reader(in_[number]); }

private:
    std::vector<int> in_, out_;
    std::uint64_t max_in_flight_ = 0;
};

}  // namespace mavloom::bench
