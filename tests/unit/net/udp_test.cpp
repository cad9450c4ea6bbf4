// SPDX-License-Identifier: MIT
#include "mavloom/net/udp.hpp"

#include <gtest/gtest.h>
#include <poll.h>

#include <string>

namespace mavloom::net {
namespace {

const Address any_udp_port = *Address::parse("127.0.0.1", 0);

std::string text_of(ByteView bytes) { return {bytes.begin(), bytes.end()}; }

struct Udp : ::testing::Test {
    UdpSocket open(const UdpOptions& options = {}) { return std::move(*UdpSocket::open(any_udp_port, options)); }
    static void await(const UdpSocket& socket) {
        pollfd wanted{socket.fd(), POLLIN, 0};
        ASSERT_EQ(::poll(&wanted, 1, 5000), 1);
    }
    // Sends each text as one datagram, in one call.
    void send(UdpSocket& from, const Address& to, std::vector<std::string>& texts) {
        batch_out.clear();
        for (std::string& text : texts) {
            batch_out.room()[0] = {text.data(), text.size()};
            batch_out.add(&to, 1);
        }
        EXPECT_EQ(*from.send(batch_out, 0), texts.size());
    }
    ReceiveBatch batch = std::move(*ReceiveBatch::create());
    SendBatch batch_out;
};

TEST_F(Udp, SendsAndReceivesInBatches) {
    UdpSocket a = open(), b = open();
    std::vector<std::string> texts{"one", "two", std::string(65507, 'x')};
    send(a, b.local(), texts);
    await(b);
    ASSERT_EQ(*b.receive(batch), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(text_of(batch[i].bytes), texts[i]);
        EXPECT_EQ(*batch[i].from, a.local());
    }
    EXPECT_EQ(b.receive(batch).error(), IoError::would_block);
    EXPECT_EQ(batch.size(), 0u);
}

TEST_F(Udp, GathersADatagramFromPieces) {
    UdpSocket a = open(), b = open();
    std::string left = "left ", right = "right";
    batch_out.room()[0] = {left.data(), left.size()};
    batch_out.room()[1] = {right.data(), right.size()};
    const Address to = b.local();
    batch_out.add(&to, 2);
    ASSERT_TRUE(a.send(batch_out, 0));
    await(b);
    ASSERT_EQ(*b.receive(batch), 1u);
    EXPECT_EQ(text_of(batch[0].bytes), "left right");
}

TEST_F(Udp, APortInUseIsNamed) {
    const UdpSocket a = open();
    const auto second = UdpSocket::open(a.local(), {});
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, SetupCode::in_use);
    EXPECT_NE(second.error().text.find(a.local().text()), std::string::npos) << second.error().text;
}

TEST_F(Udp, CountsWhatTheKernelDroppedAlsoBehindTheLastDatagramRead) {
    UdpOptions tiny;
    tiny.receive_buffer_bytes = 4096;
    UdpSocket a = open(), b = open(tiny);
    EXPECT_LE(b.receive_buffer_bytes(), 8192u);
    std::vector<std::string> texts(200, std::string(100, 'x'));
    send(a, b.local(), texts);
    std::size_t received = 0;
    while (const auto count = b.receive(batch)) received += *count;
    EXPECT_LT(received, 200u);
    EXPECT_EQ(b.kernel_drops(), 200u - received);
}

TEST_F(Udp, GetsTheReceiveBufferThatIsAllowed) {
    UdpOptions options;
    options.receive_buffer_bytes = 100'000;
    EXPECT_GE(open(options).receive_buffer_bytes(), 100'000u);
}

TEST_F(Udp, LearnsOfAClosedPort) {
    UdpSocket a = open();
    const Address closed = open().local();
    std::vector<std::string> texts{"anybody?"};
    send(a, closed, texts);
    pollfd wanted{a.fd(), 0, 0};
    ASSERT_EQ(::poll(&wanted, 1, 5000), 1);
    const auto failure = a.take_failure();
    ASSERT_TRUE(failure.has_value());
    EXPECT_EQ(failure->to, closed);
    EXPECT_EQ(failure->error, IoError::refused);
    EXPECT_EQ(failure->reporter.host_text(), "127.0.0.1");
    EXPECT_FALSE(a.take_failure().has_value());
    const UdpSocket now_open = std::move(*UdpSocket::open(closed, {}));
    send(a, closed, texts);
    await(now_open);
}

TEST_F(Udp, ADualStackSocketLearnsOfAClosedPortOfAnIpv4Host) {
    auto both = UdpSocket::open(*Address::parse("::", 0), {});
    if (!both) GTEST_SKIP() << both.error().text;
    const Address closed = *Address::parse("::ffff:127.0.0.1", open().local().port());
    std::vector<std::string> texts{"anybody?"};
    send(*both, closed, texts);
    pollfd wanted{both->fd(), 0, 0};
    ASSERT_EQ(::poll(&wanted, 1, 5000), 1);
    const auto failure = both->take_failure();
    ASSERT_TRUE(failure.has_value());
    EXPECT_EQ(failure->to, closed);
    EXPECT_EQ(failure->error, IoError::refused);
    EXPECT_TRUE(failure->reporter.is_loopback());
}

TEST_F(Udp, BothFamiliesReachADualStackSocket) {
    auto both = UdpSocket::open(*Address::parse("::", 0), {});
    if (!both) GTEST_SKIP() << both.error().text;
    UdpSocket a = open();
    std::vector<std::string> texts{"four"};
    send(a, any_udp_port.with_port(both->local().port()), texts);
    await(*both);
    ASSERT_EQ(*both->receive(batch), 1u);
    EXPECT_EQ(batch[0].from->text(), a.local().text());
}

}  // namespace
}  // namespace mavloom::net
