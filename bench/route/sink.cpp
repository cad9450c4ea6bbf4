// SPDX-License-Identifier: MIT
// The far side of `bench route`: receives on sockets that bench/route.py opened. Checks that each frame is one that the
// generator sent, whole and unchanged, and counts each frame number once per socket. After standard input has ended and
// nothing has arrived for a while, prints what it received.
#include <fmt/format.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <numeric>
#include <string>

#include "traffic.hpp"

namespace {

using mavloom::bench::now_ns;
using mavloom::bench::Received;
using mavloom::bench::Traffic;

constexpr std::size_t batch = 64, slot_bytes = 2048;
constexpr int tick_ms = 100, quiet_ticks = 20;
constexpr std::uint64_t longest_wait_ns = 20'000'000'000;  // for a router that still sends what it has queued

// A histogram of times. A bucket is at most 1/64 as wide as the times in it.
class Histogram {
public:
    void add(std::uint64_t ns) noexcept {
        const int shift = std::max(0, static_cast<int>(std::bit_width(ns)) - 7);
        ++counts_[static_cast<std::size_t>(shift) * 64 + static_cast<std::size_t>(ns >> shift)];
        ++total_;
    }
    [[nodiscard]] double quantile_us(double share) const noexcept {
        const auto rank = static_cast<std::uint64_t>(share * static_cast<double>(total_));
        std::uint64_t seen = 0;
        for (std::size_t i = 0; i < counts_.size(); ++i)
            if ((seen += counts_[i]) > rank) return middle_ns(i) / 1e3;
        return 0;
    }

private:
    static double middle_ns(std::size_t bucket) noexcept {
        const std::size_t shift = bucket < 128 ? 0 : bucket / 64 - 1;
        return (static_cast<double>(bucket - shift * 64) + 0.5) * static_cast<double>(std::uint64_t{1} << shift);
    }
    std::array<std::uint64_t, 58 * 64 + 128> counts_{};
    std::uint64_t total_ = 0;
};

struct Port {
    explicit Port(int socket, std::uint64_t frames) : fd(socket), seen((frames + 63) / 64) {}

    int fd;
    std::vector<std::uint64_t> seen;  // one bit per number
    std::uint64_t distinct = 0, next = 0;
};

struct Counts {
    std::uint64_t datagrams = 0, duplicates = 0, reordered = 0, echoes = 0, damaged = 0, foreign = 0;
};

class Sink {
public:
    Sink(const Traffic& traffic, std::uint64_t frames, bool mesh)
        : traffic_(traffic), frames_(frames), mesh_(mesh), memory_(batch * slot_bytes) {
        for (std::size_t i = 0; i < batch; ++i) {
            slots_[i] = {memory_.data() + i * slot_bytes, slot_bytes};
            messages_[i].msg_hdr.msg_iov = &slots_[i];
            messages_[i].msg_hdr.msg_iovlen = 1;
        }
    }

    // Reads everything that has arrived.
    void drain(Port& port, unsigned link) {
        while (take_batch(port, link) == static_cast<int>(batch)) {}
    }

    [[nodiscard]] bool complete(const std::vector<Port>& ports) const {
        const auto distinct = std::accumulate(ports.begin(), ports.end(), std::uint64_t{0},
                                              [](std::uint64_t sum, const Port& port) { return sum + port.distinct; });
        return distinct == frames_ * (ports.size() - (mesh_ ? 1 : 0));
    }

    void print(const std::vector<Port>& ports) const {
        std::string distinct;
        for (const Port& port : ports) distinct += fmt::format("{}{}", distinct.empty() ? "" : ",", port.distinct);
        fmt::print(
            "{{\"distinct\":[{}],\"datagrams\":{},\"duplicates\":{},\"reordered\":{},\"echoes\":{},\"damaged\":{},"
            "\"foreign\":{},\"median_us\":{:.1f},\"p99_us\":{:.1f}}}\n",
            distinct, counts_.datagrams, counts_.duplicates, counts_.reordered, counts_.echoes, counts_.damaged,
            counts_.foreign, latency_.quantile_us(0.5), latency_.quantile_us(0.99));
    }

private:
    int take_batch(Port& port, unsigned link) {
        const int count = ::recvmmsg(port.fd, messages_.data(), batch, MSG_DONTWAIT, nullptr);
        const std::uint64_t now = now_ns();
        for (int i = 0; i < count; ++i) {
            const auto& message = messages_[static_cast<std::size_t>(i)];
            ++counts_.datagrams;
            if ((message.msg_hdr.msg_flags & MSG_TRUNC) != 0) {
                ++counts_.damaged;
                continue;
            }
            const auto* bytes = memory_.data() + static_cast<std::size_t>(i) * slot_bytes;
            for (std::size_t at = 0; at < message.msg_len;) {
                const Received frame = traffic_.check({bytes + at, message.msg_len - at});
                count_frame(port, link, frame, now);
                at += frame.size;
            }
        }
        return count;
    }

    void count_frame(Port& port, unsigned link, const Received& frame, std::uint64_t now) {
        if (frame.kind == Received::Kind::foreign) {
            ++counts_.foreign;
        } else if (frame.kind == Received::Kind::damaged || frame.number >= frames_) {
            ++counts_.damaged;
        } else if (mesh_ && traffic_.link_of(frame.number) == link) {
            ++counts_.echoes;
        } else if (std::uint64_t& word = port.seen[frame.number / 64], bit = std::uint64_t{1} << frame.number % 64;
                   (word & bit) != 0) {
            ++counts_.duplicates;
        } else {
            word |= bit;
            ++port.distinct;
            counts_.reordered += frame.number < port.next;
            port.next = std::max(port.next, frame.number + 1);
            latency_.add(now > frame.sent_ns ? now - frame.sent_ns : 0);
        }
    }

    const Traffic& traffic_;
    std::uint64_t frames_;
    bool mesh_;
    Counts counts_;
    Histogram latency_;
    std::vector<std::uint8_t> memory_;
    std::array<iovec, batch> slots_{};
    std::array<mmsghdr, batch> messages_{};
};

bool input_ended() {
    pollfd in{STDIN_FILENO, POLLIN, 0};
    char byte;
    return ::poll(&in, 1, 0) > 0 && ::read(STDIN_FILENO, &byte, 1) <= 0;
}

// Receives until the input has ended and every frame has arrived, or no more frames arrive. Sleeps after each wake-up,
// so that it handles a fast load in batches.
void receive(Sink& sink, std::vector<Port>& ports, useconds_t rest_us) {
    const int epoll = ::epoll_create1(EPOLL_CLOEXEC);
    for (std::size_t i = 0; i < ports.size(); ++i) {
        epoll_event event{.events = EPOLLIN, .data = {.u64 = i}};
        ::epoll_ctl(epoll, EPOLL_CTL_ADD, ports[i].fd, &event);
    }
    std::array<epoll_event, batch> ready{};
    std::uint64_t ended_at = 0;
    for (int busy = 0, quiet = 0;;) {
        const int count = ::epoll_wait(epoll, ready.data(), batch, tick_ms);
        for (int i = 0; i < count; ++i) {
            const auto index = ready[static_cast<std::size_t>(i)].data.u64;
            sink.drain(ports[index], static_cast<unsigned>(index));
        }
        quiet = count > 0 ? 0 : quiet + 1;
        if (quiet != 0 || ++busy % 1024 == 0) {
            if (ended_at == 0 && input_ended()) ended_at = now_ns();
            const bool late = ended_at != 0 && now_ns() - ended_at > longest_wait_ns;
            if (late || (ended_at != 0 && quiet >= (sink.complete(ports) ? 1 : quiet_ticks))) break;
        }
        if (count > 0 && rest_us != 0) ::usleep(rest_us);
    }
    ::close(epoll);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 8) {
        fmt::print(stderr, "usage: route_sink SOCKET,... FLIGHT.tlog SYSTEMS COMPONENTS FRAMES fan|mesh REST_US\n");
        return 2;
    }
    const auto fds = mavloom::bench::numbers_in(argv[1]);
    const bool mesh = std::string_view(argv[6]) == "mesh";
    const auto traffic = Traffic::load(argv[2], static_cast<unsigned>(std::atoi(argv[3])),
                                       static_cast<unsigned>(std::atoi(argv[4])),
                                       mesh ? static_cast<unsigned>(fds.size()) : 1);
    if (!traffic || fds.empty()) return 1;
    const auto frames = std::strtoull(argv[5], nullptr, 10);
    std::vector<Port> ports;
    for (const int fd : fds) ports.emplace_back(fd, frames);
    Sink sink(*traffic, frames, mesh);
    fmt::print("ready\n");
    std::fflush(stdout);
    receive(sink, ports, static_cast<useconds_t>(std::atoi(argv[7])));
    sink.print(ports);
}
