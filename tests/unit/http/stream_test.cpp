// SPDX-License-Identifier: MIT
// Answers without a length: who ends them, and what a client that does not read costs.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "mavloom/http/server.hpp"
#include "support/eventually.hpp"
#include "unit/http/raw_client.hpp"

namespace mavloom::http {
namespace {

using namespace std::chrono_literals;
using test::eventually;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

struct HttpStream : ::testing::Test {
    void serve(SessionOptions session = {}) {
        ServerOptions options{.addresses = {any_port}};
        options.limits.web_sockets = 2;
        options.streams.push_back({"/lines", "text/plain", std::move(session),
                                   [this](const Request& request) { return open(request.query); }});
        server.emplace(std::move(*Server::listen(thread, std::move(options))));
    }
    SetupResult<StreamRoute::Open> open(const std::string& query) {
        if (!query.empty()) return setup_error(SetupCode::usage, "there are no options");
        return [this](const std::shared_ptr<Session>& session) {
            const std::lock_guard lock(mutex);
            newest = session;
            return SessionEvents{.on_closed = [this](const Closed& closed) {
                why = closed.why;
                ++closed_sessions;
            }};
        };
    }
    // The session of the request that was sent last.
    std::shared_ptr<Session> session() {
        std::shared_ptr<Session> found;
        EXPECT_TRUE(eventually([&] {
            const std::lock_guard lock(mutex);
            found = std::exchange(newest, nullptr);
            return found != nullptr;
        }));
        return found;
    }
    static void push(Session& session, std::string_view line) {
        session.push(bytes_of(line), 1, 0, mono_now());
        session.flush();
    }
    [[nodiscard]] RawClient ask(std::string_view path = "/lines", std::string_view method = "GET") const {
        RawClient client(server->addresses().front());
        client.send(std::string(method) + " " + std::string(path) + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
        return client;
    }
    [[nodiscard]] std::uint64_t count(Count what) const { return server->counters().value(what); }

    std::mutex mutex;
    std::shared_ptr<Session> newest;
    std::atomic<int> closed_sessions = 0;
    std::atomic<Ended> why{};
    Thread thread = std::move(*Thread::start());
    std::optional<Server> server;
};

TEST_F(HttpStream, SendsLinesUntilTheServerClosesIt) {
    serve();
    auto client = ask();
    const auto lines = session();
    push(*lines, "one\n");
    const auto first = client.read_until("one\n");
    push(*lines, "two\n");
    lines->close(0, "");

    EXPECT_THAT(first, StartsWith("HTTP/1.1 200 OK\r\nContent-Type: text/plain\r\nCache-Control: no-store\r\n"
                                  "Connection: close\r\n"));
    EXPECT_THAT(first, Not(HasSubstr("Content-Length")));
    EXPECT_THAT(first, EndsWith("\r\n\r\none\n"));
    EXPECT_EQ(client.read_until(), "two\n");
    EXPECT_TRUE(client.is_closed);
    EXPECT_TRUE(eventually([&] { return closed_sessions == 1; }));
    EXPECT_EQ(count(Count::streams), 1u);
}

TEST_F(HttpStream, EndsWhenTheClientLeaves) {
    serve();
    auto client = std::make_optional(ask());
    const auto lines = session();
    client.reset();
    EXPECT_TRUE(eventually([&] { return closed_sessions == 1; }));
    EXPECT_EQ(why, Ended::by_peer);
    push(*lines, "too late\n");
}

TEST_F(HttpStream, RefusesAWrongQueryAndAnswersHeadAtOnce) {
    serve();
    auto wrong = ask("/lines?x=1");
    EXPECT_THAT(wrong.read_until(), EndsWith("\r\n\r\nthere are no options\n"));
    EXPECT_EQ(count(Count::wrong_query), 1u);
    auto head = ask("/lines", "HEAD");
    EXPECT_THAT(head.read_until(), StartsWith("HTTP/1.1 200 OK\r\n"));
    EXPECT_EQ(count(Count::streams), 0u);
}

TEST_F(HttpStream, CountsAsAWebSocketForTheLimit) {
    serve();
    auto first = ask(), second = ask();
    EXPECT_TRUE(eventually([&] { return count(Count::streams) == 2; }));
    auto third = ask();
    EXPECT_THAT(third.read_until(), StartsWith("HTTP/1.1 503"));
}

TEST_F(HttpStream, AClientThatReadsNothingLosesLinesAndIsDisconnected) {
    serve({.silence = 150ms});
    auto client = ask();
    const auto lines = session();
    const std::string line(1000, 'x');
    EXPECT_TRUE(eventually([&] {
        for (int i = 0; i < 100; ++i) push(*lines, line);
        return closed_sessions == 1;
    }));
    EXPECT_EQ(why, Ended::silent);
    EXPECT_GT(lines->counters().dropped_full.value(), 0u);
    EXPECT_LE(lines->queued_bytes(), 192u * 1024u);
    EXPECT_EQ(count(Count::timed_out), 1u);
}

TEST_F(HttpStream, EndsWithTheServer) {
    serve();
    auto client = ask();
    const auto lines = session();
    server.reset();
    EXPECT_THAT(client.read_until(), StartsWith("HTTP/1.1 200"));
    EXPECT_TRUE(client.is_closed);
    push(*lines, "too late\n");
    EXPECT_EQ(closed_sessions, 0);
}

}  // namespace
}  // namespace mavloom::http
