// SPDX-License-Identifier: MIT
// Expected values: the specification of the Foxglove WebSocket protocol. tests/system/test_web.py uses other people's
// readers.
#include "web/clients/foxglove.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "support/golden_frames.hpp"
#include "unit/feed/fixture.hpp"

namespace mavloom::web::foxglove {
namespace {

using namespace feed::testing;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Foxglove, ReadsRequests) {
    const auto subscribe = parse(R"({"op":"subscribe","subscriptions":[{"id":0,"channelId":3},{"id":7,"channelId":1}]})");
    ASSERT_TRUE(subscribe);
    ASSERT_EQ(subscribe->subscribe.size(), 2u);
    EXPECT_EQ(subscribe->subscribe[1].id, 7u);
    EXPECT_EQ(subscribe->subscribe[1].channel, 1u);
    const auto unsubscribe = parse(R"({"op":"unsubscribe","subscriptionIds":[7,4294967295]})");
    ASSERT_TRUE(unsubscribe);
    EXPECT_THAT(unsubscribe->unsubscribe, ElementsAre(7u, 4294967295u));
}

TEST(Foxglove, NamesOperationsThatItDoesNotSupport) {
    const auto request = parse(R"({"op":"getParameters","parameterNames":[],"id":"x"})");
    ASSERT_TRUE(request);
    EXPECT_TRUE(request->subscribe.empty() && request->unsubscribe.empty());
    EXPECT_EQ(request->unknown_op, "getParameters");
    EXPECT_EQ(parse(R"({"op":"unsubscribe","subscriptionIds":[7]})")->unknown_op, "");
}

TEST(Foxglove, RefusesWhatIsNoRequest) {
    for (const std::string_view text :
         {"", "subscribe", "[]", "{}", R"({"op":1})", R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":{}})",
          R"({"op":"subscribe","subscriptions":[7]})", R"({"op":"subscribe","subscriptions":[{"id":1}]})",
          R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
          R"({"op":"subscribe","subscriptions":[{"id":4294967296,"channelId":1}]})",
          R"({"op":"unsubscribe","subscriptionIds":["1"]})", R"({"op":"unsubscribe"})"})
        EXPECT_FALSE(parse(text)) << text;
}

TEST(Foxglove, RefusesDeepValues) {
    const std::string deep(1 << 20, '[');
    EXPECT_FALSE(parse(deep));
    EXPECT_FALSE(parse(R"({"op":"subscribe","subscriptions":)" + deep));
    const std::string closed(1 << 18, ']');
    EXPECT_FALSE(parse(R"({"op":"subscribe","subscriptions":)" + deep.substr(0, closed.size()) + closed + "}"));
}

TEST(Foxglove, AdvertisesPieceByPiece) {
    observe::LatestTable table(dialect::default_dialect());
    Channels channels(10);
    channels.take(*table.add({.frame = view(test::heartbeat_v2)}));
    channels.take(*table.add({.frame = view(test::attitude_v2)}));
    std::uint32_t last = 0;
    const auto first = advertise(channels, last, 1);
    EXPECT_EQ(last, 1u);
    EXPECT_THAT(first,
                HasSubstr(R"("id":1,"topic":"/1/1/HEARTBEAT","encoding":"cdr","schemaName":"mavlink/msg/Heartbeat")"));
    EXPECT_THAT(first, ::testing::Not(HasSubstr("ATTITUDE")));
    EXPECT_THAT(advertise(channels, last, 1), HasSubstr(R"("id":2,"topic":"/1/1/ATTITUDE")"));
    EXPECT_EQ(last, 2u);
    EXPECT_EQ(unadvertise(std::array{1u, 7u}), R"({"op":"unadvertise","channelIds":[1,7]})");
}

TEST(Foxglove, EncodesMessages) {
    observe::LatestTable table(dialect::default_dialect());
    Channels channels(10);
    const auto* const attitude = channels.take(
        *table.add({.frame = view(test::attitude_v2), .time = WallTime(Nanoseconds(0x0102030405060708))}));
    std::vector<std::uint8_t> message;
    encode(*attitude, message);
    set_subscription(message, 0xa0b0c0d0);
    const auto expected = test::join({test::hex("01d0c0b0a0080706050403020100010000"),
                                      test::hex("40e20100cdcccc3dcdcc4cbe00004040000000000000000000000000")});
    EXPECT_EQ(message, expected);
}

}  // namespace
}  // namespace mavloom::web::foxglove
