// SPDX-License-Identifier: MIT
// An attacker for tests/system/route/test_hostile.py and bench/hostile.py: sends heartbeats from invented addresses.
//   flood_tool HOST PORT RATE SECONDS [IDS] [ADDRESSES] [refuse]
// Every datagram is a HEARTBEAT from another address of HOST's /8 network, RATE a second. IDS is how many system and
// component ids it uses (default 1). ADDRESSES is how many addresses it uses in turn (default: 16 million). With
// `refuse`, answers find a closed port. Prints how many datagrams it sent. Works on loopback without privileges,
// because all of 127.0.0.0/8 belongs to this machine. Another network needs `ip route add local 10.0.0.0/8 dev lo`.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>
#include <vector>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace {

using namespace mavloom;
using Clock = std::chrono::steady_clock;

constexpr std::size_t batch = 64;

struct Datagram {
    std::array<std::uint8_t, 32> bytes{};
    std::size_t size = 0;
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in_pktinfo))> control{};
    iovec part{};
};

class Flood {
public:
    Flood(const char* host, std::uint16_t port, unsigned ids, unsigned addresses) : ids_(ids), addresses_(addresses) {
        to_.sin_family = AF_INET;
        to_.sin_port = htons(port);
        if (inet_pton(AF_INET, host, &to_.sin_addr) != 1) std::exit(2);
        for (std::size_t i = 0; i < batch; ++i) prepare(i);
    }

    // A connected socket takes datagrams from its far side only, which is not the router: answers are refused.
    void refuse_answers(int fd) const {
        sockaddr_in elsewhere = to_;
        elsewhere.sin_port = htons(9);
        if (::connect(fd, reinterpret_cast<const sockaddr*>(&elsewhere), sizeof elsewhere) != 0) std::exit(1);
    }

    // Sends `count` datagrams, at most a batch; returns how many the kernel took.
    std::size_t send(int fd, std::size_t count) {
        for (std::size_t i = 0; i < count; ++i) renew(datagrams_[i]);
        const int sent = ::sendmmsg(fd, headers_.data(), static_cast<unsigned>(count), 0);
        return sent < 0 ? 0 : static_cast<std::size_t>(sent);
    }

private:
    void prepare(std::size_t i) {
        Datagram& datagram = datagrams_[i];
        datagram.part.iov_base = datagram.bytes.data();
        msghdr& header = headers_[i].msg_hdr;
        header = {};
        header.msg_name = &to_;
        header.msg_namelen = sizeof to_;
        header.msg_iov = &datagram.part;
        header.msg_iovlen = 1;
        header.msg_control = datagram.control.data();
        header.msg_controllen = datagram.control.size();
        cmsghdr* const control = CMSG_FIRSTHDR(&header);
        control->cmsg_level = IPPROTO_IP;
        control->cmsg_type = IP_PKTINFO;
        control->cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
    }

    // Another address, another id.
    void renew(Datagram& datagram) {
        ++count_;
        in_pktinfo info{};
        info.ipi_spec_dst.s_addr = htonl((ntohl(to_.sin_addr.s_addr) & 0xff000000u) + 0x00010000u + count_ % addresses_);
        std::memcpy(CMSG_DATA(reinterpret_cast<cmsghdr*>(datagram.control.data())), &info, sizeof info);
        const unsigned id = count_ % ids_;
        msg::Heartbeat beat;
        beat.custom_mode = count_;
        beat.mavlink_version = 3;
        std::array<std::uint8_t, msg::Heartbeat::max_length> payload{};
        (void)beat.encode(payload);
        wire::FrameBuffer buffer;
        const auto frame = wire::write_frame(buffer,
                                             {.sequence = static_cast<std::uint8_t>(count_),
                                              .source = {SystemId{static_cast<std::uint8_t>(10 + id / 40 % 200)},
                                                         ComponentId{static_cast<std::uint8_t>(1 + id % 40)}}},
                                             *dialect::default_dialect().wire_table().find(msg::Heartbeat::id), payload);
        std::memcpy(datagram.bytes.data(), frame.bytes().data(), frame.size());
        datagram.part.iov_len = frame.size();
    }

    unsigned ids_, addresses_;
    std::uint32_t count_ = 0;
    sockaddr_in to_{};
    std::array<Datagram, batch> datagrams_{};
    std::array<mmsghdr, batch> headers_{};
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 5) {
        fmt::print(stderr, "usage: flood_tool HOST PORT RATE SECONDS [IDS] [ADDRESSES] [refuse]\n");
        return 2;
    }
    const double rate = std::atof(argv[3]), seconds = std::atof(argv[4]);
    Flood flood(argv[1], static_cast<std::uint16_t>(std::atoi(argv[2])),
                argc > 5 ? static_cast<unsigned>(std::atoi(argv[5])) : 1u,
                argc > 6 ? static_cast<unsigned>(std::atoi(argv[6])) : 0x00fe0000u);
    const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
    if (argc > 7) flood.refuse_answers(fd);
    const auto start = Clock::now();
    std::size_t sent = 0;
    for (;;) {
        const double passed = std::chrono::duration<double>(Clock::now() - start).count();
        if (passed >= seconds) break;
        const auto due = static_cast<std::size_t>(passed * rate);
        if (due > sent) sent += flood.send(fd, std::min(due - sent, batch));
        else std::this_thread::sleep_for(std::chrono::microseconds{200});
    }
    fmt::print("{}\n", sent);
}
