// SPDX-License-Identifier: MIT
// The lower bound of `bench route`: copies datagrams from one port to others with recvmmsg and sendmmsg, without
// looking at their content. With `gather` it works as Mavloom does, which knows where frames end: it combines the
// datagrams of a turn into datagrams of up to 1280 bytes, and rests between turns under heavy load.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <string_view>
#include <thread>
#include <vector>

namespace {

constexpr std::size_t batch = 64, slot_bytes = 2048, shared_bytes = 1280;

sockaddr_in loopback(const char* port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::atoi(port)));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

int open_socket(int (*attach)(int, const sockaddr*, socklen_t), const char* port) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), size = 32 << 20;
    ::setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &size, sizeof size);
    ::setsockopt(fd, SOL_SOCKET, SO_SNDBUFFORCE, &size, sizeof size);
    const sockaddr_in address = loopback(port);
    return attach(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0 ? fd : -1;
}

class Loop {
public:
    explicit Loop(bool gather) : gather_(gather), memory_(batch * slot_bytes) {
        for (std::size_t i = 0; i < batch; ++i) {
            parts_[i] = {memory_.data() + i * slot_bytes, slot_bytes};
            in_[i].msg_hdr.msg_iov = &parts_[i];
            in_[i].msg_hdr.msg_iovlen = 1;
        }
    }

    // Waits for a datagram, then receives all that have arrived, up to a batch.
    int receive(int fd) {
        for (auto& part : parts_) part.iov_len = slot_bytes;
        const int count = ::recvmmsg(fd, in_.data(), batch, MSG_WAITFORONE, nullptr);
        for (int i = 0; i < count; ++i)
            parts_[static_cast<std::size_t>(i)].iov_len = in_[static_cast<std::size_t>(i)].msg_len;
        return count;
    }

    // Arranges the received frames as datagrams to send. Returns their number.
    std::size_t arrange(std::size_t received) {
        std::size_t datagrams = 0, bytes = 0;
        for (std::size_t i = 0; i < received; ++i) {
            if (gather_ && datagrams != 0 && bytes + parts_[i].iov_len <= shared_bytes) {
                ++out_[datagrams - 1].msg_hdr.msg_iovlen;
                bytes += parts_[i].iov_len;
                continue;
            }
            out_[datagrams].msg_hdr.msg_iov = &parts_[i];
            out_[datagrams++].msg_hdr.msg_iovlen = 1;
            bytes = parts_[i].iov_len;
        }
        return datagrams;
    }

    void send(int fd, std::size_t datagrams) {
        for (std::size_t sent = 0; sent < datagrams;) {
            const int count = ::sendmmsg(fd, &out_[sent], static_cast<unsigned>(datagrams - sent), 0);
            if (count > 0) sent += static_cast<std::size_t>(count);
            if (count < 0 && errno != EINTR && errno != ECONNREFUSED) return;
        }
    }

private:
    bool gather_;
    std::vector<char> memory_;
    std::array<iovec, batch> parts_{};
    std::array<mmsghdr, batch> in_{}, out_{};
};

// Rests until 0.2 ms after the last turn began, by the rules of docs/design/turn.md. Counts datagrams, because the loop
// does not see frames. The limit of 250 in 10 ms is above the benchmark's lowest load and below its other loads.
class Rest {
public:
    using Clock = std::chrono::steady_clock;

    void begin_turn() { began_ = Clock::now(); }
    void end_turn(int received) {
        const auto now = Clock::now();
        count_ += received;
        if (const auto passed = now - since_; passed >= window) {
            busy_ = passed < count_ * (window / many);
            since_ = now;
            count_ = 0;
        }
        if (busy_ && received < static_cast<int>(batch)) std::this_thread::sleep_until(began_ + interval);
    }

private:
    static constexpr Clock::duration window = std::chrono::milliseconds{10}, interval = std::chrono::microseconds{200};
    static constexpr int many = 250;
    Clock::time_point began_, since_;
    int count_ = 0;
    bool busy_ = false;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        fmt::print(stderr, "usage: route_bare_loop PORT single|gather TO_PORT...\n");
        return 2;
    }
    const int in = open_socket(::bind, argv[1]);
    std::vector<int> out;
    for (int i = 3; i < argc; ++i) out.push_back(open_socket(::connect, argv[i]));
    if (in < 0) return 1;
    const bool gathers = std::string_view(argv[2]) == "gather";
    Loop loop(gathers);
    Rest rest;
    for (;;) {
        const int received = loop.receive(in);
        if (received <= 0) continue;
        if (gathers) rest.begin_turn();
        const std::size_t datagrams = loop.arrange(static_cast<std::size_t>(received));
        for (const int fd : out) loop.send(fd, datagrams);
        if (gathers) rest.end_turn(received);
    }
}
