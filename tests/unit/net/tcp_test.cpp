// SPDX-License-Identifier: MIT
#include "mavloom/net/tcp.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>

#include <array>
#include <string>
#include <vector>

#include "mavloom/net/port_holder.hpp"

namespace mavloom::net {
namespace {

const Address any_port = *Address::parse("127.0.0.1", 0);

void await(int fd, short events) {
    pollfd wanted{fd, events, 0};
    ASSERT_EQ(::poll(&wanted, 1, 5000), 1);
}

struct Tcp : ::testing::Test {
    void connect() {
        near = std::move(*TcpStream::start_connect(listener.local()));
        ASSERT_TRUE(near.wait_connected(std::chrono::seconds(5)));
        ASSERT_TRUE(near.finish_connect());
        await(listener.fd(), POLLIN);
        far = std::move(*listener.accept());
    }
    TcpListener listener = std::move(*TcpListener::open(any_port, false));
    TcpStream near, far;
    std::array<std::uint8_t, 64> room{};
};

TEST_F(Tcp, ConnectsAndExchanges) {
    EXPECT_EQ(listener.accept().error(), IoError::would_block);
    connect();
    std::string one = "hello ", two = "there";
    const std::array<iovec, 2> pieces{{{one.data(), one.size()}, {two.data(), two.size()}}};
    EXPECT_EQ(*near.write(pieces), 11u);
    await(far.fd(), POLLIN);
    EXPECT_EQ(*far.read(room), 11u);
    EXPECT_EQ(std::string(room.begin(), room.begin() + 11), "hello there");
    EXPECT_EQ(far.read(room).error(), IoError::would_block);
    EXPECT_EQ(near.remote(), listener.local());
}

// The process may open only `most` descriptors while this lives.
struct FewDescriptors {
    explicit FewDescriptors(rlim_t most) {
        EXPECT_EQ(getrlimit(RLIMIT_NOFILE, &before), 0);
        const rlimit few{most, before.rlim_max};
        EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
    }
    ~FewDescriptors() { EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &before), 0); }
    FewDescriptors(const FewDescriptors&) = delete;
    FewDescriptors& operator=(const FewDescriptors&) = delete;
    rlimit before{};
};

// The last descriptors are not given to clients: the client waits, and the program can still open something.
TEST_F(Tcp, LeavesSomeDescriptorsToTheProgram) {
    near = std::move(*TcpStream::start_connect(listener.local()));
    await(listener.fd(), POLLIN);
    const FewDescriptors few(64);
    std::vector<Fd> taken;
    const auto take = [] { return Fd(::open("/dev/null", O_RDONLY | O_CLOEXEC)); };
    Fd next = take();
    for (; next && next.get() < 48; next = take()) taken.push_back(std::move(next));
    if (taken.empty() || !next) GTEST_SKIP() << "whoever started the test left too many descriptors open";
    next.reset();
    EXPECT_EQ(listener.accept().error(), IoError::no_descriptors);
    EXPECT_TRUE(take());
    taken.pop_back();
    far = std::move(*listener.accept());
    EXPECT_EQ(listener.accept().error(), IoError::would_block);
}

TEST_F(Tcp, ReportsTheEndOfAStream) {
    connect();
    near = {};
    await(far.fd(), POLLIN);
    EXPECT_EQ(far.read(room).error(), IoError::closed);
}

TEST_F(Tcp, WritesUntilTheKernelTakesNoMore) {
    connect();
    std::string block(65536, 'x');
    const std::array<iovec, 1> pieces{{{block.data(), block.size()}}};
    std::size_t total = 0;
    IoResult<std::size_t> written;
    while ((written = near.write(pieces))) total += *written;
    EXPECT_EQ(written.error(), IoError::would_block);
    EXPECT_GT(total, 0u);
}

TEST_F(Tcp, APortInUseIsNamed) {
    const auto second = TcpListener::open(listener.local(), false);
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, SetupCode::in_use);
    EXPECT_NE(second.error().text.find(listener.local().text()), std::string::npos) << second.error().text;
}

TEST_F(Tcp, AConnectionFromAPortInUseSearchesForNoHolder) {
    const auto refused = TcpStream::start_connect(*Address::parse("127.0.0.1", 9), listener.local());
    ASSERT_FALSE(refused);
    EXPECT_TRUE(refused.error().text.ends_with("in use")) << refused.error().text << ": each retry reads /proc";
}

TEST(PortHolder, HasTheSameAddressOrAll) {
    const auto listener = TcpListener::open(*Address::parse("127.0.0.2", 0), false);
    ASSERT_TRUE(listener) << listener.error().text;
    const auto holder_at = [&](std::string_view host) {
        return port_holder(Transport::tcp, *Address::parse(host, listener->local().port()));
    };
    EXPECT_EQ(holder_at("127.0.0.2"), "this process");
    EXPECT_EQ(holder_at("::ffff:127.0.0.2"), "this process");
    EXPECT_EQ(holder_at("0.0.0.0"), "this process");
    EXPECT_EQ(holder_at("::"), "this process");
    EXPECT_EQ(holder_at("127.0.0.3"), "");
}

TEST(PortHolder, OfAllAddressesHasEachOfThem) {
    for (const auto* all : {"0.0.0.0", "::"}) {
        const auto listener = TcpListener::open(*Address::parse(all, 0), false);
        ASSERT_TRUE(listener) << listener.error().text;
        EXPECT_EQ(port_holder(Transport::tcp, *Address::parse("127.0.0.3", listener->local().port())), "this process");
    }
}

// Another program, which was in nobody's way, was named.
TEST(PortHolder, OfAllIPv4AddressesHasNoIPv6One) {
    const auto listener = TcpListener::open(*Address::parse("0.0.0.0", 0), false);
    ASSERT_TRUE(listener) << listener.error().text;
    EXPECT_EQ(port_holder(Transport::tcp, *Address::parse("::1", listener->local().port())), "");
    EXPECT_EQ(port_holder(Transport::tcp, *Address::parse("::", listener->local().port())), "this process");
}

TEST_F(Tcp, TheHolderOfAPortIsSearchedOnceForRepeatedFailures) {
    BindErrors errors(Transport::tcp);
    const Address local = listener.local();
    const SetupError failed = TcpListener::open(local, false).error();
    const auto named = failed.text + " by this process";
    EXPECT_EQ(errors.complete(failed, local).value().text, named);
    listener = {};
    EXPECT_EQ(errors.complete(failed, local).value().text, named) << "searched again";
    EXPECT_EQ(errors.complete(failed, *Address::parse("127.0.0.9", local.port())).value().text, failed.text);
    const SetupError other = TcpListener::open(*Address::parse("192.0.2.1", 1), false).error();
    EXPECT_EQ(errors.complete(other, local).value().text, other.text);
}

TEST_F(Tcp, ARefusedConnectionIsNamed) {
    const Address closed = listener.local();
    listener = {};
    auto stream = TcpStream::start_connect(closed);
    ASSERT_TRUE(stream);
    ASSERT_TRUE(stream->wait_connected(std::chrono::seconds(5)));
    const auto outcome = stream->finish_connect();
    ASSERT_FALSE(outcome);
    EXPECT_EQ(outcome.error().code, SetupCode::unreachable);
    EXPECT_NE(outcome.error().text.find(closed.text()), std::string::npos);
}

}  // namespace
}  // namespace mavloom::net
