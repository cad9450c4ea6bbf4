// SPDX-License-Identifier: MIT
// Generates the load of `bench route`: sends numbered frames through sockets that bench/route.py has connected to the
// router. Every TICK_US microseconds it sends the frames that are due, in batches by sendmmsg. Absolute deadlines keep
// the rate: no frame is early, and none is left out. Prints what it sent.
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>

#include "traffic.hpp"

namespace {

using mavloom::bench::max_frame_bytes;
using mavloom::bench::now_ns;
using mavloom::bench::Traffic;

constexpr std::size_t batch = 64, max_per_datagram = 16;

void sleep_until(std::uint64_t at_ns) {
    const timespec t{static_cast<time_t>(at_ns / 1'000'000'000u), static_cast<long>(at_ns % 1'000'000'000u)};
    while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {}
}

// Waits if the send buffer is full, because the load must not lose frames itself.
void send_all(int fd, mmsghdr* messages, std::size_t count) {
    while (count != 0) {
        const int sent = ::sendmmsg(fd, messages, static_cast<unsigned>(count), 0);
        if (sent > 0) {
            messages += sent;
            count -= static_cast<std::size_t>(sent);
        } else if (errno != ENOBUFS && errno != EAGAIN && errno != EINTR && errno != ECONNREFUSED) {
            return;
        }
    }
}

class Sender {
public:
    Sender(const Traffic& traffic, std::vector<int> fds, std::size_t per_datagram)
        : traffic_(traffic), fds_(std::move(fds)), per_datagram_(per_datagram) {
        for (std::size_t i = 0; i < batch; ++i) {
            messages_[i].msg_hdr.msg_iov = &datagrams_[i];
            messages_[i].msg_hdr.msg_iovlen = 1;
        }
    }

    // Sends the frames [from, to). Consecutive frames of one link go out in one call.
    void send(std::uint64_t from, std::uint64_t to) {
        while (from < to) {
            const unsigned link = traffic_.link_of(from);
            std::size_t count = 0;
            for (; count < batch && from < to && traffic_.link_of(from) == link; ++count) {
                const auto end = std::min(to, from + per_datagram_);
                datagrams_[count] = {memory_[count].data(), write(memory_[count], from, end)};
                from = end;
            }
            send_all(fds_[link], messages_.data(), count);
            datagrams_sent_ += count;
        }
    }
    [[nodiscard]] std::uint64_t datagrams_sent() const { return datagrams_sent_; }

private:
    using Memory = std::array<std::uint8_t, max_per_datagram * max_frame_bytes>;

    std::size_t write(Memory& memory, std::uint64_t from, std::uint64_t end) const {
        const std::uint64_t time_ns = now_ns();
        std::size_t size = 0;
        for (; from < end; ++from)
            size += traffic_.write(std::span<std::uint8_t, max_frame_bytes>(memory.data() + size, max_frame_bytes),
                                   from, time_ns);
        return size;
    }

    const Traffic& traffic_;
    std::vector<int> fds_;
    std::size_t per_datagram_;
    std::uint64_t datagrams_sent_ = 0;
    std::array<Memory, batch> memory_{};
    std::array<iovec, batch> datagrams_{};
    std::array<mmsghdr, batch> messages_{};
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 9) {
        fmt::print(stderr,
                   "usage: route_generator SOCKET,... FLIGHT.tlog SYSTEMS COMPONENTS FRAMES_PER_SECOND FRAMES "
                   "FRAMES_PER_DATAGRAM TICK_US\n");
        return 2;
    }
    auto fds = mavloom::bench::numbers_in(argv[1]);
    const auto traffic = Traffic::load(argv[2], static_cast<unsigned>(std::atoi(argv[3])),
                                       static_cast<unsigned>(std::atoi(argv[4])), static_cast<unsigned>(fds.size()));
    const double rate = std::atof(argv[5]);
    const auto total = std::strtoull(argv[6], nullptr, 10), tick_ns = 1000 * std::strtoull(argv[8], nullptr, 10);
    const auto per_datagram = static_cast<std::size_t>(std::atoi(argv[7]));
    if (!traffic || rate <= 0 || tick_ns == 0 || per_datagram == 0 || per_datagram > max_per_datagram) return 1;
    if (fds.size() > 1 && per_datagram > 1) return 1;  // consecutive frames belong to different links

    Sender sender(*traffic, std::move(fds), per_datagram);
    const std::uint64_t begin = now_ns();
    std::uint64_t sent = 0, latest = 0;
    for (std::uint64_t tick = 1; sent < total; ++tick) {
        const std::uint64_t deadline = begin + tick * tick_ns;
        sleep_until(deadline);
        auto due = std::min<std::uint64_t>(
            total, static_cast<std::uint64_t>(rate * static_cast<double>(tick * tick_ns) / 1e9));
        if (due != total) due -= due % per_datagram;
        sender.send(sent, std::max(due, sent));
        sent = std::max(due, sent);
        latest = std::max(latest, now_ns() - deadline);
    }
    const double took = static_cast<double>(now_ns() - begin) / 1e9;
    fmt::print("{{\"frames\":{},\"datagrams\":{},\"seconds\":{:.4f},\"rate\":{:.0f},\"latest_us\":{:.1f}}}\n", sent,
               sender.datagrams_sent(), took, static_cast<double>(sent) / took, static_cast<double>(latest) / 1e3);
}
