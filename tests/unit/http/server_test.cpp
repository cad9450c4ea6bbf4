// SPDX-License-Identifier: MIT
#include "mavloom/http/server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "support/eventually.hpp"
#include "unit/http/raw_client.hpp"

namespace mavloom::http {
namespace {

using namespace std::chrono_literals;
using test::eventually;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

Response text(std::string body) { return {.body = std::make_shared<const std::string>(std::move(body))}; }

ServerOptions greeter() {
    ServerOptions options{.addresses = {any_port}};
    options.routes.push_back(
        {"/hello", [](const Request& request, const Respond& respond) { respond(text("hello " + request.query)); }});
    return options;
}

struct HttpServer : ::testing::Test {
    void serve(ServerOptions options) { server.emplace(std::move(*Server::listen(thread, std::move(options)))); }
    [[nodiscard]] RawClient client() const { return RawClient(server->addresses().front()); }
    [[nodiscard]] std::uint64_t count(Count what) const { return server->counters().value(what); }
    // The whole answer to one request.
    [[nodiscard]] std::string answer(const std::string& request) const {
        auto there = client();
        there.send(request);
        return there.read_until();
    }

    Thread thread = std::move(*Thread::start());
    std::optional<Server> server;
};

constexpr std::string_view get_hello = "GET /hello?you HTTP/1.1\r\nHost: localhost\r\n\r\n";
constexpr std::string_view close_hello = "GET /hello?you HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";

TEST_F(HttpServer, AnswersAndKeepsTheConnection) {
    serve(greeter());
    auto sut = client();
    sut.send(get_hello);
    const auto first = sut.read_until("hello you");
    sut.send(close_hello);
    const auto second = sut.read_until();

    EXPECT_THAT(first, StartsWith("HTTP/1.1 200 OK\r\nContent-Type: text/plain; charset=utf-8\r\nContent-Length: 9\r\n"
                                  "Connection: keep-alive\r\n"));
    EXPECT_THAT(first, HasSubstr("X-Content-Type-Options: nosniff\r\n"));
    EXPECT_THAT(first, HasSubstr("Content-Security-Policy: default-src 'self'"));
    EXPECT_THAT(second, EndsWith("\r\n\r\nhello you"));
    EXPECT_TRUE(sut.is_closed);
    EXPECT_EQ(count(Count::requests), 2u);
    EXPECT_EQ(count(Count::connections), 1u);
}

TEST_F(HttpServer, AnswersRequestsThatArriveTogetherOrInPieces) {
    serve(greeter());
    auto sut = client();
    sut.send(std::string(get_hello) + std::string(get_hello.substr(0, 10)));
    EXPECT_THAT(sut.read_until("hello you"), StartsWith("HTTP/1.1 200"));
    for (const char c : close_hello.substr(10)) sut.send({&c, 1});
    EXPECT_THAT(sut.read_until(), EndsWith("hello you"));
}

TEST_F(HttpServer, OldClientsAndHead) {
    serve(greeter());
    EXPECT_THAT(answer("GET /hello HTTP/1.0\r\n\r\n"), StartsWith("HTTP/1.0 200 OK\r\n"));
    const auto head = answer("HEAD /hello?you HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_THAT(head, HasSubstr("Content-Length: 9\r\n"));
    EXPECT_THAT(head, EndsWith("\r\n\r\n"));
}

TEST_F(HttpServer, RefusesByNameAndCounts) {
    auto options = greeter();
    options.web_sockets.push_back({"/socket", {}, {}, {}});
    serve(std::move(options));
    const std::string rest = "Connection: close\r\n\r\n";
    const auto wrong_path = answer("GET /other HTTP/1.1\r\nHost: localhost\r\n" + rest);
    EXPECT_THAT(wrong_path, StartsWith("HTTP/1.1 404 Not Found\r\n"));
    EXPECT_THAT(wrong_path, EndsWith("this server has /hello, /socket (a WebSocket)\n"));
    const auto wrong_method = answer("DELETE /hello HTTP/1.1\r\nHost: localhost\r\n" + rest);
    EXPECT_THAT(wrong_method, StartsWith("HTTP/1.1 405 Method Not Allowed\r\n"));
    EXPECT_THAT(wrong_method, HasSubstr("\r\nAllow: GET, HEAD\r\n"));
    EXPECT_THAT(answer("GET /hello HTTP/1.1\r\nHost: evil.example\r\n" + rest),
                StartsWith("HTTP/1.1 403 Forbidden\r\n"));
    const auto wrong_origin = answer("GET /hello HTTP/1.1\r\nHost: localhost\r\nOrigin: https://evil.example\r\n" + rest);
    EXPECT_THAT(wrong_origin, StartsWith("HTTP/1.1 403 Forbidden\r\n"));
    EXPECT_THAT(wrong_origin, EndsWith("pages of https://evil.example may not connect here\n"));
    EXPECT_THAT(answer("GET /socket HTTP/1.1\r\nHost: localhost\r\n" + rest),
                StartsWith("HTTP/1.1 426 Upgrade Required"));
    EXPECT_THAT(answer("GET /../../etc/passwd HTTP/1.1\r\nHost: localhost\r\n" + rest), StartsWith("HTTP/1.1 404"));
    EXPECT_THAT(answer("GET http://localhost/hello HTTP/1.1\r\nHost: localhost\r\n" + rest),
                StartsWith("HTTP/1.1 404"));

    EXPECT_EQ(count(Count::wrong_path), 3u);
    EXPECT_EQ(count(Count::wrong_method), 1u);
    EXPECT_EQ(count(Count::wrong_host), 1u);
    EXPECT_EQ(count(Count::wrong_origin), 1u);
    EXPECT_EQ(count(Count::bad_handshake), 1u);
}

// RFC 6750, sections 2.1 and 2.3: in the header, or in the query. A browser sends the cookie with what comes next.
TEST_F(HttpServer, WantsItsToken) {
    auto options = greeter();
    options.access.token = "0123456789abcdef";
    serve(std::move(options));
    const auto answer_to = [&](const std::string& path, const std::string& header) {
        return answer("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + header + "Connection: close\r\n\r\n");
    };
    const auto cookie = "mavloom-" + std::to_string(server->addresses().front().port()) + "=0123456789abcdef";

    const auto without = answer_to("/hello?you", "");
    const auto by_query = answer_to("/hello?you&token=0123456789abcdef", "");

    EXPECT_THAT(without, StartsWith("HTTP/1.1 401 Unauthorized\r\n"));
    EXPECT_THAT(without, HasSubstr("\r\nWWW-Authenticate: Bearer\r\n"));
    EXPECT_THAT(without, Not(HasSubstr("Set-Cookie")));
    EXPECT_THAT(by_query, EndsWith("\r\n\r\nhello you"));
    EXPECT_THAT(by_query, HasSubstr("\r\nSet-Cookie: " + cookie + "; HttpOnly; SameSite=Strict; Path=/\r\n"));
    EXPECT_THAT(answer_to("/hello?you", "Authorization: bearer 0123456789abcdef\r\n"), EndsWith("hello you"));
    EXPECT_THAT(answer_to("/hello?you", "Cookie: a=b; " + cookie + "\r\n"), EndsWith("hello you"));
    for (const std::string wrong : {"/hello?token=0123456789abcdeF", "/hello?token=0123456789abcde",
                                    "/hello?token=", "/hello?xtoken=0123456789abcdef", "/nowhere"})
        EXPECT_THAT(answer_to(wrong, ""), StartsWith("HTTP/1.1 401")) << wrong;
    for (const std::string wrong : {"Authorization: 0123456789abcdef\r\n", "Authorization: B\r\n",
                                    "Cookie: mavloom-1=0123456789abcdef\r\n", "Cookie: =;;=\r\n"})
        EXPECT_THAT(answer_to("/hello", wrong), StartsWith("HTTP/1.1 401")) << wrong;
    EXPECT_EQ(count(Count::wrong_token), 10u);
}

TEST_F(HttpServer, ATokenIsOfOneRequestOnly) {
    auto options = greeter();
    options.access.token = "0123456789abcdef";
    options.web_sockets.push_back({"/socket", {}, {}, {}});
    serve(std::move(options));
    auto sut = client();
    sut.send("GET /hello?you&token=0123456789abcdef HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_THAT(sut.read_until("hello you"), HasSubstr("Set-Cookie"));
    sut.send("GET /hello?you HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    const auto second = sut.read_until();
    EXPECT_THAT(second, StartsWith("HTTP/1.1 401"));
    EXPECT_THAT(second, Not(HasSubstr("Set-Cookie")));
    EXPECT_THAT(answer("GET /socket HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                       "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"),
                StartsWith("HTTP/1.1 401"));
}

// Fetch Standard, "CORS protocol": only the origin that the answer names may read it.
TEST_F(HttpServer, PagesOfListedOriginsMayReadAnswers) {
    auto options = greeter();
    options.access.origins = {"https://app.example.com"};
    serve(std::move(options));
    const auto answer_to = [&](const std::string& origin, const std::string& path = "/hello") {
        return answer("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + origin + "Connection: close\r\n\r\n");
    };
    const auto allows = HasSubstr("\r\nAccess-Control-Allow-Origin: https://app.example.com\r\nVary: Origin\r\n");
    const auto allows_none = ::testing::Not(HasSubstr("Access-Control"));
    EXPECT_THAT(answer_to("Origin: https://app.example.com\r\n"), allows);
    EXPECT_THAT(answer_to("Origin: https://app.example.com\r\n", "/other"), allows) << "the reason, too";
    const std::string own = "Origin: http://localhost\r\n";
    for (const auto& answered : {answer_to(""), answer_to(own)})
        EXPECT_THAT(answered,
                    ::testing::AllOf(StartsWith("HTTP/1.1 200"), allows_none, HasSubstr("\r\nVary: Origin\r\n")));
    EXPECT_THAT(answer_to("Origin: https://evil.example\r\n"),
                ::testing::AllOf(StartsWith("HTTP/1.1 403"), allows_none));
}

TEST_F(HttpServer, BoundsHeaderAndBody) {
    serve(greeter());
    const std::string huge(100'000, 'x');
    EXPECT_THAT(answer("GET /hello HTTP/1.1\r\nX: " + huge.substr(0, 9000) + "\r\n\r\n"),
                StartsWith("HTTP/1.1 431 Request Header Fields Too Large\r\n"));
    EXPECT_THAT(answer("GET /hello HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\n\r\nx"),
                StartsWith("HTTP/1.1 413 Payload Too Large\r\n"));
    EXPECT_THAT(
        answer("POST /hello HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n1\r\nx\r\n0\r\n\r\n"),
        StartsWith("HTTP/1.1 405 Method Not Allowed\r\n"));
    (void)answer("GET /hello HTTP/1.1\r\nX: " + huge);  // the answer may be lost with what was not read

    EXPECT_EQ(count(Count::header_size), 2u);
    EXPECT_EQ(count(Count::body_size), 1u);
    EXPECT_EQ(count(Count::wrong_method), 1u);
    EXPECT_THAT(answer(std::string(close_hello)), StartsWith("HTTP/1.1 200"));
}

TEST_F(HttpServer, DisconnectsWhatIsNotHttp) {
    serve(greeter());
    std::string tls("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11);
    for (const std::string& garbage : {std::string("\0\xffnot http\r\n\r\n", 13), tls, std::string("GET\r\n\r\n")})
        EXPECT_EQ(answer(garbage), "");
    EXPECT_EQ(count(Count::bad_request), 3u);
}

TEST_F(HttpServer, DisconnectsSlowLorisHalfRequestAndSilence) {
    auto options = greeter();
    options.limits.patience = 300ms;
    serve(std::move(options));
    auto silent = client(), half = client(), loris = client();
    half.send(get_hello.substr(0, 20));
    const auto begin = mono_now();
    for (int i = 0; i < 2000 && count(Count::timed_out) < 3; ++i) {  // a byte of the header every 20 ms
        loris.send(i == 0 ? "GET /hello HTTP/1.1\r\n" : "x");
        std::this_thread::sleep_for(20ms);
    }
    EXPECT_EQ(silent.read_until(), "");
    EXPECT_EQ(half.read_until(), "");
    EXPECT_EQ(loris.read_until(), "");
    EXPECT_EQ(count(Count::timed_out), 3u);
    EXPECT_LT(mono_now() - begin, 30s);
}

// A browser keeps its connection for a next request, which may never come.
TEST_F(HttpServer, AConnectionThatIsKeptAndNotUsedEndsWithoutBeingCounted) {
    auto options = greeter();
    options.limits.patience = 300ms;
    std::vector<Count> refused;
    options.on_refused = [&](const Refused& one) { refused.push_back(one.counter); };
    serve(std::move(options));
    auto kept = client(), begun = client();
    kept.send(get_hello);
    begun.send(std::string(get_hello) + "GET");
    EXPECT_THAT(kept.read_until(), EndsWith("hello you"));
    EXPECT_THAT(begun.read_until(), EndsWith("hello you"));
    server.reset();
    EXPECT_THAT(refused, ::testing::ElementsAre(Count::timed_out)) << "of the request that was begun";
}

TEST_F(HttpServer, AClientThatReadsNothingTakesNoMoreMemoryAndIsDisconnected) {
    auto options = greeter();
    options.limits.patience = 300ms;
    const auto large = std::make_shared<const std::string>(32'000'000, 'x');
    options.routes.push_back({"/large", [large](const Request&, const Respond& respond) { respond({.body = large}); }});
    serve(std::move(options));
    auto sut = client();
    for (int i = 0; i < 50; ++i) sut.send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n");

    EXPECT_TRUE(eventually([&] { return count(Count::timed_out) == 1; }));
    EXPECT_EQ(count(Count::requests), 1u);  // the next is read when the answer is sent
}

TEST_F(HttpServer, AThousandConnectionsDisplaceEachOther) {
    auto options = greeter();
    options.limits.clients = 8;
    options.limits.grace = {};
    serve(std::move(options));
    rlimit limit{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &limit), 0);
    limit.rlim_cur = limit.rlim_max;
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &limit), 0);
    std::vector<RawClient> clients;
    for (int i = 0; i < 1000; ++i) clients.push_back(client());
    EXPECT_THAT(answer(std::string(close_hello)), EndsWith("hello you"));
    EXPECT_EQ(count(Count::connections), 1001u);
    EXPECT_EQ(count(Count::displaced), 1001u - 8u);
    EXPECT_EQ(count(Count::turned_away), 0u);
}

// They first connect, and then send their requests.
TEST_F(HttpServer, ClientsThatConnectAtTheSameInstantAreAnswered) {
    auto options = greeter();
    options.limits.clients = 4;
    options.limits.web_sockets = 16;
    options.limits.grace = std::chrono::hours(1);
    serve(std::move(options));
    std::vector<RawClient> clients;
    for (int i = 0; i < 20; ++i) clients.push_back(client());
    EXPECT_TRUE(eventually([&] { return count(Count::connections) == 20; }));
    for (auto& one : clients) one.send(close_hello);
    for (auto& one : clients) EXPECT_THAT(one.read_until("hello you"), StartsWith("HTTP/1.1 200"));
    EXPECT_EQ(count(Count::displaced), 0u);
}

// A client that connects and sends nothing keeps no other one out, however short a time ago it came.
TEST_F(HttpServer, NewConnectionsBeyondBothLimitsDisplaceEachOther) {
    auto options = greeter();
    options.limits.clients = 4;
    options.limits.web_sockets = 4;
    options.limits.grace = std::chrono::hours(1);
    serve(std::move(options));
    std::vector<RawClient> clients;
    for (int i = 0; i < 20; ++i) clients.push_back(client());
    EXPECT_THAT(answer(std::string(close_hello)), EndsWith("hello you"));
    EXPECT_EQ(count(Count::displaced), 21u - 8u);
}

// Handlers may answer later, on any thread. Clients that wait for one are not displaced.
TEST_F(HttpServer, TurnsAwayWhenAllWaitForHandlers) {
    std::mutex mutex;
    std::vector<Respond> waiting;
    ServerOptions options{.addresses = {any_port}};
    options.limits.clients = 2;
    options.routes.push_back({"/later", [&](const Request&, const Respond& respond) {
                                  const std::lock_guard lock(mutex);
                                  waiting.push_back(respond);
                              }});
    serve(std::move(options));
    auto first = client(), second = client();
    for (auto* one : {&first, &second}) one->send("GET /later HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(eventually([&] {
        const std::lock_guard lock(mutex);
        return waiting.size() == 2;
    }));
    auto third = client();
    EXPECT_THAT(third.read_until(), StartsWith("HTTP/1.1 503"));
    waiting[0](text("first"));
    waiting[0](text("again"));  // has no effect
    waiting[1](text("second"));
    EXPECT_THAT(first.read_until("\r\n\r\nfirst"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(second.read_until("second"), StartsWith("HTTP/1.1 200"));
    EXPECT_EQ(count(Count::turned_away), 1u);
}

TEST_F(HttpServer, EndsWhileClientsWait) {
    std::promise<Respond> asked;
    ServerOptions options{.addresses = {any_port}};
    options.routes.push_back({"/never", [&](const Request&, const Respond& respond) { asked.set_value(respond); }});
    serve(std::move(options));
    auto waits = client(), idle = client();
    waits.send("GET /never HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const auto respond = asked.get_future().get();

    server.reset();

    EXPECT_EQ(waits.read_until(), "");
    EXPECT_EQ(idle.read_until(), "");
    respond(text("too late"));
}

TEST_F(HttpServer, TheThreadMayEndBeforeTheServer) {
    serve(greeter());
    auto sut = client();
    sut.send(get_hello);
    EXPECT_THAT(sut.read_until("hello you"), StartsWith("HTTP/1.1 200"));
    thread = std::move(*Thread::start());
    server.reset();
    EXPECT_EQ(sut.read_until(), "");
}

TEST_F(HttpServer, AllAddressesGetOnePort) {
    auto options = greeter();
    options.addresses = {any_port, *net::Address::parse("127.0.0.2", 0)};
    serve(std::move(options));
    ASSERT_EQ(server->addresses().size(), 2u);
    EXPECT_EQ(server->addresses()[1].port(), server->addresses()[0].port());
    EXPECT_EQ(server->addresses()[1].host_text(), "127.0.0.2");
}

TEST_F(HttpServer, NamesTheHolderOfAPort) {
    serve(greeter());
    auto options = greeter();
    options.addresses = server->addresses();
    const auto second = Server::listen(thread, std::move(options));
    ASSERT_FALSE(second);
    EXPECT_EQ(second.error().code, SetupCode::in_use);
    EXPECT_EQ(second.error().text, "cannot listen on TCP " + server->addresses().front().text() +
                                       ": Address already in use by this process");
}

TEST(HttpCounters, HaveNames) {
    EXPECT_EQ(Counters::name(Count::connections), "connections");
    EXPECT_EQ(Counters::name(Count::wrong_host), "wrong_host");
    EXPECT_EQ(Counters::name(Count::web_sockets), "web_sockets");
    EXPECT_EQ(Counters::name(Count::ws_lost), "ws_lost");
}

}  // namespace
}  // namespace mavloom::http
