// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::SizeIs;

struct LinksTcp : ::testing::Test {
    PlainSocket connect(int receive_buffer = 0) { return PlainSocket::connected_tcp(node.port(in), receive_buffer); }
    Node node;
    EndpointId in = node.add("tcpin://127.0.0.1:0");
};

TEST_F(LinksTcp, FramesSplitAtEveryByteArriveWhole) {
    const auto client = connect();
    const int one = 1;
    setsockopt(client.fd(), IPPROTO_TCP, TCP_NODELAY, &one, sizeof one);
    const Bytes stream = heartbeat(0) + attitude(1) + frame_bytes(131, 2);
    for (std::size_t cut = 1; cut < stream.size(); ++cut) {
        node.recorder.frames.clear();
        const auto at = stream.begin() + static_cast<std::ptrdiff_t>(cut);
        client.write(Bytes(stream.begin(), at));
        node.poll();
        client.write(Bytes(at, stream.end()));
        ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 3; }, node)) << cut;
        ASSERT_EQ(node.recorder.bytes(), stream) << cut;
    }
    EXPECT_EQ(node.links->links().at(0).counters->junk_bytes.value(), 0u);
}

TEST_F(LinksTcp, AClientThatOnlyListensIsFed) {
    const auto client = connect();
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    EXPECT_EQ(node.links->send(in, view(heartbeat(9))), 1u);
    Bytes got;
    ASSERT_TRUE(until([&] { return !(got = std::move(got) + client.read()).empty(); }, node));
    EXPECT_EQ(got, heartbeat(9));
}

TEST_F(LinksTcp, AFalseStartDoesNotHoldFramesBackForEver) {
    const auto client = connect();
    client.write(Bytes{0xfd, 0xff, 0, 0, 0} + heartbeat(1));
    ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 1; }, node));
    EXPECT_EQ(node.recorder.bytes(), heartbeat(1));
    EXPECT_EQ(node.links->links().at(0).counters->junk_bytes.value(), 5u);
}

// Between two turns nobody is there to take the frame that the parser holds back. A slow machine may end the parser's
// wait first; then another client tries.
TEST_F(LinksTcp, AClientThatItsOwnerClosesIsNotParsedToTheEnd) {
    bool held_back = false;
    for (int attempt = 0; attempt < 50 && !held_back; ++attempt) {
        node.recorder = {};
        const auto client = connect();
        client.write(Bytes{0xfd, 0xff, 0, 0, 0} + heartbeat(1));
        ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
        node.poll();
        held_back = node.recorder.frames.empty();
        EXPECT_TRUE(node.links->close(node.recorder.ups[0].first));
        node.poll();
        EXPECT_EQ(node.recorder.frames.empty(), held_back);
        EXPECT_THAT(node.links->links(), SizeIs(0));
    }
    EXPECT_TRUE(held_back);
}

TEST_F(LinksTcp, AClosedClientGoesDownOnceAndItsFramesWereHeard) {
    auto client = connect();
    client.write(heartbeat(1) + Bytes{0xfd, 9, 0});
    client.close();
    ASSERT_TRUE(until([&] { return node.recorder.downs.size() == 1; }, node));
    EXPECT_EQ(node.recorder.bytes(), heartbeat(1));
    EXPECT_THAT(node.links->links(), SizeIs(0));
}

TEST_F(LinksTcp, CountersAreThereWhileALinkGoesDown) {
    struct Last : Recorder {
        void on_link_down(LinkId id, EndpointId, std::string_view) override {
            frames_in = links->counters(id)->frames_in.value();
        }
        Links* links = nullptr;
        std::uint64_t frames_in = 0;
    } last;
    last.links = node.links.get();
    {
        const auto client = connect();
        client.write(heartbeat(1) + heartbeat(2));
    }
    const MonoTime deadline = mono_now() + std::chrono::seconds(60);
    while (last.frames_in == 0 && mono_now() < deadline)
        node.links->turn(last, mono_now() + std::chrono::milliseconds(1));
    EXPECT_EQ(last.frames_in, 2u);
}

// A stalled client harms itself only, and gets whole frames when it reads again.
TEST_F(LinksTcp, ASlowClientLosesWholeFramesOnlyAndTheOthersNone) {
    const auto slow = connect(4096), quick = connect();
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 2; }, node));
    constexpr int count = 60'000;  // 16 MB, far more than the kernel and the queue (1 MiB) hold
    Bytes got_quick, got_slow;
    std::size_t quick_bytes = 0;
    for (int i = 0; i < count; ++i) {
        const Bytes frame = frame_bytes(131, static_cast<std::uint8_t>(i));
        node.links->send(in, view(frame));
        if (i % 50 == 0) {
            node.poll();
            for (Bytes more = quick.read(); !more.empty(); more = quick.read()) quick_bytes += more.size();
        }
    }
    const std::size_t all_bytes = count * frame_bytes(131, 0).size();
    ASSERT_TRUE(until([&] { return (quick_bytes += quick.read().size()) == all_bytes; }, node));
    EXPECT_LE(node.links->queued_bytes(in), 1u << 20);
    const auto links = node.links->links();
    ASSERT_THAT(links, SizeIs(2)) << "a slow client is never disconnected";
    const auto& slow_counters = links[0].name.ends_with(std::to_string(slow.port())) ? *links[0].counters
                                                                                     : *links[1].counters;
    EXPECT_GT(slow_counters.queue_bytes.value(), 0u);

    ASSERT_TRUE(until(
        [&] {
            got_slow = std::move(got_slow) + slow.read();
            return !node.links->pending() && got_slow.size() == slow_counters.bytes_out.value();
        },
        node));
    wire::StreamParser parser(table());
    std::size_t frames = 0, bad = 0;
    parser.feed(got_slow, MonoTime{},
                [&](const wire::ParseEvent& e) { ++(e.kind == wire::ParseEvent::Kind::frame ? frames : bad); });
    EXPECT_EQ(bad, 0u);
    EXPECT_EQ(parser.pending_bytes(), 0u);
    EXPECT_EQ(frames, slow_counters.frames_out.value());
    EXPECT_EQ(frames + slow_counters.queue_bytes.value() + slow_counters.queue_age.value(),
              static_cast<std::size_t>(count));
}

TEST_F(LinksTcp, WhatAStalledClientCannotTakeAges) {
    Node other;
    in = other.add("tcpin://127.0.0.1:0?queue_age=20ms");
    const auto stalled = PlainSocket::connected_tcp(other.port(in), 4096);
    ASSERT_TRUE(until([&] { return other.recorder.ups.size() == 1; }, other));
    while (!other.links->pending()) {
        for (int i = 0; i < 1000; ++i) other.links->send(in, view(frame_bytes(131, static_cast<std::uint8_t>(i))));
        other.poll();
    }
    const auto& counters = *other.links->links().at(0).counters;
    ASSERT_TRUE(until([&] { return counters.queue_age.value() > 0 && other.links->queued_bytes(in) <= 280; }, other));
}

TEST_F(LinksTcp, EveryFrameForAClientThatIsGoneStaysCounted) {
    auto stalled = connect(4096);
    ASSERT_TRUE(until([&] { return node.recorder.ups.size() == 1; }, node));
    std::size_t count = 0;
    while (!node.links->pending()) {
        for (int i = 0; i < 500; ++i)
            count += node.links->send(in, view(frame_bytes(131, static_cast<std::uint8_t>(i))));
        node.poll();
    }
    stalled.close();
    ASSERT_TRUE(until([&] { return node.recorder.downs.size() == 1; }, node));
    const EndpointCounters& counters = *node.info(in).counters;
    const auto& gone = counters.gone;
    const auto dropped = gone.queue_bytes.value() + gone.queue_age.value() + counters.gone_queued.value();
    EXPECT_GT(gone.frames_out.value(), 0u);
    EXPECT_GT(dropped, 0u);
    EXPECT_EQ(gone.frames_out.value() + dropped, count);
}

TEST_F(LinksTcp, ClientsOverMaxPeersAreTurnedAwayWhileAllOthersTalk) {
    Node other;
    in = other.add("tcpin://127.0.0.1:0?max_peers=2");
    std::vector<PlainSocket> clients;
    for (int i = 0; i < 2; ++i) {
        clients.push_back(PlainSocket::connected_tcp(other.port(in)));
        clients.back().write(heartbeat(0));
    }
    ASSERT_TRUE(until([&] { return other.recorder.frames.size() == 2; }, other));
    clients.push_back(PlainSocket::connected_tcp(other.port(in)));
    ASSERT_TRUE(until([&] { return other.info(in).counters->peers_refused.value() == 1; }, other));
    EXPECT_THAT(other.links->links(), SizeIs(2));
    EXPECT_THAT(other.recorder.notices, ::testing::Contains(HasSubstr("max_peers")));
}

TEST_F(LinksTcp, SilentClientsMakeRoomForNewcomersOldestFirst) {
    Node other;
    in = other.add("tcpin://127.0.0.1:0?max_peers=3");
    std::vector<PlainSocket> clients;
    for (int i = 0; i < 3; ++i) {
        clients.push_back(PlainSocket::connected_tcp(other.port(in)));
        ASSERT_TRUE(until([&] { return other.links->links().size() == clients.size(); }, other));
    }
    clients[0].write(heartbeat(0));
    clients[1].write(Bytes{1, 2, 3});  // junk is no talk
    ASSERT_TRUE(until([&] { return other.recorder.frames.size() == 1; }, other));

    clients.push_back(PlainSocket::connected_tcp(other.port(in)));
    ASSERT_TRUE(until([&] { return other.info(in).counters->peers_evicted.value() == 1; }, other));

    ASSERT_THAT(other.recorder.downs, SizeIs(1));
    EXPECT_EQ(other.recorder.downs[0].first, other.recorder.ups[1].first);
    EXPECT_EQ(other.info(in).counters->peers_refused.value(), 0u);
}

// More connections than may enter a full endpoint at once, then one from another address shortly after.
TEST_F(LinksTcp, AStormOfConnectionsKeepsNoOtherAddressOut) {
    Node other;
    in = other.add("tcpin://127.0.0.1:0?max_peers=4");
    std::vector<PlainSocket> clients;
    const auto connect_from = [&](std::uint32_t host, int count) {
        for (int i = 0; i < count; ++i) clients.push_back(PlainSocket::connected_tcp(other.port(in), 0, host));
    };
    const auto refused = [&] { return other.info(in).counters->peers_refused.value(); };
    const auto all_came = [&] { return refused() + other.recorder.ups.size() == clients.size(); };
    for (int batch = 0; batch < 50 && refused() == 0; ++batch) {
        connect_from(INADDR_LOOPBACK, 60);
        ASSERT_TRUE(until(all_came, other));
    }
    ASSERT_GT(refused(), 0u);

    connect_from(INADDR_LOOPBACK, 50);
    connect_from(INADDR_LOOPBACK + 1, 1);
    ASSERT_TRUE(until(all_came, other));
    connect_from(INADDR_LOOPBACK, 10);
    ASSERT_TRUE(until(all_came, other));

    const auto links = other.links->links();
    EXPECT_THAT(links, SizeIs(4));
    EXPECT_THAT(links, Contains(::testing::Field(&LinkInfo::name, HasSubstr("#127.0.0.2:"))));
}

// Web pages: a browser sends any bytes that a page wants to any local port, but behind an HTTP request line. Methods of
// RFC 9110 and 5789; PRI opens HTTP/2 (RFC 9113).
struct LinksTcpHttp : LinksTcp {
    static Bytes text(std::string_view ascii) { return {ascii.begin(), ascii.end()}; }
    [[nodiscard]] std::uint64_t http_refused() const { return node.info(in).counters->http_refused.value(); }
    [[nodiscard]] bool is_refused(std::uint64_t count = 1) {
        return until([&] { return http_refused() == count; }, node) && node.links->links().empty();
    }
};

TEST_F(LinksTcpHttp, ARequestIsRefusedAndNoFrameBehindItHeard) {
    std::uint64_t count = 0;
    for (const auto method : {"GET", "POST", "PUT", "HEAD", "OPTIONS", "PATCH", "DELETE", "CONNECT", "TRACE", "PRI"}) {
        const auto page = connect();
        page.write(text(fmt::format("{} / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n", method)) + heartbeat(1));
        ASSERT_TRUE(is_refused(++count)) << method;
    }
    EXPECT_THAT(node.recorder.frames, SizeIs(0));
    EXPECT_GT(node.info(in).counters->gone.junk_bytes.value(), 0u);
}

TEST_F(LinksTcpHttp, ARequestThatComesByteByByteIsRefused) {
    const auto page = connect();
    for (const std::uint8_t byte : text("POST ")) {
        page.write({byte});
        node.poll();
    }
    EXPECT_TRUE(is_refused());
}

// The first bytes of a ClientHello: record type 22, version 3.1 (RFC 8446, section 5.1), length, type 1.
TEST_F(LinksTcpHttp, AHandshakeOfTlsIsRefused) {
    const auto page = connect();
    page.write(Bytes{0x16, 0x03, 0x01, 0x02, 0x00, 0x01} + heartbeat(1));
    EXPECT_TRUE(is_refused());
    EXPECT_THAT(node.recorder.frames, SizeIs(0));
}

TEST_F(LinksTcpHttp, IsReportedOnce) {
    for (std::uint64_t count = 1; count <= 3; ++count) {
        const auto page = connect();
        page.write(text("GET / HTTP/1.1\r\n"));
        ASSERT_TRUE(is_refused(count));
    }
    const auto is_about_http = [](const std::string& notice) { return notice.find("HTTP") != std::string::npos; };
    EXPECT_EQ(std::ranges::count_if(node.recorder.notices, is_about_http), 1);
}

// A serial bridge may begin anywhere in a frame or in the text that a vehicle prints when it starts.
TEST_F(LinksTcpHttp, OtherJunkBeforeFramesIsNoRequest) {
    for (const auto junk : {"G", "GET", "GETTING ", "POS", "NSH> ", "PUTGET / ", " GET / ", "get / "}) {
        const auto bridge = connect();
        node.recorder.frames.clear();
        bridge.write(text(junk));
        node.poll();
        bridge.write(heartbeat(1) + text("GET / HTTP/1.1\r\n") + heartbeat(2));
        ASSERT_TRUE(until([&] { return node.recorder.frames.size() == 2; }, node)) << junk;
    }
    EXPECT_EQ(http_refused(), 0u);
}

TEST(LinksTcpOut, WaitsForAListenerThatComesLater) {
    std::uint16_t port;
    {
        const PlainSocket reserved(SOCK_STREAM);
        port = reserved.port();
    }
    Node caller, listener;
    const auto out = caller.add(fmt::format("tcpout://127.0.0.1:{}", port));
    ASSERT_TRUE(until([&] { return !caller.recorder.notices.empty(); }, caller));
    EXPECT_THAT(caller.recorder.notices[0],
                HasSubstr(fmt::format("127.0.0.1:{}: Connection refused; trying again", port)));
    EXPECT_EQ(caller.links->send(out, view(heartbeat(0))), 0u);
    const auto in = listener.add(fmt::format("tcpin://127.0.0.1:{}", port));
    ASSERT_TRUE(
        until([&] { return caller.recorder.ups.size() == 1 && listener.recorder.ups.size() == 1; }, caller, listener));
    EXPECT_THAT(caller.recorder.notices, SizeIs(1)) << "once, not at each attempt";
    EXPECT_EQ(listener.links->send(in, view(heartbeat(1))), 1u);
    ASSERT_TRUE(until([&] { return caller.recorder.frames.size() == 1; }, caller, listener));
}

TEST(LinksTcpOut, ARequiredFarSideThatIsAbsentIsAnError) {
    std::uint16_t port;
    {
        const PlainSocket reserved(SOCK_STREAM);
        port = reserved.port();
    }
    Node caller;
    const auto error = caller.refused(fmt::format("tcpout://127.0.0.1:{}?required=true", port));
    EXPECT_EQ(error.code, SetupCode::unreachable);
    EXPECT_THAT(error.text, HasSubstr("Connection refused"));
}

TEST(LinksTcpOut, BindFixesTheLocalSide) {
    const PlainSocket listening(SOCK_STREAM);
    ASSERT_EQ(::listen(listening.fd(), 1), 0);
    Node caller;
    caller.add(fmt::format("tcpout://127.0.0.1:{}?bind=127.0.0.2:0", listening.port()));
    ASSERT_TRUE(until([&] { return caller.recorder.ups.size() == 1; }, caller));
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const int connection = ::accept(listening.fd(), reinterpret_cast<sockaddr*>(&from), &size);
    EXPECT_EQ(from.sin_addr.s_addr, htonl(INADDR_LOOPBACK + 1));
    ::close(connection);
}

// A listener whose backlog is full does not answer: the connect stays under way.
TEST(LinksTcpOut, ABlackHoleDelaysNobody) {
    const PlainSocket hole(SOCK_STREAM);
    ASSERT_EQ(::listen(hole.fd(), 0), 0);
    std::vector<PlainSocket> filling;
    for (int i = 0; i < 4; ++i) {
        filling.emplace_back(SOCK_STREAM);
        fcntl(filling.back().fd(), F_SETFL, O_NONBLOCK);
        sockaddr_in to = PlainSocket::loopback(hole.port());
        (void)::connect(filling.back().fd(), reinterpret_cast<sockaddr*>(&to), sizeof to);
    }
    Node node;
    const auto out = node.add(fmt::format("tcpout://127.0.0.1:{}", hole.port()));
    node.poll();
    EXPECT_THAT(node.recorder.notices, Not(Contains(HasSubstr("trying again")))) << "the connect is not under way";
    const auto in = node.add("udpin://127.0.0.1:0");
    node.recorder.answer = [&](const RxFrame& rx) { node.links->send(rx.link, rx.frame); };
    const auto peer = PlainSocket::udp();
    for (std::uint8_t i = 0; i < 10; ++i) {
        peer.send_to(node.port(in), heartbeat(i));
        ASSERT_TRUE(until([&] { return !peer.read().empty(); }, node));
    }
    EXPECT_EQ(node.links->send(out, view(heartbeat(0))), 0u);
}

// The far side took a part of a frame and went: on the next connection the frame comes whole.
TEST(LinksTcpOut, ANewConnectionBeginsWithAWholeFrame) {
    const PlainSocket listening(SOCK_STREAM);
    const int small = 4096;
    setsockopt(listening.fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    ASSERT_EQ(::listen(listening.fd(), 5), 0);
    Node caller;
    const auto out = caller.add(fmt::format("tcpout://127.0.0.1:{}", listening.port()));
    ASSERT_TRUE(until([&] { return caller.recorder.ups.size() == 1; }, caller));
    const int first = ::accept(listening.fd(), nullptr, nullptr);
    while (!caller.links->pending()) {
        for (int i = 0; i < 500; ++i) caller.links->send(out, view(frame_bytes(131, static_cast<std::uint8_t>(i))));
        caller.poll();
    }
    ::close(first);  // with bytes unread: a reset
    ASSERT_TRUE(until([&] { return caller.recorder.downs.size() == 1 && caller.recorder.ups.size() == 2; }, caller));
    EXPECT_EQ(caller.recorder.ups[0].first, caller.recorder.ups[1].first) << "the link stays the same";
    EXPECT_EQ(caller.info(out).counters->reconnects.value(), 1u);
    const int second = ::accept(listening.fd(), nullptr, nullptr);
    caller.links->send(out, view(heartbeat(0)));
    Bytes begin(10);
    ASSERT_TRUE(until([&] { return ::recv(second, begin.data(), begin.size(), MSG_DONTWAIT | MSG_PEEK) == 10; }, caller));
    const wire::MessageTable& known = table();
    EXPECT_EQ(begin[0], wire::stx_v2);
    EXPECT_NE(known.find(MessageId{begin[7] | std::uint32_t{begin[8]} << 8}), nullptr);
    ::close(second);
}

// Otherwise the delay would be longer than three seconds after six connections. A slow machine has further rounds.
TEST(LinksTcpOut, AfterAConnectionThatWasHeardTheDelayBeginsAgain) {
    constexpr std::size_t usual_rounds = 6, max_rounds = 10;
    constexpr std::chrono::seconds grown{3};
    const PlainSocket listening(SOCK_STREAM);
    ASSERT_EQ(::listen(listening.fd(), 1), 0);
    Node caller;
    caller.add(fmt::format("tcpout://127.0.0.1:{}", listening.port()));
    bool is_short = false;
    for (std::size_t round = 0; round < max_rounds && !is_short; ++round) {
        const MonoTime down = mono_now();
        ASSERT_TRUE(until([&] { return caller.recorder.ups.size() == round + 1; }, caller));
        is_short = round >= usual_rounds && mono_now() - down < grown;
        const int connection = ::accept(listening.fd(), nullptr, nullptr);
        const Bytes beat = heartbeat(static_cast<std::uint8_t>(round));
        ASSERT_EQ(::send(connection, beat.data(), beat.size(), MSG_NOSIGNAL), static_cast<ssize_t>(beat.size()));
        ::close(connection);
        ASSERT_TRUE(until([&] { return caller.recorder.downs.size() == round + 1; }, caller));
    }
    EXPECT_TRUE(is_short);
}

// The far side was away for longer than queue_age: what was meant for then is not said now.
TEST(LinksTcpOut, FramesThatBecameTooOldMeanwhileAreNotSent) {
    PlainSocket listening(SOCK_STREAM);
    const int small = 4096;
    setsockopt(listening.fd(), SOL_SOCKET, SO_RCVBUF, &small, sizeof small);
    ASSERT_EQ(::listen(listening.fd(), 5), 0);
    const std::uint16_t port = listening.port();
    Node caller, listener;
    const auto out = caller.add(fmt::format("tcpout://127.0.0.1:{}?queue_age=200ms", port));
    ASSERT_TRUE(until([&] { return caller.recorder.ups.size() == 1; }, caller));
    const int first = ::accept(listening.fd(), nullptr, nullptr);
    while (!caller.links->pending()) {
        for (int i = 0; i < 500; ++i) caller.links->send(out, view(frame_bytes(76, static_cast<std::uint8_t>(i))));
        caller.poll();
    }
    listening.close();
    ::close(first);
    ASSERT_TRUE(until([&] { return caller.recorder.downs.size() == 1; }, caller));
    EXPECT_GT(caller.links->queued_bytes(out), 0u);
    const MonoTime too_old = mono_now() + std::chrono::milliseconds(250);
    ASSERT_TRUE(until([&] { return mono_now() > too_old; }, caller));
    listener.add(fmt::format("tcpin://127.0.0.1:{}", port));
    ASSERT_TRUE(until([&] { return caller.recorder.ups.size() == 2; }, caller, listener));
    caller.links->send(out, view(heartbeat(0)));
    ASSERT_TRUE(until([&] { return !listener.recorder.frames.empty(); }, caller, listener));
    EXPECT_EQ(listener.recorder.bytes(), heartbeat(0));
    EXPECT_GT(caller.counters(caller.recorder.ups[0].first).queue_age.value(), 0u);
}

}  // namespace
}  // namespace mavloom::link
