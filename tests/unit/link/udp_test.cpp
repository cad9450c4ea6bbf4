// SPDX-License-Identifier: MIT
#include "mavloom/net/udp.hpp"
#include "link/core/coalescing.hpp"
#include "mavloom/net/resolver.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
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
    EXPECT_THAT(node.recorder.ups,
                Contains(::testing::Field(&std::pair<LinkId, std::string>::second,
                                          fmt::format("udpin://127.0.0.1:{}#127.0.0.1:{}", node.port(in), a.port()))));
}

TEST(LinksUdp, ReceiveTimesAreTheKernels) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto peer = PlainSocket::udp();
    // The kernel switches time stamps on some time after the first socket asked; until then it stamps when the datagram
    // is read.
    bool stamped_on_arrival = false;
    const MonoTime deadline = mono_now() + std::chrono::seconds(60);
    for (std::uint8_t i = 0; !stamped_on_arrival && mono_now() < deadline; ++i) {
        node.recorder.frames.clear();
        const WallTime before = wall_now();
        peer.send_to(node.port(in), heartbeat(i));
        const WallTime after = wall_now();
        usleep(2000);
        ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
        EXPECT_GE(node.recorder.frames[0].time, before);
        stamped_on_arrival = node.recorder.frames[0].time <= after;
    }
    EXPECT_TRUE(stamped_on_arrival);
}

TEST(LinksUdp, AllFiveFramesOfADatagramArriveInOrder) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const Bytes datagram = heartbeat(0) + attitude(1) + frame_bytes(131, 2) + attitude(3) + heartbeat(4);
    PlainSocket::udp().send_to(node.port(in), datagram);
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 5; }, node));
    EXPECT_EQ(node.recorder.bytes(), datagram);
}

// RFC 791 and 768: 1500 bytes less 20 of IPv4 and 8 of UDP.
TEST(LinksUdp, DatagramsThatEthernetSplitsAreCounted) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto peer = PlainSocket::udp();
    for (const std::size_t size : {1472, 1473, 3000}) {
        Bytes datagram = heartbeat(0);
        datagram.resize(size);
        peer.send_to(node.port(in), datagram);
    }
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 3; }, node));
    EXPECT_EQ(node.info(in).counters->long_datagrams.value(), 2u);
}

TEST(LinksUdp, ARushIsTakenWholeAndInOrder) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto peer = PlainSocket::udp();
    const MonoTime end = mono_now() + 5 * detail::Coalescing::window;
    Bytes sent;
    std::uint8_t sequence = 0;
    std::size_t frames = 0;
    while (mono_now() < end || frames < 10 * net::ReceiveBatch::slots) {
        for (std::size_t i = 0; i < net::ReceiveBatch::slots + 1; ++i, ++frames) {
            const Bytes frame = heartbeat(sequence++);
            sent.insert(sent.end(), frame.begin(), frame.end());
            peer.send_to(node.port(in), frame);
        }
        for (const int turn : {1, 2})  // the first leaves one
            node.links->turn(node.recorder, mono_now() + std::chrono::milliseconds(turn));
    }
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == frames; }, node));
    Bytes got;
    for (const auto& heard : node.recorder.frames) got.insert(got.end(), heard.bytes.begin(), heard.bytes.end());
    EXPECT_EQ(got, sent);
    EXPECT_EQ(node.info(in).counters->kernel_drop.value(), 0u);
}

// The usual time from turn to turn in a rush, after 30 ms of it. A median, because a busy machine takes the processor
// away between some turns.
Nanoseconds usual_turn_in_a_rush(Node& node, std::uint16_t port) {
    const auto peer = PlainSocket::udp();
    Bytes datagram;  // more than a frame every 20 us, though each turn rests and oversleeps
    for (std::uint8_t i = 0; i < 24; ++i) datagram = std::move(datagram) + heartbeat(i);
    std::vector<Nanoseconds> times;
    const MonoTime begin = mono_now();
    for (MonoTime now = begin; now < begin + std::chrono::milliseconds(50);) {
        peer.send_to(port, datagram);
        node.links->turn(node.recorder, now + std::chrono::milliseconds(1));
        node.recorder.frames.clear();
        const MonoTime before = std::exchange(now, mono_now());
        if (before > begin + std::chrono::milliseconds(30)) times.push_back(now - before);
    }
    if (times.empty()) return Nanoseconds::max();
    std::ranges::nth_element(times, times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2));
    return times[times.size() / 2];
}

TEST(LinksUdp, LowLatencyKeepsTurnsFromResting) {
    Node node;
    const auto port = node.port(node.add("udpin://127.0.0.1:0"));
    const auto rests = [&] { return usual_turn_in_a_rush(node, port) > detail::Coalescing::turn_interval * 3 / 4; };

    EXPECT_TRUE(until([&] { return rests(); }, node));
    const auto low = node.add("udpin://127.0.0.1:0?low_latency=true");
    EXPECT_TRUE(until([&] { return !rests(); }, node));
    node.links->remove(low);
    EXPECT_TRUE(until([&] { return rests(); }, node));
}

// Answers a link that goes down with a frame to its endpoint, which Links allows.
class LateSender : public Recorder {
public:
    explicit LateSender(Links& links) : links_(links) {}
    void on_link_down(LinkId id, EndpointId endpoint, std::string_view why) override {
        Recorder::on_link_down(id, endpoint, why);
        taken += links_.send(endpoint, view(frame_));
    }
    std::size_t taken = 0;

private:
    Links& links_;
    const Bytes frame_ = heartbeat(7);
};

TEST(LinksUdp, APeerThatGoesDownTakesNoMoreFrames) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0?idle=50ms");
    LateSender handler(*node.links);
    const auto peer = PlainSocket::udp();
    peer.send_to(node.port(in), heartbeat(0));
    const MonoTime end = mono_now() + std::chrono::seconds(60);
    while (handler.downs.empty() && mono_now() < end)
        node.links->turn(handler, mono_now() + std::chrono::milliseconds(1));
    ASSERT_EQ(handler.downs.size(), 1u);

    for (int turn = 0; turn < 3; ++turn) node.links->turn(handler, mono_now());  // the peer's memory is free by now
    EXPECT_EQ(handler.taken, 0u);
    EXPECT_EQ(peer.read(), Bytes{});
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

// A UDP datagram over loopback whose source port is free to choose. Without the right to make one, returns false.
bool send_forged(std::uint16_t from_port, std::uint16_t to_port, const Bytes& payload) {
    const int fd = ::socket(AF_INET, SOCK_RAW, IPPROTO_UDP);
    if (fd < 0) return false;
    Bytes datagram;
    const auto put = [&](std::size_t value) {
        datagram.push_back(static_cast<std::uint8_t>(value >> 8));
        datagram.push_back(static_cast<std::uint8_t>(value));
    };
    for (const std::size_t value : {std::size_t{from_port}, std::size_t{to_port}, 8 + payload.size(), std::size_t{0}})
        put(value);
    datagram = std::move(datagram) + payload;
    sockaddr_in to = PlainSocket::loopback(0);
    const ssize_t sent = ::sendto(fd, datagram.data(), datagram.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
    ::close(fd);
    return sent == static_cast<ssize_t>(datagram.size());
}

TEST(LinksUdp, ASourceThatCanBeNoPeerIsRefused) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const std::uint16_t own = node.port(in);
    if (!send_forged(own, own, heartbeat(1))) GTEST_SKIP() << "no right to forge";
    ASSERT_TRUE(send_forged(0, own, heartbeat(2)));
    ASSERT_TRUE(until([&] { return node.info(in).counters->bad_source.value() == 2; }, node));
    EXPECT_TRUE(node.recorder.ups.empty());

    ASSERT_TRUE(send_forged(static_cast<std::uint16_t>(own ^ 1), own, heartbeat(3)));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    EXPECT_EQ(node.recorder.bytes(), heartbeat(3));
}

// Such a peer would send each frame round the process for ever.
TEST(LinksUdp, ADatagramFromAnotherEndpointsPortIsRefused) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0"), other = node.add("udpin://127.0.0.1:0");
    if (!send_forged(node.port(other), node.port(in), heartbeat(1))) GTEST_SKIP() << "no right to forge";

    ASSERT_TRUE(until([&] { return node.info(in).counters->bad_source.value() == 1; }, node));
    EXPECT_TRUE(node.recorder.ups.empty());
}

// 300 bytes without a frame are enough to refuse a stranger.
TEST(LinksUdp, AStrangersFrameBehindMuchJunkMakesNoPeer) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto stranger = PlainSocket::udp();
    Bytes datagram(300, 0xfd);
    const Bytes frame = heartbeat(1);
    datagram.insert(datagram.end(), frame.begin(), frame.end());

    stranger.send_to(node.port(in), datagram);

    ASSERT_TRUE(until([&] { return node.info(in).counters->stray_bytes.value() == datagram.size(); }, node));
    EXPECT_TRUE(node.recorder.ups.empty());
}

TEST(LinksUdp, TheLongestIdleOfThreeHundredPeersGoFirst) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    std::vector<PlainSocket> peers;
    for (std::size_t i = 0; i < 300; ++i) {
        peers.push_back(PlainSocket::udp());
        peers[i].send_to(node.port(in), heartbeat(0));
        ASSERT_TRUE(until([&] { return node.recorder.frames.size() == i + 1; }, node));
    }
    EXPECT_THAT(node.links->links(), SizeIs(256));
    EXPECT_EQ(node.info(in).counters->peers_evicted.value(), 44u);
    ASSERT_THAT(node.recorder.downs, SizeIs(44));
    for (std::size_t i = 0; i < 44; ++i) EXPECT_EQ(node.recorder.downs[i].first, node.recorder.ups[i].first);
    EXPECT_EQ(node.links->send(in, view(heartbeat(1))), 256u);
    node.poll();
    EXPECT_EQ(peers[43].read(), Bytes{});
    EXPECT_EQ(peers[44].read(), heartbeat(1));
    EXPECT_EQ(peers[299].read(), heartbeat(1));
}

TEST(LinksUdp, AFloodOfStrangersDoesNotPushOutActivePeers) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0?max_peers=2");
    const auto a = PlainSocket::udp(), b = PlainSocket::udp();
    for (std::uint8_t i = 0; i < 2; ++i) {
        a.send_to(node.port(in), heartbeat(i));
        b.send_to(node.port(in), heartbeat(i));
    }
    for (int i = 0; i < 50; ++i) PlainSocket::udp().send_to(node.port(in), heartbeat(0));
    ASSERT_TRUE(until([&] { return node.info(in).counters->peers_refused.value() == 50; }, node));
    EXPECT_THAT(node.recorder.downs, SizeIs(0));
    EXPECT_THAT(node.links->links(), SizeIs(2));
}

// All peers talk; a newcomer sends twice.
class LinksUdpFull : public ::testing::Test {
protected:
    bool newcomer_enters(int max_peers) {
        const auto in = node.add(fmt::format("udpin://127.0.0.1:0?max_peers={}", max_peers));
        for (int i = 0; i < max_peers; ++i) talkers.push_back(PlainSocket::udp());
        const auto newcomer = PlainSocket::udp();
        const auto all_talk = [&] {
            for (const auto& talker : talkers) talker.send_to(node.port(in), heartbeat(0));
        };
        const auto& counters = *node.info(in).counters;
        const auto newcomer_sends = [&](std::uint64_t answers) {
            newcomer.send_to(node.port(in), heartbeat(1));
            const auto seen = [&] { return counters.peers_displaced.value() + counters.peers_refused.value(); };
            EXPECT_TRUE(until([&] { return seen() == answers; }, node));
        };
        all_talk();
        all_talk();
        newcomer_sends(1);
        std::this_thread::sleep_for(std::chrono::milliseconds{600});
        all_talk();
        newcomer_sends(2);
        EXPECT_THAT(node.links->links(), SizeIs(static_cast<std::size_t>(max_peers)));
        return counters.peers_displaced.value() == 1;
    }

    Node node;
    std::vector<PlainSocket> talkers;
};

TEST_F(LinksUdpFull, ATalkerLeavesForASenderThatRepeats) { EXPECT_TRUE(newcomer_enters(16)); }

TEST_F(LinksUdpFull, AmongFewTalkersNobodyLeaves) { EXPECT_FALSE(newcomer_enters(15)); }

TEST(LinksUdp, JunkDoesNotKeepAPeer) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0?idle=50ms");
    const auto peer = PlainSocket::udp();
    peer.send_to(node.port(in), heartbeat(0));
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    ASSERT_TRUE(
        until([&] { return peer.send_to(node.port(in), Bytes(20, 0x55)), node.recorder.downs.size() == 1; }, node));
    EXPECT_EQ(node.recorder.downs[0].second, "idle");
}

TEST(LinksUdp, WhatWasSentToAPeerThatIsGoneStaysCounted) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0?max_peers=1");
    const auto a = PlainSocket::udp(), b = PlainSocket::udp();
    a.send_to(node.port(in), heartbeat(0));
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    EXPECT_EQ(node.links->send(in, view(attitude(0))), 1u);
    node.poll();
    EXPECT_EQ(node.info(in).counters->gone.frames_out.value(), 0u);
    b.send_to(node.port(in), heartbeat(0));
    ASSERT_TRUE(until([&] { return node.recorder.downs.size() == 1; }, node));
    EXPECT_EQ(node.info(in).counters->gone.frames_out.value(), 1u);
    EXPECT_EQ(node.info(in).counters->gone.bytes_out.value(), 40u);
    EXPECT_EQ(node.info(in).counters->gone_queued.value(), 0u);
    EXPECT_EQ(node.links->counters(node.recorder.downs[0].first), nullptr);
}

// From the loopback address nothing goes to another host.
TEST(LinksUdp, FramesOfADatagramThatIsRefusedAreCounted) {
    Node node;
    const auto out = node.add("udpout://192.0.2.1:9?bind=127.0.0.1:0");
    for (std::uint8_t i = 0; i < 3; ++i) EXPECT_EQ(node.links->send(out, view(attitude(i))), 1u);
    node.poll();
    EXPECT_FALSE(node.links->pending());
    const auto& counters = *node.links->links().at(0).counters;
    EXPECT_EQ(counters.frames_not_sent.value(), 3u);
    EXPECT_EQ(counters.frames_out.value(), 0u);
    EXPECT_EQ(node.info(out).counters->send_errors.value(), 1u);
}

TEST(LinksUdp, KernelDropsAreCountedAlsoBehindTheLastDatagram) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0?rcvbuf=4096");
    const auto peer = PlainSocket::udp();
    constexpr int count = 500;
    for (int i = 0; i < count; ++i) peer.send_to(node.port(in), attitude(static_cast<std::uint8_t>(i)));
    ASSERT_TRUE(until(
        [&, last = std::size_t{0}]() mutable {
            return std::exchange(last, node.recorder.frames.size()) == node.recorder.frames.size() && last > 0;
        },
        node));
    node.links->refresh_counters();
    node.links->refresh_counters();
    EXPECT_EQ(node.info(in).counters->kernel_drop.value(), count - node.recorder.frames.size());
    EXPECT_GT(node.info(in).counters->kernel_drop.value(), 0u);
}

TEST(LinksUdp, TheReceiveBufferObtainedIsReported) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0?rcvbuf=100000");
    node.poll();
    EXPECT_GE(node.info(in).rcvbuf_bytes, 100'000u);
    EXPECT_THAT(node.recorder.notices,
                ElementsAre(HasSubstr(fmt::format("listening (receive buffer {} bytes)", node.info(in).rcvbuf_bytes))));
}

TEST(LinksUdp, AClosedFarSideIsNotFatal) {
    Node node;
    std::uint16_t port;
    { port = PlainSocket::udp().port(); }
    const auto out = node.add(to("udpout", port));
    ASSERT_TRUE(until(
        [&] { return node.links->send(out, view(heartbeat(0))), node.info(out).counters->send_errors.value() > 3; },
        node));
    EXPECT_THAT(node.recorder.notices, Contains(HasSubstr("refuses")));
    Node late;
    const auto in = late.add(to("udpin", port));
    ASSERT_TRUE(
        until([&] { return node.links->send(out, view(heartbeat(0))), !late.recorder.frames.empty(); }, node, late));
    EXPECT_THAT(late.links->links(), SizeIs(1));
    EXPECT_EQ(late.links->send(in, view(heartbeat(1))), 1u);
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node, late));
}

TEST(LinksUdp, FramesToAClosedPortAreRefusedUntilThePeerIsHeard) {
    Node node;
    std::uint16_t port;
    { port = PlainSocket::udp().port(); }
    const auto out = node.add(to("udpout", port));
    const auto counters = [&] { return node.links->links().at(0).counters; };
    ASSERT_EQ(node.links->send(out, view(heartbeat(0))), 1u);
    ASSERT_TRUE(until([&] { return node.info(out).counters->send_errors.value() == 1; }, node));
    EXPECT_EQ(counters()->frames_out.value(), 0u);
    EXPECT_EQ(counters()->refused.value(), 1u);
    for (std::uint8_t i = 0; i < 3; ++i) EXPECT_EQ(node.links->send(out, view(attitude(i))), 1u);
    node.poll();
    EXPECT_EQ(counters()->frames_out.value(), 0u);
    EXPECT_EQ(counters()->refused.value(), 4u);

    const auto far_side = PlainSocket::udp(port);
    far_side.send_to(node.info(out).local_port, heartbeat(0));
    ASSERT_TRUE(until([&] { return !node.recorder.frames.empty(); }, node));
    EXPECT_EQ(node.links->send(out, view(attitude(9))), 1u);
    node.poll();
    EXPECT_EQ(counters()->frames_out.value(), 1u);
    EXPECT_EQ(counters()->refused.value(), 4u);
}

TEST(LinksUdp, ARefusalIsForgottenAfterASecond) {
    Node node;
    std::uint16_t port;
    { port = PlainSocket::udp().port(); }
    const auto out = node.add(to("udpout", port));
    ASSERT_EQ(node.links->send(out, view(heartbeat(0))), 1u);
    ASSERT_TRUE(until([&] { return node.info(out).counters->send_errors.value() == 1; }, node));
    const auto far_side = PlainSocket::udp(port);  // listens, and sends nothing
    ASSERT_TRUE(until([&, last = mono_now()] { return mono_now() - last > std::chrono::seconds(1); }, node));
    EXPECT_EQ(node.links->send(out, view(attitude(0))), 1u);
    node.poll();
    EXPECT_EQ(node.links->links().at(0).counters->refused.value(), 1u);
    EXPECT_EQ(node.links->links().at(0).counters->frames_out.value(), 1u);
}

TEST(LinksUdp, ARefusalIsThatOfItsPeerOnly) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    const auto stays = PlainSocket::udp();
    stays.send_to(node.port(in), heartbeat(0));
    {
        const auto goes = PlainSocket::udp();
        goes.send_to(node.port(in), heartbeat(0));
        ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 2; }, node));
    }
    ASSERT_EQ(node.links->send(in, view(attitude(0))), 2u);
    ASSERT_TRUE(until([&] { return node.info(in).counters->send_errors.value() == 1; }, node));
    ASSERT_EQ(node.links->send(in, view(attitude(1))), 2u);
    node.poll();
    const auto links = node.links->links();
    EXPECT_EQ(links.at(0).counters->frames_out.value(), 2u);
    EXPECT_EQ(links.at(0).counters->refused.value(), 0u);
    EXPECT_EQ(links.at(1).counters->frames_out.value(), 1u);  // it was there a moment before
    EXPECT_EQ(links.at(1).counters->refused.value(), 1u);
}

// Each frame cost a peer with a closed port two system calls and an error, so that invented peers on loopback delayed
// the others.
TEST(LinksUdp, AClosedPortOfThisMachineGetsLittle) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    auto peer = PlainSocket::udp();
    peer.send_to(node.port(in), heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    const std::uint16_t port = peer.port();
    const LinkId link = node.recorder.ups[0].first;
    peer.close();
    constexpr unsigned count = 300;
    for (unsigned i = 0; i < count; ++i) {
        EXPECT_EQ(node.links->send(in, view(attitude(static_cast<std::uint8_t>(i)))), 1u);
        node.poll();
    }
    const auto& counters = node.counters(link);
    EXPECT_EQ(counters.refused.value() + counters.frames_out.value(), count);
    EXPECT_LT(counters.frames_out.value(), 10u) << "the first: the peer was there a moment before";
    EXPECT_LT(node.info(in).counters->send_errors.value(), 10u) << "once a second";

    const auto again = PlainSocket::udp(port);
    again.send_to(node.port(in), heartbeat(2));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 2; }, node));
    node.links->send(in, view(heartbeat(9)));
    Bytes got;
    ASSERT_TRUE(until([&] { return !(got = again.read()).empty(); }, node));
    EXPECT_EQ(got, heartbeat(9)) << "at once";
}

// A name with two addresses, of which the first has nobody: the next one gets its turn.
TEST(LinksUdp, CallingANameTriesItsNextAddress) {
    const auto addresses = net::look_up("localhost", 1);
    if (!addresses || addresses->size() < 2) GTEST_SKIP() << "localhost has one address here";
    Node listener, caller;
    const auto in = listener.add("udpin://[::1]:0");
    const auto out = caller.add(fmt::format("udpout://localhost:{}", listener.port(in)));
    ASSERT_TRUE(until([&] { return caller.links->send(out, view(heartbeat(0))), !listener.recorder.frames.empty(); },
                      listener, caller));
    const LinkCounters& counters = *caller.links->links().at(0).counters;
    ASSERT_TRUE(until([&] { return counters.frames_out.value() != 0; }, listener, caller));
    const auto refused = counters.refused.value(), sent = counters.frames_out.value();
    caller.links->send(out, view(heartbeat(1)));  // a refusal by the first address proves nothing about this one
    ASSERT_TRUE(until([&] { return counters.frames_out.value() == sent + 1; }, listener, caller));
    EXPECT_EQ(counters.refused.value(), refused);
}

TEST(LinksUdp, ListeningOnANameBindsAllItsAddresses) {
    const auto addresses = net::look_up("localhost", 1);
    if (!addresses || addresses->size() < 2) GTEST_SKIP() << "localhost has one address here";
    Node listener, four, six;
    const auto in = listener.add("udpin://localhost:0");
    const auto by_four = four.add(to("udpout", listener.port(in)));
    const auto by_six = six.add(fmt::format("udpout://[::1]:{}", listener.port(in)));
    four.links->send(by_four, view(heartbeat(4)));
    six.links->send(by_six, view(heartbeat(6)));
    ASSERT_TRUE(until([&] { return listener.recorder.frames.size() == 2; }, listener, four, six));
}

TEST(LinksUdp, TheNewestSocketOfASharedPortReceives) {
    Node first;
    const auto free = first.add("udpin://127.0.0.1:0?reuse=true");
    const auto port = first.port(free);
    first.links->remove(free);
    first.add(to("udpin", port, "?reuse=true"));
    Node second;
    EXPECT_THAT(second.refused(to("udpin", port)).text, HasSubstr("cannot bind"));
    second.add(to("udpin", port, "?reuse=true"));
    const auto peer = PlainSocket::udp();
    peer.send_to(port, heartbeat(1));
    ASSERT_TRUE(until([&] { return second.recorder.frames.size() == 1; }, first, second));
    EXPECT_THAT(first.recorder.frames, SizeIs(0));
}

TEST(LinksUdp, ManyPeersGetTheirFramesInOneTurn) {
    Node node;
    const auto in = node.add("udpin://127.0.0.1:0");
    std::vector<PlainSocket> peers;
    for (std::size_t i = 0; i < 200; ++i) {
        peers.push_back(PlainSocket::udp());
        peers[i].send_to(node.port(in), heartbeat(0));
    }
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 200; }, node));
    Bytes all;
    for (std::uint8_t i = 0; i < 100; ++i) {  // 4,000 bytes: four datagrams each, more than one batch
        EXPECT_EQ(node.links->send(in, view(attitude(i))), 200u);
        all = std::move(all) + attitude(i);
    }
    node.poll();
    for (const PlainSocket& peer : peers) {
        Bytes got;
        for (Bytes more = peer.read(); !more.empty(); more = peer.read()) got = std::move(got) + more;
        ASSERT_EQ(got, all);
    }
}

}  // namespace
}  // namespace mavloom::link
