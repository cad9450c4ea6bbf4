// SPDX-License-Identifier: MIT
// Times and rules: docs/guide/route.md, "The router's own heartbeat".
#include "router/own_messages.hpp"

#include <gmock/gmock.h>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/request_data_stream.hpp"
#include "mavloom/wire/frame_writer.hpp"

namespace mavloom::router {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr LinkId first{1}, second{2};
constexpr MonoTime start{1000s};

struct Sent {
    std::uint32_t link, id;
    std::uint8_t system, component, sequence;
    friend bool operator==(const Sent&, const Sent&) = default;
};

config::RouterConfig config_of(std::pair<std::uint8_t, std::uint8_t> own, std::uint16_t streams_hz = 0) {
    return {.heartbeat = own, .request_streams_hz = streams_hz};
}

struct OwnMessagesAtWork {
    explicit OwnMessagesAtWork(const config::RouterConfig& config)
        : sut(dialect::default_dialect().wire_table(), config,
              {[this](LinkId link, const wire::FrameView& frame) {
                   sent.push_back(
                       {link.value, frame.id().value, frame.system().value, frame.component().value, frame.sequence()});
                   return takes;
               },
               [this](LinkId) { return answered; }}) {}

    // Returns what is sent from `from` on for `length`. Runs it whenever it asks to be run.
    std::vector<Sent> run(MonoTime from, Nanoseconds length) {
        sent.clear();
        for (MonoTime now = from; now < from + length; now = std::max(sut.next_due(), now + 1ms)) sut.send_due(now);
        return sent;
    }
    void hears_heartbeat(LinkId link, std::uint8_t autopilot) {
        std::array<std::uint8_t, msg::Heartbeat::max_length> payload;
        (void)msg::Heartbeat{.type = 2, .autopilot = autopilot, .mavlink_version = 3}.encode(payload);
        wire::FrameBuffer buffer;
        const auto& table = dialect::default_dialect().wire_table();
        sut.on_heartbeat(link,
                         wire::write_frame(buffer, {.sequence = 0, .source = {SystemId{7}, ComponentId{1}}},
                                           *table.find(msg::Heartbeat::id), payload),
                         start);
    }

    bool takes = true, answered = false;
    std::vector<Sent> sent;
    OwnMessages sut;
};

TEST(OwnMessages, GoWhereTheEndpointInitiatesContact) {
    for (const auto* calls : {"udpout://127.0.0.1:1", "udpbcast://10.0.0.255:1", "udpmcast://239.0.0.1:1",
                              "tcpout://127.0.0.1:1", "serial:///dev/ttyS0"}) {
        EXPECT_TRUE(wants_heartbeat(*endpoint::parse_endpoint(calls))) << calls;
        EXPECT_FALSE(wants_heartbeat(*endpoint::parse_endpoint(std::string(calls) + "?heartbeat=false"))) << calls;
    }
    for (const auto* waits : {"udpin://127.0.0.1:1", "tcpin://127.0.0.1:1"}) {
        EXPECT_FALSE(wants_heartbeat(*endpoint::parse_endpoint(waits))) << waits;
        EXPECT_TRUE(wants_heartbeat(*endpoint::parse_endpoint(std::string(waits) + "?heartbeat=true"))) << waits;
    }
    EXPECT_FALSE(wants_heartbeat(*endpoint::parse_endpoint("udpout://127.0.0.1:1?tap=true")));
}

TEST(OwnMessages, TenTimesASecondUntilAnsweredThenOnce) {
    OwnMessagesAtWork router(config_of({255, 191}));
    router.sut.add(first, true, start);

    EXPECT_EQ(router.run(start, 2s).size(), 20u);
    EXPECT_EQ(router.sent[5], (Sent{1, 0, 255, 191, 5}));
    router.answered = true;
    EXPECT_EQ(router.run(start + 2s, 10s).size(), 10u);
    EXPECT_EQ(router.sut.heartbeats_sent(), 30u);
}

TEST(OwnMessages, AreNoneOnALinkThatWantsNone) {
    OwnMessagesAtWork router(config_of({255, 191}));
    router.sut.add(first, false, start);

    EXPECT_EQ(router.sut.next_due(), MonoTime::max());
    EXPECT_THAT(router.run(start, 5s), IsEmpty());
}

TEST(OwnMessages, AreNoneWithoutAnId) {
    OwnMessagesAtWork router(config::RouterConfig{});
    router.sut.add(first, true, start);
    router.hears_heartbeat(first, 3);

    EXPECT_EQ(router.sut.next_due(), MonoTime::max());
    EXPECT_THAT(router.run(start, 5s), IsEmpty());
}

TEST(OwnMessages, AStreamRequestGoesToALinkWithoutHeartbeatsToo) {
    OwnMessagesAtWork router(config_of({42, 191}, 4));
    router.sut.add(first, false, start);
    router.sut.add(second, true, start);

    router.hears_heartbeat(first, 3);
    router.hears_heartbeat(first, 3);
    router.hears_heartbeat(first, 12);  // PX4
    router.hears_heartbeat(LinkId{9}, 3);

    EXPECT_THAT(router.sent, ElementsAre(Sent{1, 66, 42, 191, 0}));
}

TEST(OwnMessages, OneSequenceForAllThatALinkGets) {
    OwnMessagesAtWork router(config_of({42, 191}, 4));
    router.sut.add(first, true, start);
    router.sut.send_due(start);
    router.hears_heartbeat(first, 3);
    router.sut.send_due(start + 100ms);

    EXPECT_THAT(router.sent, ElementsAre(Sent{1, 0, 42, 191, 0}, Sent{1, 66, 42, 191, 1}, Sent{1, 0, 42, 191, 2}));
}

TEST(OwnMessages, AnotherIdStartsOver) {
    OwnMessagesAtWork router(config_of({255, 191}));
    router.sut.add(first, true, start);
    (void)router.run(start, 1s);
    router.sut.configure(config_of({254, 1}));

    EXPECT_EQ(router.run(start + 1s, 100ms), (std::vector<Sent>{{1, 0, 254, 1, 0}}));
    router.sut.configure({});
    EXPECT_THAT(router.run(start + 2s, 1s), IsEmpty());
}

TEST(OwnMessages, ALinkThatWentGetsNone) {
    OwnMessagesAtWork router(config_of({255, 191}));
    router.sut.add(first, true, start);
    router.sut.remove(first);

    EXPECT_THAT(router.run(start, 1s), IsEmpty());
}

}  // namespace
}  // namespace mavloom::router
