// SPDX-License-Identifier: MIT
// wsin and wsout between two Links of this process.
#include "mavloom/ws/transport.hpp"

#include <algorithm>
#include <future>

#include "unit/http/raw_client.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::link {
namespace {

using namespace testing;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::StartsWith;

bool same_byte(char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; }

class WebSocketLinks : public ::testing::Test {
protected:
    static void SetUpTestSuite() { ws::register_transports(); }
    void connect(const std::string& query = "", const std::string& path = "") {
        in = near.add("wsin://127.0.0.1:0" + path + query);
        out = far.add(fmt::format("wsout://127.0.0.1:{}{}", near.port(in), path));
        ASSERT_TRUE(until([&] { return !far.recorder.ups.empty() && !near.recorder.ups.empty(); }, near, far));
    }
    // Sends this request and returns the first line of the answer.
    std::string answer_to(const std::string& request) {
        http::RawClient client(*net::Address::parse("127.0.0.1", near.port(in)));
        client.send(request);
        std::string line = client.read_until("\r\n");
        near.links->refresh_counters();
        return line;
    }
    static std::string handshake(const std::string& path, const std::string& headers = "") {
        return fmt::format(
            "GET {} HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n{}\r\n",
            path, headers);
    }
    [[nodiscard]] const EndpointCounters& counters() const { return *near.info(in).counters; }

    Node near, far;
    EndpointId in, out;
};

TEST_F(WebSocketLinks, CarryFramesBothWaysInOrder) {
    connect("?idle=60", "/mavlink");
    Bytes sent;
    for (int i = 0; i < 500; ++i) {
        ASSERT_EQ(far.links->send(out, view(attitude(static_cast<std::uint8_t>(i)))), 1u);
        sent = std::move(sent) + attitude(static_cast<std::uint8_t>(i));
    }
    ASSERT_TRUE(until([&] { return near.recorder.frames.size() == 500; }, near, far));
    EXPECT_EQ(near.recorder.bytes(), sent);
    ASSERT_EQ(near.links->send(in, view(heartbeat(1, 255))), 1u);
    ASSERT_TRUE(until([&] { return far.recorder.frames.size() == 1; }, near, far));
    EXPECT_EQ(far.recorder.bytes(), heartbeat(1, 255));
    ASSERT_TRUE(until([&] { return !far.links->pending() && !near.links->pending(); }, near, far));
    EXPECT_EQ(far.counters(far.recorder.ups[0].first).frames_out.value(), 500u);
    EXPECT_THAT(near.recorder.ups[0].second, HasSubstr("/mavlink#127.0.0.1:"));
}

TEST_F(WebSocketLinks, ComeBackAfterTheServerWasAway) {
    connect();
    const auto port = near.port(in);
    near.links->remove(in);
    ASSERT_TRUE(until([&] { return !far.recorder.downs.empty(); }, far));
    in = near.add(fmt::format("wsin://127.0.0.1:{}", port));
    ASSERT_TRUE(until([&] { return far.recorder.ups.size() == 2; }, near, far));
    EXPECT_EQ(far.info(out).counters->reconnects.value(), 1u);
}

TEST_F(WebSocketLinks, AMissingServerIsReportedOnceAndCalledAgain) {
    out = far.add("wsout://127.0.0.1:1");
    ASSERT_TRUE(until([&] { return !far.recorder.notices.empty(); }, far));
    EXPECT_THAT(far.recorder.notices[0], HasSubstr("trying again"));
    EXPECT_THAT(near.refused("wsout://127.0.0.1:1?required=true").text, HasSubstr("127.0.0.1:1"));
}

TEST_F(WebSocketLinks, APortInUseIsAnError) {
    in = near.add("wsin://127.0.0.1:0");
    EXPECT_EQ(far.refused(fmt::format("wsin://127.0.0.1:{}", near.port(in))).code, SetupCode::in_use);
}

TEST_F(WebSocketLinks, AWrongPathGetsTheRightOne) {
    in = near.add("wsin://127.0.0.1:0/mavlink");
    EXPECT_THAT(answer_to(handshake("/other")), StartsWith("HTTP/1.1 404"));
    EXPECT_EQ(counters().bad_handshake.value(), 1u);
}

TEST_F(WebSocketLinks, APageOfSomebodyElseIsRefused) {
    in = near.add("wsin://127.0.0.1:0?origin=https://app.example.com");
    EXPECT_THAT(answer_to(handshake("/", "Origin: https://evil.example\r\n")), StartsWith("HTTP/1.1 403"));
    EXPECT_THAT(answer_to(handshake("/", fmt::format("Origin: http://127.0.0.1:{}\r\n", near.port(in)))),
                StartsWith("HTTP/1.1 403"));
    EXPECT_EQ(counters().wrong_origin.value(), 2u);
}

TEST_F(WebSocketLinks, AListedPageIsAStrangerUnlessTrusted) {
    for (const auto& [query, rank] : {std::pair("?origin=https://app.example.com", Rank::stranger),
                                      std::pair("?origin=*&trusted=true", Rank::own)}) {
        in = near.add(std::string("wsin://127.0.0.1:0") + query);
        http::RawClient client(*net::Address::parse("127.0.0.1", near.port(in)));
        client.send(handshake("/", "Origin: https://app.example.com\r\n"));
        EXPECT_THAT(client.read_until("\r\n"), StartsWith("HTTP/1.1 101"));
        near.recorder.ups.clear();
        ASSERT_TRUE(until([&] { return !near.recorder.ups.empty(); }, near));
        EXPECT_EQ(near.links->rank(near.recorder.ups[0].first), rank) << query;
    }
}

TEST_F(WebSocketLinks, TextEndsTheConnectionAndIsCounted) {
    in = near.add("wsin://127.0.0.1:0");
    http::RawClient client(*net::Address::parse("127.0.0.1", near.port(in)));
    client.send(handshake("/"));
    EXPECT_THAT(client.read_until("\r\n\r\n"), StartsWith("HTTP/1.1 101"));
    client.send(http::masked_hello);
    ASSERT_TRUE(until([&] { return !near.recorder.downs.empty(); }, near));
    EXPECT_THAT(near.recorder.downs[0].second, HasSubstr("only binary ones are accepted here"));
    near.links->refresh_counters();
    EXPECT_EQ(counters().bad_message.value(), 1u);
}

TEST_F(WebSocketLinks, GarbageInsteadOfAHandshakeIsCounted) {
    in = near.add("wsin://127.0.0.1:0");
    (void)answer_to("\xfd\x09\x01\x02\r\n\r\n");
    EXPECT_EQ(counters().bad_handshake.value(), 1u);
    ASSERT_TRUE(until([&] { return near.recorder.notices.size() == 2; }, near));
    EXPECT_THAT(near.recorder.notices[1], HasSubstr("was refused: it sent no HTTP; it is wsout that calls here"));
}

TEST_F(WebSocketLinks, AClientThatNeverReadsLosesOldTelemetryAndNothingElse) {
    in = near.add("wsin://127.0.0.1:0?queue_bytes=64k");
    http::RawClient client(*net::Address::parse("127.0.0.1", near.port(in)));
    client.send(handshake("/"));
    ASSERT_TRUE(until([&] { return !near.recorder.ups.empty(); }, near));
    const LinkId link = near.recorder.ups[0].first;
    for (int i = 0; near.counters(link).queue_bytes.value() < 10'000; ++i) {
        near.links->send(in, view(frame_bytes(131, static_cast<std::uint8_t>(i))));
        near.poll();
    }
    const Bytes last = heartbeat(7);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(near.links->send(in, view(last)), 1u);
    EXPECT_LE(near.links->queued_bytes(in), 65'536u);
    auto reader = std::async(std::launch::async, [&] {
        std::string all;
        while (!client.is_closed) all += client.read_bytes(4096);
        return all;
    });
    ASSERT_TRUE(until([&] { return !near.links->pending(); }, near));
    near.links->remove(in);
    const std::string got = reader.get();
    std::size_t arrived = 0;
    for (auto at = got.begin();; ++at, ++arrived) {
        at = std::search(at, got.end(), last.begin(), last.end(), same_byte);
        if (at == got.end()) break;
    }
    EXPECT_EQ(arrived, 100u);
}

}  // namespace
}  // namespace mavloom::link
