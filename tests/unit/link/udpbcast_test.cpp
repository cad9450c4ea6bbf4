// SPDX-License-Identifier: MIT
// Over 127.255.255.255, which the loopback interface carries as a network's broadcast address.
#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::SizeIs;

struct LinksUdpBroadcast : ::testing::Test {
    // A socket that hears broadcasts: those to 0.0.0.0 do.
    struct Listener {
        Listener() {
            sockaddr_in any{};
            any.sin_family = AF_INET;
            EXPECT_EQ(::bind(fd, reinterpret_cast<sockaddr*>(&any), sizeof any), 0);
            socklen_t length = sizeof any;
            getsockname(fd, reinterpret_cast<sockaddr*>(&any), &length);
            port = ntohs(any.sin_port);
        }
        ~Listener() { ::close(fd); }
        [[nodiscard]] Bytes read() {
            Bytes bytes(65536);
            socklen_t length = sizeof from;
            const ssize_t count = ::recvfrom(fd, bytes.data(), bytes.size(), MSG_DONTWAIT,
                                             reinterpret_cast<sockaddr*>(&from), &length);
            bytes.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
            return bytes;
        }
        int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
        std::uint16_t port = 0;
        sockaddr_in from{};
    };
    EndpointId add(const std::string& options = "") {
        return node.add(fmt::format("udpbcast://127.255.255.255:{}{}", listener.port, options));
    }
    // True when the listener gets this frame, sent by broadcast.
    bool hears(EndpointId id, const Bytes& frame) {
        EXPECT_EQ(node.links->send(id, view(frame)), 1u);
        return until([&] { return listener.read() == frame; }, node);
    }

    Listener listener;
    Node node;
};

TEST_F(LinksUdpBroadcast, BroadcastsFromAnEphemeralPort) {
    const auto out = add();
    ASSERT_TRUE(hears(out, heartbeat(0)));
    EXPECT_EQ(ntohs(listener.from.sin_port), node.port(out));
    EXPECT_NE(node.port(out), listener.port);
    ASSERT_THAT(node.recorder.ups, SizeIs(1));
    EXPECT_EQ(node.recorder.ups[0].second, fmt::format("udpbcast://127.255.255.255:{}", listener.port));
}

// Two programs on two machines broadcast from the same port.
TEST_F(LinksUdpBroadcast, SomebodyElseWithTheSamePortIsHeard) {
    const std::uint16_t port = PlainSocket::udp().port();
    add(fmt::format("?bind=127.0.0.1:{}", port));
    const PlainSocket other(SOCK_DGRAM, port, INADDR_LOOPBACK + 1);
    other.send_to(port, heartbeat(1));
    EXPECT_TRUE(until([&] { return node.recorder.bytes() == heartbeat(1); }, node));
}

TEST_F(LinksUdpBroadcast, WhoAnswersIsFedAlone) {
    const auto out = add();
    ASSERT_TRUE(hears(out, heartbeat(0)));
    const auto answering = PlainSocket::udp();
    answering.send_to(node.port(out), heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    ASSERT_THAT(node.recorder.downs, SizeIs(1));
    EXPECT_THAT(node.recorder.downs[0].second, HasSubstr(fmt::format("127.0.0.1:{} answers", answering.port())));
    EXPECT_EQ(node.links->send(out, view(heartbeat(2))), 1u);
    ASSERT_TRUE(until([&] { return answering.read() == heartbeat(2); }, node));
    EXPECT_EQ(listener.read(), Bytes{});
}

TEST_F(LinksUdpBroadcast, EachWhoAnswersIsALink) {
    const auto out = add();
    node.poll();
    const auto a = PlainSocket::udp(), b = PlainSocket::udp();
    a.send_to(node.port(out), heartbeat(1, 7));
    b.send_to(node.port(out), heartbeat(2, 8));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 2; }, node));
    EXPECT_NE(node.recorder.frames[0].link, node.recorder.frames[1].link);
    EXPECT_EQ(node.links->send(out, view(heartbeat(2))), 2u);
    ASSERT_TRUE(until([&] { return a.read() == heartbeat(2); }, node));
    ASSERT_TRUE(until([&] { return b.read() == heartbeat(2); }, node));
}

TEST_F(LinksUdpBroadcast, BroadcastsAgainWhenTheLastIsIdle) {
    const auto out = add("?idle=100ms");
    node.poll();
    PlainSocket::udp().send_to(node.port(out), heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 3; }, node));
    EXPECT_EQ(node.recorder.ups[2].first, node.recorder.ups[0].first);
    EXPECT_TRUE(hears(out, heartbeat(5)));
}

TEST_F(LinksUdpBroadcast, JunkIsNoAnswer) {
    const auto out = add();
    PlainSocket::udp().send_to(node.port(out), Bytes(50, 0x55));
    ASSERT_TRUE(until([&] { return node.info(out).counters->stray_bytes.value() == 50; }, node));
    EXPECT_TRUE(hears(out, heartbeat(0)));
}

TEST_F(LinksUdpBroadcast, FixedContinuesBroadcasting) {
    const auto out = add("?fixed=true");
    node.poll();
    const auto answering = PlainSocket::udp();
    answering.send_to(node.port(out), heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    EXPECT_EQ(node.recorder.frames[0].link, node.recorder.ups.at(0).first);
    EXPECT_TRUE(hears(out, heartbeat(2)));
    EXPECT_EQ(answering.read(), Bytes{});
    EXPECT_THAT(node.links->links(), SizeIs(1));
}

TEST_F(LinksUdpBroadcast, WhatItSentItselfIsNoAnswer) {
    std::uint16_t port;
    { port = Listener().port; }
    const auto out = node.add(fmt::format("udpbcast://127.255.255.255:{0}?bind=0.0.0.0:{0}", port));
    EXPECT_EQ(node.links->send(out, view(heartbeat(0))), 1u);
    const auto answering = PlainSocket::udp();
    node.poll();
    answering.send_to(port, heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    EXPECT_EQ(node.recorder.bytes(), heartbeat(1));
}

TEST_F(LinksUdpBroadcast, AnInterfaceThatIsNotThereIsAwaited) {
    node.add("udpbcast://127.255.255.255:14550?iface=no-such-one");
    ASSERT_TRUE(until([&] { return !node.recorder.notices.empty(); }, node));
    EXPECT_THAT(node.recorder.notices[0], HasSubstr("no-such-one"));
    const std::string required = "udpbcast://127.255.255.255:14551?iface=no-such-one&required=true";
    node.add(required);  // counts at the start only
    EXPECT_EQ(Node().refused(required).code, SetupCode::not_found);
}

}  // namespace
}  // namespace mavloom::link
