// SPDX-License-Identifier: MIT
#include "unit/runtime/links_fixture.hpp"

namespace mavloom::runtime {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string to(std::string_view scheme, std::uint16_t port, std::string_view query = "") {
    return fmt::format("{}://127.0.0.1:{}{}", scheme, port, query);
}

TEST(LinksUdp, EveryPeerThatSendsAFrameIsALinkAndGetsItsAnswer) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    node.recorder.answer = [&](const RxFrame& rx) { EXPECT_EQ(node.links->send(rx.link, rx.frame), 1u); };
    const auto a = PlainSocket::udp(), b = PlainSocket::udp();
    a.send_to(node.port(in), heartbeat(1));
    b.send_to(node.port(in), heartbeat(2));
    Bytes got_a, got_b;
    ASSERT_TRUE(until(
        [&] {
            got_a = std::move(got_a) + a.read();
            got_b = std::move(got_b) + b.read();
            return !got_a.empty() && !got_b.empty();
        },
        node));
    EXPECT_EQ(got_a, heartbeat(1));
    EXPECT_EQ(got_b, heartbeat(2));
    ASSERT_THAT(node.recorder.ups, SizeIs(2));
    EXPECT_THAT(node.recorder.ups, Contains(::testing::Field(&std::pair<LinkId, std::string>::second,
                                                             fmt::format("udpin://127.0.0.1:0#127.0.0.1:{}", a.port()))));
}

TEST(LinksUdp, ReceiveTimesAreTheKernels) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto peer = PlainSocket::udp();
    peer.send_to(node.port(in), heartbeat(0));  // the first use of time stamps is switched on late by the kernel
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    const WallTime before = wall_now();
    peer.send_to(node.port(in), heartbeat(1));
    const WallTime after = wall_now();
    usleep(2000);
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 2; }, node));
    EXPECT_GE(node.recorder.frames[1].time, before);
    EXPECT_LE(node.recorder.frames[1].time, after);
}

TEST(LinksUdp, AllFiveFramesOfADatagramArriveInOrder) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const Bytes datagram = heartbeat(0) + attitude(1) + frame_bytes(131, 2) + attitude(3) + heartbeat(4);
    PlainSocket::udp().send_to(node.port(in), datagram);
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 5; }, node));
    EXPECT_EQ(node.recorder.bytes(), datagram);
}

TEST(LinksUdp, HalfAFrameHarmsNobodyElse) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto good = PlainSocket::udp(), bad = PlainSocket::udp();
    bad.send_to(node.port(in), heartbeat(0));
    good.send_to(node.port(in), heartbeat(0));
    Bytes half = attitude(1);
    half.resize(20);
    bad.send_to(node.port(in), half);
    good.send_to(node.port(in), attitude(1));
    bad.send_to(node.port(in), attitude(1));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 4; }, node));
    EXPECT_THAT(node.links->links(), SizeIs(2));
    EXPECT_EQ(node.counters(node.recorder.frames[0].link).junk_bytes.value(), 20u);
    EXPECT_EQ(node.counters(node.recorder.frames[1].link).junk_bytes.value(), 0u);
}

TEST(LinksUdp, GarbageOfAStrangerMakesNoPeer) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto stranger = PlainSocket::udp();
    Bytes damaged = attitude(0);
    damaged[15] ^= 1;
    stranger.send_to(node.port(in), Bytes(100, 0xfd));
    stranger.send_to(node.port(in), damaged);
    ASSERT_TRUE(until([&] { return node.info(in).counters->stray_bytes.value() == 100 + damaged.size(); }, node));
    EXPECT_THAT(node.links->links(), SizeIs(0));
    EXPECT_THAT(node.recorder.ups, SizeIs(0));
}

TEST(LinksUdp, FramesOfOneTurnShareDatagramsUpToTheMtu) {
    Node node;
    const auto far = PlainSocket::udp();
    const auto out = node.add(to("udpout", far.port(), "?mtu=280"));
    Bytes all;
    for (std::uint8_t i = 0; i < 10; ++i) {
        EXPECT_EQ(node.links->send(out, view(attitude(i))), 1u);
        all = std::move(all) + attitude(i);
    }
    const auto eighth = all.begin() + 7 * 40;
    EXPECT_TRUE(node.links->pending());
    node.poll();
    EXPECT_FALSE(node.links->pending());
    EXPECT_EQ(far.read(), Bytes(all.begin(), eighth));
    EXPECT_EQ(far.read(), Bytes(eighth, all.end()));
    EXPECT_EQ(node.links->links().at(0).counters->frames_out.value(), 10u);
    EXPECT_EQ(node.links->links().at(0).counters->bytes_out.value(), 400u);
}

TEST(LinksUdp, MtuZeroKeepsOneFrameADatagram) {
    Node node;
    const auto far = PlainSocket::udp();
    const auto out = node.add(to("udpout", far.port(), "?mtu=0"));
    for (std::uint8_t i = 0; i < 3; ++i) EXPECT_EQ(node.links->send(out, view(attitude(i))), 1u);
    node.poll();
    for (std::uint8_t i = 0; i < 3; ++i) EXPECT_EQ(far.read(), attitude(i));
}

TEST(LinksUdp, UdpoutHearsItsFarSideAndCountsOthers) {
    Node node;
    const auto far = PlainSocket::udp(), stranger = PlainSocket::udp();
    const auto out = node.add(to("udpout", far.port()));
    stranger.send_to(node.port(out), heartbeat(0));
    far.send_to(node.port(out), heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    EXPECT_EQ(node.recorder.bytes(), heartbeat(1));
    EXPECT_EQ(node.info(out).counters->wrong_peer.value(), 1u);
}

}  // namespace
}  // namespace mavloom::runtime
