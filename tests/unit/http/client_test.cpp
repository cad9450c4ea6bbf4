// SPDX-License-Identifier: MIT
#include "mavloom/http/client.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "http/web_socket/web_socket.hpp"
#include "mavloom/http/server.hpp"
#include "support/eventually.hpp"
#include "unit/http/raw_client.hpp"

namespace mavloom::http {
namespace {

using namespace std::chrono_literals;
using test::eventually;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// One side of a WebSocket, and what it heard.
struct Side {
    SessionEvents take(const std::shared_ptr<Session>& opened) {
        const std::lock_guard lock(mutex);
        session = opened;
        return {.on_message =
                    [this](ByteView bytes, Kind) {
                        const std::lock_guard locked(mutex);
                        messages.emplace_back(bytes.begin(), bytes.end());
                        return true;
                    },
                .on_closed =
                    [this](const Closed& how) {
                        const std::lock_guard locked(mutex);
                        closed = how;
                    }};
    }
    void fail(const SetupError& error) {
        const std::lock_guard lock(mutex);
        failed = error.text;
    }
    [[nodiscard]] bool eventually_has(auto look) {
        return eventually([&] {
            const std::lock_guard lock(mutex);
            return look();
        });
    }
    void send(std::string_view text) {
        session->push(bytes_of(text), 0, 0, mono_now());
        session->flush();
    }

    std::mutex mutex;
    std::shared_ptr<Session> session;
    std::vector<std::string> messages;
    std::optional<Closed> closed;
    std::string failed;
};

struct WebSocketClient : ::testing::Test {
    void serve() {
        ServerOptions options{.addresses = {any_port}};
        options.web_sockets.push_back({"/path", {"proto"}, {}, [this](const auto& opened) { return far.take(opened); }});
        server.emplace(std::move(*Server::listen(thread, std::move(options))));
    }
    void connect(ClientOptions options) {
        if (options.addresses.empty()) options.addresses = server->addresses();
        options.host = "localhost";
        options.patience = patience;
        client.emplace(Client::connect(thread, std::move(options),
                                       {.on_open = [this](const auto& opened) { return near.take(opened); },
                                        .on_failed = [this](const SetupError& error) { near.fail(error); }}));
    }
    [[nodiscard]] std::string failure() {
        EXPECT_TRUE(near.eventually_has([&] { return !near.failed.empty(); }));
        return near.failed;
    }

    // Accepts one connection, and answers its request with these lines and the right key.
    static void answer(net::TcpListener& listener, const std::string& lines) {
        net::TcpStream there;
        ASSERT_TRUE(eventually([&] {
            if (auto accepted = listener.accept()) there = std::move(*accepted);
            return static_cast<bool>(there);
        }));
        std::string request;
        ASSERT_TRUE(eventually([&] {
            std::array<char, 4096> room{};
            const auto size = ::recv(there.fd(), room.data(), room.size(), MSG_DONTWAIT);
            if (size > 0) request.append(room.data(), static_cast<std::size_t>(size));
            return request.ends_with("\r\n\r\n");
        }));
        const auto key = request.substr(request.find("Sec-WebSocket-Key: ") + 19, 24);
        const auto all = "HTTP/1.1 101 Switching Protocols\r\n" + lines + "Sec-WebSocket-Accept: " + accept_key(key) +
                         "\r\n\r\n";
        EXPECT_EQ(::send(there.fd(), all.data(), all.size(), MSG_NOSIGNAL), static_cast<ssize_t>(all.size()));
    }

    std::chrono::milliseconds patience = test::long_enough;
    Side near, far;
    Thread thread = std::move(*Thread::start());
    std::optional<Server> server;
    std::optional<Client> client;
};

TEST_F(WebSocketClient, ConnectsAndExchanges) {
    serve();
    connect({.path = "/path?x", .subprotocol = "proto"});
    ASSERT_TRUE(near.eventually_has([&] { return near.session != nullptr; }));
    ASSERT_TRUE(far.eventually_has([&] { return far.session != nullptr; }));
    EXPECT_EQ(near.session->peer().subprotocol, "proto");
    EXPECT_EQ(near.session->peer().address, server->addresses().front());
    for (const auto* const text : {"one", "two"}) near.send(text);
    far.send("three");
    ASSERT_TRUE(far.eventually_has([&] { return far.messages.size() == 2; }));
    ASSERT_TRUE(near.eventually_has([&] { return near.messages.size() == 1; }));
    EXPECT_THAT(far.messages, ElementsAre("one", "two"));
    EXPECT_THAT(near.messages, ElementsAre("three"));

    far.session->close(1008, "enough");
    ASSERT_TRUE(near.eventually_has([&] { return near.closed.has_value(); }));
    EXPECT_EQ(near.closed->why, Ended::by_peer);
    EXPECT_EQ(near.closed->code, 1008);
    EXPECT_EQ(near.closed->text, "enough");
}

TEST_F(WebSocketClient, TriesEachAddress) {
    serve();
    const auto closed_port = std::move(*net::TcpListener::open(any_port, false)).local();
    connect({.addresses = {closed_port, server->addresses().front()}, .path = "/path"});
    EXPECT_TRUE(near.eventually_has([&] { return near.session != nullptr; }));
    EXPECT_EQ(near.failed, "");
}

TEST_F(WebSocketClient, ReportsWhyItFailed) {
    const auto closed_port = std::move(*net::TcpListener::open(any_port, false)).local();
    connect({.addresses = {closed_port}});
    EXPECT_EQ(failure(), "cannot connect to " + closed_port.text() + ": Connection refused");
    serve();
    near.failed.clear();
    connect({.path = "/other"});
    EXPECT_EQ(failure(), "no WebSocket at " + server->addresses().front().text() +
                             ": the server answered with HTTP status 404: this server has /path (a WebSocket)");
}

TEST_F(WebSocketClient, AServerThatNeverAnswersOrAnswersGarbage) {
    auto listener = std::move(*net::TcpListener::open(any_port, false));
    patience = 500ms;
    connect({.addresses = {listener.local()}});
    EXPECT_EQ(failure(), "no WebSocket at " + listener.local().text() + ": no answer in time");
    (void)listener.accept();

    patience = test::long_enough;
    near.failed.clear();
    connect({.addresses = {listener.local()}});
    net::TcpStream there;
    ASSERT_TRUE(eventually([&] {
        if (auto accepted = listener.accept()) there = std::move(*accepted);
        return static_cast<bool>(there);
    }));
    std::string garbage = "SSH-2.0-OpenSSH\r\n\r\n";
    const iovec piece{garbage.data(), garbage.size()};
    EXPECT_TRUE(there.write({&piece, 1}));
    EXPECT_EQ(failure(), "no WebSocket at " + listener.local().text() + ": the answer is not HTTP");
}

// RFC 6455, section 4.1.
TEST_F(WebSocketClient, ChecksTheAnswer) {
    auto listener = std::move(*net::TcpListener::open(any_port, false));
    const std::string upgrade = "Upgrade: WebSocket\r\n", connection = "Connection: keep-alive, upgrade\r\n";
    const auto why = [&](const std::string& lines) {
        near.failed.clear();
        connect({.addresses = {listener.local()}});
        answer(listener, lines);
        const auto text = failure();
        return text.substr(text.rfind(": ") + 2);
    };
    EXPECT_EQ(why(connection), "the server changes to another protocol");
    EXPECT_EQ(why(upgrade), "the server changes to another protocol");
    EXPECT_EQ(why("Upgrade: h2c\r\n" + connection), "the server changes to another protocol");
    EXPECT_EQ(why(upgrade + connection + "Sec-WebSocket-Extensions: permessage-deflate\r\n"),
              "the server chose an extension that was not offered");
    EXPECT_EQ(why(upgrade + connection + "X: " + std::string(9000, 'x') + "\r\n"), "the answer is too long");
    connect({.addresses = {listener.local()}});
    answer(listener, upgrade + connection);
    EXPECT_TRUE(near.eventually_has([&] { return near.session != nullptr; }));
}

// To look at an object of an exception, UBSan opens a pipe. Without descriptors, it takes the object for a bad one.
#if defined(__has_feature)
#if __has_feature(undefined_behavior_sanitizer)
#define MAVLOOM_NEEDS_DESCRIPTORS
#endif
#endif

// Asio opens descriptors of its own for the first socket or timer.
TEST(HttpThread, WithoutFreeDescriptorsIsAnErrorAndNoException) {
#ifdef MAVLOOM_NEEDS_DESCRIPTORS
    GTEST_SKIP() << "UBSan needs a descriptor to look at an exception; the run with the thread sanitizer has this test";
#endif
    const int lowest = ::dup(STDERR_FILENO);  // of the numbers that are free
    ::close(lowest);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    rlimit none = before;
    none.rlim_cur = static_cast<rlim_t>(lowest);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &none), 0);
    const auto thread = Thread::start();
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);

    ASSERT_FALSE(thread);
    EXPECT_EQ(thread.error().code, SetupCode::system);
    EXPECT_THAT(thread.error().text, HasSubstr("Too many open files"));
}

TEST_F(WebSocketClient, EndsAtAnyTime) {
    serve();
    for (int i = 0; i < 200; ++i) {
        connect({.path = "/path"});
        const bool opens = i % 4 != 0 || near.eventually_has([&] { return near.session != nullptr; });
        ASSERT_TRUE(opens);
        client.reset();
        const std::lock_guard lock(near.mutex);
        near.session.reset();
    }
    EXPECT_EQ(near.failed, "");
    EXPECT_FALSE(near.closed.has_value());
}

}  // namespace
}  // namespace mavloom::http
