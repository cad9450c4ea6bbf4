// SPDX-License-Identifier: MIT
// The server's WebSockets, with a peer that sends any bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <malloc.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "http/web_socket/frames.hpp"
#include "mavloom/http/server.hpp"
#include "support/eventually.hpp"
#include "unit/http/raw_client.hpp"

namespace mavloom::http {
namespace {

using namespace std::chrono_literals;
using namespace std::string_literals;
using test::eventually;
using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// RFC 6455, section 1.3: key and answer.
const std::string upgrade =
    "GET /socket HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n";
// Frames whose mask is 0.
std::string frame(int first_byte, const std::string& payload) {
    std::string all{static_cast<char>(first_byte)};
    if (payload.size() < 126) all += static_cast<char>(0x80 | payload.size());
    else all += {'\xfe', static_cast<char>(payload.size() >> 8), static_cast<char>(payload.size() & 0xff)};
    return all + "\0\0\0\0"s + payload;
}
std::string binary(const std::string& payload) { return frame(0x82, payload); }

struct WebSockets : ::testing::Test {
    auto locked(auto look) {
        const std::lock_guard lock(mutex);
        return look();
    }
    void serve(const SessionOptions& session, Access access = {}, std::vector<std::string> subprotocols = {}) {
        ServerOptions options{.addresses = {any_port}, .access = std::move(access)};
        options.limits.patience = patience;
        options.limits.web_sockets = 16;
        options.web_sockets.push_back({"/socket", std::move(subprotocols), session,
                                       [this](const std::shared_ptr<Session>& opened) { return take(opened); }});
        server.emplace(std::move(*Server::listen(thread, std::move(options))));
    }
    SessionEvents take(const std::shared_ptr<Session>& opened) {
        const std::lock_guard lock(mutex);
        sessions.push_back(opened);
        return {
            .on_message =
                [this](ByteView bytes, Kind kind) {
                    const std::lock_guard locked(mutex);
                    if (takes_nothing) return false;
                    messages.push_back((kind == Kind::text ? "text:" : "") + std::string(bytes.begin(), bytes.end()));
                    return true;
                },
            .on_sent =
                [this](std::size_t bytes) {
                    const std::lock_guard locked(mutex);
                    sent_bytes += bytes;
                },
            .on_closed =
                [this](const Closed& how) {
                    const std::lock_guard locked(mutex);
                    closed.push_back(how);
                }};
    }
    [[nodiscard]] RawClient client() const { return RawClient(server->addresses().front()); }
    [[nodiscard]] RawClient open(const std::string& headers = "") {
        const auto before = locked([&] { return sessions.size(); });
        auto there = client();
        there.send(upgrade + headers + "\r\n");
        EXPECT_THAT(there.read_until("\r\n\r\n"), StartsWith("HTTP/1.1 101 Switching Protocols\r\n"));
        EXPECT_TRUE(eventually([&] { return locked([&] { return sessions.size(); }) > before; }));
        return there;
    }
    [[nodiscard]] Closed await_closed() {
        EXPECT_TRUE(eventually([&] { return locked([&] { return !closed.empty(); }); }));
        return locked([&] { return closed.back(); });
    }
    [[nodiscard]] std::uint64_t count(Count what) const { return server->counters().value(what); }

    std::chrono::milliseconds patience = test::long_enough;
    std::mutex mutex;  // for the next five
    bool takes_nothing = false;
    std::size_t sent_bytes = 0;
    std::vector<std::shared_ptr<Session>> sessions;
    std::vector<std::string> messages;
    std::vector<Closed> closed;
    Thread thread = std::move(*Thread::start());
    std::optional<Server> server;
};

TEST_F(WebSockets, OpensAndReceives) {
    serve({.accepts = Accepts::both});
    auto sut = client();
    sut.send(upgrade + "\r\n");
    const auto answer = sut.read_until("\r\n\r\n");
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 101 Switching Protocols\r\n"));
    EXPECT_THAT(answer, HasSubstr("Sec-WebSocket-Accept: s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n"));

    const auto two = binary("one") + masked_hello;
    for (const char c : two) sut.send({&c, 1});
    sut.send(frame(0x02, "a") + frame(0x89, "ping") + frame(0x00, "") + frame(0x80, "b") + binary("") + binary("last"));
    EXPECT_EQ(sut.read_bytes(6), "\x8a\x04ping");
    ASSERT_TRUE(eventually([&] { return locked([&] { return messages.size() == 5; }); }));
    EXPECT_THAT(messages, ElementsAre("one", "text:Hello", "ab", "", "last"));
    EXPECT_EQ(sessions[0]->counters().messages_in.value(), 5u);
    EXPECT_EQ(sessions[0]->counters().bytes_in.value(), 14u);

    sut.send(frame(0x88,
                   "\x03\xe8"
                   "bye"s));
    EXPECT_EQ(sut.read_until().substr(0, 4), "\x88\x02\x03\xe8");
    const auto how = await_closed();
    EXPECT_EQ(how.why, Ended::by_peer);
    EXPECT_EQ(how.code, 1000);
    EXPECT_EQ(how.text, "bye");
    EXPECT_EQ(count(Count::web_sockets), 1u);
}

TEST_F(WebSockets, SendsByClass) {
    serve({});
    auto sut = open();
    auto& session = *sessions[0];
    session.push(bytes_of("binary"), 0, 0, mono_now());
    session.push(bytes_of("text"), 2, 7, mono_now(), Kind::text);
    session.flush();
    EXPECT_EQ(sut.read_bytes(14),
              "\x82\x06"
              "binary\x81\x04text");
    session.close(1001, "over");
    EXPECT_EQ(sut.read_bytes(8), "\x88\x06\x03\xe9over");
    sut.send(frame(0x88, "\x03\xe9"s));
    EXPECT_EQ(await_closed().why, Ended::by_us);
    EXPECT_EQ(session.counters().messages_out.value(), 2u);
    session.push(bytes_of("late"), 0, 0, mono_now());
    session.flush();
    EXPECT_EQ(session.queued_bytes(), 0u);
}

TEST_F(WebSockets, WhatHasLeftIsReported) {
    serve({});
    auto sut = open();
    sessions[0]->push(bytes_of("binary"), 0, 0, mono_now());
    sessions[0]->flush();
    EXPECT_TRUE(eventually([&] { return locked([&] { return sent_bytes == 6; }); }));
}

TEST_F(WebSockets, AMessageThatIsNotTakenComesAgainAndHoldsTheOthers) {
    serve({.silence = 500ms});
    auto sut = open();
    locked([&] { return takes_nothing = true; });
    sut.send(binary("one") + binary("two"));
    std::this_thread::sleep_for(1200ms);  // more than twice the silence, which would end a session
    sessions[0]->resume();
    EXPECT_THAT(locked([&] { return messages.size() + closed.size(); }), 0u);
    locked([&] { return takes_nothing = false; });
    sessions[0]->resume();
    ASSERT_TRUE(eventually([&] { return locked([&] { return messages.size() == 2; }); }));
    EXPECT_THAT(messages, ElementsAre("one", "two"));
}

TEST_F(WebSockets, MessagesThatAreHeldComeBeforeTheEnd) {
    serve({});
    const std::string close = frame(0x88, "\x03\xe8"s), fault = masked_hello;
    for (const auto& [last, why] : {std::pair{close, Ended::by_peer}, std::pair{fault, Ended::kind}}) {
        locked([&] { return takes_nothing = true; });
        auto sut = open();
        const auto session = locked([&] { return sessions.back(); });
        sut.send(binary("one") + binary("two") + last);
        ASSERT_TRUE(eventually([&] { return session->counters().messages_in.value() == 2; }));
        locked([&] { return takes_nothing = false; });
        session->resume();
        EXPECT_THAT(sut.read_until(), StartsWith("\x88"));
        EXPECT_EQ(await_closed().why, why);
        EXPECT_THAT(locked([&] { return std::exchange(messages, {}); }), ElementsAre("one", "two"));
    }
}

TEST_F(WebSockets, PacksBlocksIntoMessages) {
    serve({.pack_bytes = 10});
    auto sut = open();
    auto& session = *sessions[0];
    for (const auto* const block : {"1234", "567", "89", "a long one that stands alone", "z"})
        session.push(bytes_of(block), 0, 0, mono_now());
    session.flush();
    EXPECT_EQ(sut.read_bytes(11 + 30 + 3),
              "\x82\x09"
              "123456789\x82\x1c"
              "a long one that stands alone\x82\x01z");
    EXPECT_EQ(session.counters().messages_out.value(), 3u);
    EXPECT_EQ(session.counters().blocks_out.value(), 5u);
    EXPECT_EQ(session.counters().bytes_out.value(), 38u);
}

// The payloads of the binary messages, back to back, up to the close frame. Counts pongs.
struct Heard {
    std::string payload;
    int pongs = 0;
};
Heard hear_to_close(RawClient& client) {
    Heard heard;
    for (;;) {
        const auto head = client.read_bytes(2);
        if (head.size() != 2 || head[0] == '\x88') return heard;
        auto size = static_cast<std::size_t>(static_cast<unsigned char>(head[1]));
        if (size == 126) {
            const auto longer = client.read_bytes(2);
            size = static_cast<std::size_t>(static_cast<unsigned char>(longer[0]) << 8 |
                                            static_cast<unsigned char>(longer[1]));
        }
        const auto payload = client.read_bytes(size);
        if (head[0] == '\x82') heard.payload += payload;
        else if (head[0] == '\x8a' && payload == "ping") ++heard.pongs;
        else ADD_FAILURE() << "a frame that begins with " << static_cast<int>(head[0]);
    }
}

TEST_F(WebSockets, FlushWritesAtOnceAndTheThreadWritesTheRest) {
    serve({.queue = {.max_bytes = 8'000'000}, .pack_bytes = 1000, .writes_at_once = true, .silence = 60s});
    auto sut = open();
    auto& session = *sessions[0];
    session.push(bytes_of("first"), 0, 0, mono_now());
    std::size_t at_once = session.flush();  // the thread lends the socket once it has sent the answer to the handshake
    ASSERT_TRUE(eventually([&] { return locked([&] { return sent_bytes + at_once == 5; }); }));
    std::string pushed = "first";
    const auto push = [&] {
        const auto block = std::to_string(pushed.size()) + std::string(400, 'x');
        session.push(bytes_of(block), 0, 0, mono_now());
        at_once += session.flush();
        pushed += block;
    };
    ASSERT_TRUE(eventually([&] { return push(), at_once > 5; }));
    constexpr int pings = 20;
    for (int i = 0; i < 200 * pings; ++i) {
        if (i % 200 == 0) sut.send(frame(0x89, "ping"));
        push();
    }
    EXPECT_GT(session.queued_bytes(), 0u);  // the client has read nothing
    session.close(1000, "");
    const auto heard = hear_to_close(sut);
    EXPECT_TRUE(heard.payload == pushed);
    EXPECT_GE(heard.pongs, 1);
    EXPECT_LE(heard.pongs, pings);
    EXPECT_EQ(session.counters().bytes_out.value(), pushed.size());
    EXPECT_EQ(locked([&] { return sent_bytes; }) + at_once, pushed.size());
}

TEST_F(WebSockets, ChoosesTheSubprotocol) {
    serve({}, {}, {"foxglove.sdk.v1", "foxglove.websocket.v1"});
    const auto asks = [&](const std::string& offered) {
        auto sut = client();
        sut.send(upgrade + "Sec-WebSocket-Protocol: " + offered + "\r\n\r\n");
        return sut.read_until("\r\n\r\n");
    };
    EXPECT_THAT(asks("other,foxglove.websocket.v1 ,\tfoxglove.sdk.v1"),
                HasSubstr("Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n"));
    EXPECT_THAT(asks("foxglove.websocket.v1"), HasSubstr("Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"));
    EXPECT_THAT(asks("foxglove"), StartsWith("HTTP/1.1 400 Bad Request\r\n"));
    EXPECT_EQ(count(Count::bad_handshake), 1u);
    const auto without = open();
    ASSERT_TRUE(eventually([&] { return locked([&] { return sessions.size() == 3; }); }));
    EXPECT_EQ(sessions[0]->peer().subprotocol, "foxglove.sdk.v1");
}

TEST_F(WebSockets, ForeignPagesMayNotConnect) {
    serve({}, {.any_host = true, .origins = {"https://app.example.com"}});
    auto foreign = client();
    foreign.send(upgrade + "Origin: http://localhost\r\n\r\n");
    EXPECT_THAT(foreign.read_until("connect here\n"), StartsWith("HTTP/1.1 403 Forbidden\r\n"));
    EXPECT_EQ(count(Count::wrong_origin), 1u);
    const auto listed = open("Origin: https://app.example.com\r\n"), program = open();
    EXPECT_EQ(sessions[0]->peer().origin, "https://app.example.com");
    EXPECT_EQ(sessions[1]->peer().origin, "");
    EXPECT_EQ(sessions[1]->peer().address.host_text(), "127.0.0.1");
}

TEST_F(WebSockets, TextIsRefusedWhereOnlyBinaryIsAccepted) {
    serve({});
    auto sut = open();
    sut.send(masked_hello);
    EXPECT_EQ(sut.read_close(), close_code::wrong_kind);
    const auto how = await_closed();
    EXPECT_EQ(how.why, Ended::kind);
    EXPECT_EQ(how.text, "a text message came; only binary ones are accepted here");
    EXPECT_EQ(count(Count::ws_kind), 1u);
    EXPECT_TRUE(messages.empty());
}

TEST_F(WebSockets, BoundsMessages) {
    serve({.max_message = 1000, .max_fragments = 4});
    auto exact = open();
    exact.send(binary(std::string(1000, 'x')));
    exact.send(frame(0x02, "a") + frame(0x00, "b") + frame(0x00, "c") + frame(0x80, "d"));
    ASSERT_TRUE(eventually([&] { return locked([&] { return messages.size() == 2; }); }));
    auto large = open();
    large.send(binary(std::string(1001, 'x')));
    EXPECT_EQ(large.read_close(), close_code::too_big);
    EXPECT_EQ(await_closed().why, Ended::size);
    auto sum = open();
    sum.send(frame(0x02, std::string(600, 'x')) + frame(0x80, std::string(600, 'x')));
    EXPECT_EQ(sum.read_close(), close_code::too_big);
    auto fragments = open();
    fragments.send(frame(0x02, "a"));
    for (int i = 0; i < 4; ++i) fragments.send(frame(0x00, ""));
    EXPECT_EQ(fragments.read_close(), close_code::policy);
    ASSERT_TRUE(eventually([&] { return count(Count::ws_fragments) == 1; }));
    EXPECT_EQ(await_closed().text, "a message has more fragments than the limit");
    EXPECT_TRUE(eventually([&] { return count(Count::ws_size) == 2; }));
}

TEST_F(WebSockets, FramesThatBreakTheProtocol) {
    serve({.accepts = Accepts::both});
    const std::string unmasked = "\x82\x01x"s, reserved = frame(0x83, "x"), continues = frame(0x80, "x"),
                      long_ping = frame(0x89, std::string(126, 'x')), half_ping = frame(0x09, "x"),
                      compressed = frame(0xc2, "x"), interleaved = frame(0x02, "x") + binary("x"),
                      bad_close = frame(0x88, "x"), bad_text = frame(0x81, "\xff"s);
    std::uint64_t bad_ones = 0;
    for (const auto& bad :
         {unmasked, reserved, continues, long_ping, half_ping, compressed, interleaved, bad_close, bad_text}) {
        {
            auto sut = open();
            sut.send(bad);
            EXPECT_THAT(sut.read_close(), AnyOf(close_code::protocol, close_code::bad_text));
        }
        ++bad_ones;
        ASSERT_TRUE(eventually([&] { return count(Count::ws_protocol) == bad_ones; })) << bad_ones;
    }
    EXPECT_EQ(await_closed().why, Ended::protocol);
}

TEST_F(WebSockets, BadHandshakes) {
    serve({});
    const auto answer = [&](const std::string& request) {
        auto sut = client();
        sut.send(request);
        return sut.read_until();
    };
    const std::string no_key =
        "GET /socket HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Version: 13\r\n\r\n";
    EXPECT_THAT(answer(no_key), StartsWith("HTTP/1.1 400 Bad Request\r\n"));
    EXPECT_THAT(answer(upgrade + "\r\n" + binary("too early")), StartsWith("HTTP/1.1 400 Bad Request\r\n"));
    auto old = upgrade;
    old.replace(old.find(": 13"), 4, ": 8");
    EXPECT_THAT(answer(old + "\r\n"), HasSubstr("Sec-WebSocket-Version: 13\r\n"));
    EXPECT_EQ(count(Count::bad_handshake), 3u);
    EXPECT_TRUE(sessions.empty());
}

TEST_F(WebSockets, HalfAHandshakeTimesOut) {
    patience = 300ms;
    serve({});
    auto sut = client();
    sut.send(upgrade);
    EXPECT_EQ(sut.read_until(), "");
    EXPECT_EQ(count(Count::timed_out), 1u);
    EXPECT_TRUE(sessions.empty());
}

TEST_F(WebSockets, APeerThatAnswersNoPingGoes) {
    serve({.silence = 1s});
    auto answers = open(), silent = open();
    EXPECT_EQ(answers.read_bytes(2), "\x89\x00"s);
    answers.send(frame(0x8a, ""));
    EXPECT_EQ(await_closed().text, "no answer to a ping");
    EXPECT_EQ(silent.read_until(), "\x89\x00"s);
    answers.send(frame(0x89, "still here"));
    EXPECT_THAT(answers.read_until("still here"), ::testing::EndsWith("\x8a\x0astill here"));
}

// A peer that reads but sends nothing gets pings although telemetry flows.
TEST_F(WebSockets, APeerThatOnlyReadsIsPinged) {
    serve({.silence = 200ms});
    auto sut = open();
    EXPECT_TRUE(eventually([&] {
        sessions[0]->push(bytes_of("x"), 2, 1, mono_now());
        sessions[0]->flush();
        return count(Count::ws_silent) != 0;
    }));
    EXPECT_THAT(sut.read_until(), HasSubstr("\x89\x00"s));
    EXPECT_EQ(count(Count::ws_silent), 1u);
}

TEST_F(WebSockets, APeerThatReadsNothingHarmsOnlyItself) {
    serve({.silence = 60s});
    auto stalled = open(), reads = open();
    const auto before = ::mallinfo2().uordblks;
    const std::string telemetry(200, 't');
    std::uint64_t commands = 0;
    for (int i = 0; i < 200'000; ++i) {
        sessions[0]->push(bytes_of(telemetry), 2, 1 + static_cast<std::uint64_t>(i % 100), mono_now());
        if (i % 1000 == 0) sessions[0]->push(bytes_of("command"), 0, 0, mono_now()), ++commands;
        sessions[0]->flush();
    }
    EXPECT_LT(::mallinfo2().uordblks, before + 1'000'000);
    const auto& counters = sessions[0]->counters();
    EXPECT_GT(counters.dropped[2].value(), 100'000u);
    EXPECT_EQ(counters.dropped[0].value(), 0u);
    EXPECT_EQ(counters.dropped_full.value() + counters.dropped_old.value(), counters.dropped[2].value());

    sessions[1]->push(bytes_of("still"), 0, 0, mono_now());
    sessions[1]->flush();
    EXPECT_EQ(reads.read_bytes(7), "\x82\x05still");
    sessions[0]->close(1000, "");
    const auto all = stalled.read_until("\x88\x02\x03\xe8");
    std::uint64_t arrived = 0;
    for (auto at = all.find("\x82\x07"
                            "command");
         at != std::string::npos; at = all.find("\x82\x07"
                                                "command",
                                                at + 1))
        ++arrived;
    EXPECT_EQ(arrived, commands);
}

// Its socket never takes our close frame.
TEST_F(WebSockets, APeerThatSendsButReadsNothingIsClosed) {
    patience = 1s;
    serve({.silence = 60s});
    auto sut = open();
    const std::string telemetry(200, 't');
    for (int i = 0; i < 100'000; ++i) {
        sessions[0]->push(bytes_of(telemetry), 2, 1 + static_cast<std::uint64_t>(i % 100), mono_now());
        sessions[0]->flush();
    }
    EXPECT_GT(sessions[0]->queued_bytes(), 0u);
    sessions[0]->close(1000, "");
    EXPECT_TRUE(eventually([&] {
        sut.send(binary("x"));
        return locked([&] { return !closed.empty(); });
    }));
    EXPECT_EQ(await_closed().why, Ended::by_us);
    EXPECT_EQ(await_closed().text, "the far side did not close in time");
}

TEST_F(WebSockets, CloseInTheMiddle) {
    serve({});
    { open().send(binary("a message").substr(0, 9)); }
    EXPECT_EQ(await_closed().why, Ended::lost);
    EXPECT_EQ(await_closed().text, "closed by the far side");
    EXPECT_TRUE(eventually([&] { return count(Count::ws_lost) == 1; }));
    EXPECT_TRUE(messages.empty());
}

TEST_F(WebSockets, AreLimited) {
    serve({});
    std::vector<RawClient> clients;
    clients.reserve(16);
    for (int i = 0; i < 16; ++i) clients.push_back(open());
    auto sut = client();
    sut.send(upgrade + "\r\n");
    EXPECT_THAT(sut.read_until("too many WebSockets are open\n"), StartsWith("HTTP/1.1 503 Service Unavailable\r\n"));
    EXPECT_EQ(count(Count::turned_away), 1u);
    clients.pop_back();
    EXPECT_EQ(await_closed().why, Ended::lost);
    (void)open();
}

// Peers that never close keep nobody out.
TEST_F(WebSockets, ThoseThatAreClosingTakeNoPlaceAndBeyondABoundTheOldestGo) {
    serve({});
    std::vector<RawClient> clients;
    clients.reserve(52);
    for (int i = 0; i < 52; ++i) {
        clients.push_back(open());
        locked([&] { return sessions.back(); })->close(1000, "");
    }
    const auto is_open = [](const RawClient& one) {
        char byte = 0;
        return ::recv(one.fd(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) != 0;
    };
    for (auto& one : clients) EXPECT_EQ(one.read_bytes(4), "\x88\x02\x03\xe8") << "1000: closed";
    EXPECT_TRUE(eventually([&] { return !is_open(clients[3]); }));
    EXPECT_EQ(std::ranges::count_if(clients, is_open), 48);
    EXPECT_TRUE(is_open(clients[4]));
}

TEST_F(WebSockets, EndWithTheServer) {
    serve({});
    auto sut = open();
    server.reset();
    EXPECT_EQ(sut.read_until(), "\x88\x02\x03\xe9");  // 1001: going away
    EXPECT_TRUE(closed.empty());
    sessions[0]->push(bytes_of("late"), 0, 0, mono_now());
    sessions[0]->flush();
    sessions[0]->close(1000, "late");
}

}  // namespace
}  // namespace mavloom::http
