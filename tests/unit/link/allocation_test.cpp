// SPDX-License-Identifier: MIT
// Counts operator new: in steady state the way of a frame from socket to parser to queue to socket must not allocate.
#include <sys/un.h>

#include "support/count_allocations.hpp"
#include "support/temp_dir.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;

struct Forwarder : LinkHandler {
    void on_frame(const RxFrame& rx) override {
        ++frames;
        links->send(out, rx.frame);
        links->send(rx.link, rx.frame);
    }
    Links* links = nullptr;
    EndpointId out;
    std::size_t frames = 0;
};

std::size_t allocations_of(Node& node, Forwarder& forwarder, const std::function<void()>& send_burst,
                           std::size_t frames) {
    const std::size_t before = test::allocations;
    const std::size_t wanted = forwarder.frames + frames;
    const MonoTime deadline = mono_now() + std::chrono::seconds(60);
    send_burst();
    const std::size_t by_sender = test::allocations - before;
    while (forwarder.frames < wanted && mono_now() < deadline)
        node.links->turn(forwarder, mono_now() + std::chrono::milliseconds(1));
    EXPECT_EQ(forwarder.frames, wanted);
    return test::allocations - before - by_sender;
}

TEST(LinksAllocation, UdpInSteadyStateAllocatesNothing) {
    Node node;
    Forwarder forwarder;
    const auto far = PlainSocket::udp(), a = PlainSocket::udp(), b = PlainSocket::udp();
    const auto in = node.add("udpin://127.0.0.1:0");
    forwarder.links = node.links.get();
    forwarder.out = node.add(fmt::format("udpout://127.0.0.1:{}", far.port()));
    std::uint8_t sequence = 0;
    const auto burst = [&] {
        for (int i = 0; i < 50; ++i, ++sequence) {
            a.send_to(node.port(in), attitude(sequence) + heartbeat(sequence));
            b.send_to(node.port(in), attitude(sequence));
        }
    };
    for (int i = 0; i < 3; ++i) (void)allocations_of(node, forwarder, burst, 150);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(allocations_of(node, forwarder, burst, 150), 0u);
}

TEST(LinksAllocation, TcpInSteadyStateAllocatesNothing) {
    Node node;
    Forwarder forwarder;
    const auto in = node.add("tcpin://127.0.0.1:0");
    forwarder.links = node.links.get();
    forwarder.out = in;
    const auto client = PlainSocket::connected_tcp(node.port(in));
    std::uint8_t sequence = 0;
    const auto burst = [&] {
        for (int i = 0; i < 50; ++i) client.write(attitude(sequence++));
        (void)client.read();
    };
    for (int i = 0; i < 3; ++i) (void)allocations_of(node, forwarder, burst, 50);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(allocations_of(node, forwarder, burst, 50), 0u);
}

TEST(LinksAllocation, TheInletInSteadyStateAllocatesNothing) {
    const test::TempDir dir;
    Node node;
    Forwarder forwarder;
    const auto far = PlainSocket::udp();
    forwarder.links = node.links.get();
    forwarder.out = node.add(fmt::format("udpout://127.0.0.1:{}", far.port()));
    ASSERT_TRUE(node.links->add_inlet("ring", dir / "ring.in", 0600));
    sockaddr_un inlet{};
    inlet.sun_family = AF_UNIX;
    (dir / "ring.in").string().copy(inlet.sun_path, sizeof inlet.sun_path - 1);
    const int a = ::socket(AF_UNIX, SOCK_DGRAM, 0), b = ::socket(AF_UNIX, SOCK_DGRAM, 0);
    const sa_family_t by_itself = AF_UNIX;  // an abstract address of the kernel's choice
    ASSERT_EQ(::bind(a, reinterpret_cast<const sockaddr*>(&by_itself), sizeof by_itself), 0);
    std::uint8_t sequence = 0;
    const auto burst = [&] {
        for (int i = 0; i < 4; ++i, ++sequence)
            for (const int fd : {a, b}) {
                const Bytes frame = attitude(sequence, fd == a ? 1 : 2);
                EXPECT_EQ(::sendto(fd, frame.data(), frame.size(), MSG_DONTWAIT,
                                   reinterpret_cast<const sockaddr*>(&inlet), sizeof inlet),
                          static_cast<ssize_t>(frame.size()));
            }
    };
    for (int i = 0; i < 3; ++i) (void)allocations_of(node, forwarder, burst, 8);
    for (int i = 0; i < 20; ++i) EXPECT_EQ(allocations_of(node, forwarder, burst, 8), 0u);
    ::close(a);
    ::close(b);
}

}  // namespace
}  // namespace mavloom::link
