// SPDX-License-Identifier: MIT
#include "web/channels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/golden_frames.hpp"
#include "unit/feed/fixture.hpp"

namespace mavloom::web {
namespace {

using namespace feed::testing;
using namespace std::chrono_literals;
using ::testing::ElementsAre;

constexpr std::uint32_t battery_id = 147, position_id = 33, text_id = 253;

Bytes battery(std::uint8_t number) {
    Bytes payload(33);
    payload[32] = number;
    return frame_of(battery_id, payload);
}

struct ChannelsTest : ::testing::Test {
    Channel* take(const Bytes& bytes, LinkId link = LinkId{1}, MonoTime now = {}) {
        const WallTime time{now.time_since_epoch()};
        return channels.take(*table.add({.frame = view(bytes), .link = link, .time = time, .now = now}));
    }
    std::vector<std::string> topics() const {
        std::vector<std::string> all;
        for (const auto& [id, channel] : channels.all()) all.push_back(channel.topic);
        return all;
    }
    observe::LatestTable table{dialect::default_dialect(), observe::LatestTable::WhenFull::forgets, 8};
    Channels channels{5};
};

TEST_F(ChannelsTest, EachSourceMessageAndInstanceHasOne) {
    Channel* const first = take(battery(0));
    EXPECT_EQ(take(battery(0)), first);
    EXPECT_NE(take(battery(1)), first);
    EXPECT_NE(take(numbered(1, 2)), nullptr);
    EXPECT_THAT(topics(),
                ElementsAre("/1/1/BATTERY_STATUS/0", "/1/1/BATTERY_STATUS/1", "/2/1/ATTITUDE", "/2/1/pose", "/2/1/tf"));
    EXPECT_EQ(first->traffic.count, 2u);
    EXPECT_EQ(channels.find(first->id), first);
    EXPECT_EQ(channels.find(0), nullptr);
    EXPECT_EQ(channels.find(6), nullptr);
}

TEST_F(ChannelsTest, PositionsAndTextsHaveAStandardTypeToo) {
    const Channel* const position = take(frame_of(position_id));
    const Channel* const text = take(frame_of(text_id));
    EXPECT_THAT(topics(), ElementsAre("/1/1/GLOBAL_POSITION_INT", "/1/1/position", "/1/1/STATUSTEXT", "/1/1/log"));
    ASSERT_EQ(position->standards.size(), 1u);
    EXPECT_EQ(position->standards[0]->kind.type, "sensor_msgs/msg/NavSatFix");
    EXPECT_EQ(text->standards[0]->kind.type, "rcl_interfaces/msg/Log");
}

TEST_F(ChannelsTest, FramesWithoutOneAreCounted) {
    for (std::uint8_t i = 0; i < 7; ++i) take(battery(i));
    EXPECT_EQ(channels.all().size(), 5u);
    EXPECT_EQ(channels.left_out(), 2u);
}

TEST_F(ChannelsTest, SilentOnesLeaveTheirPlaceToOthers) {
    take(frame_of(30));  // ATTITUDE, with /1/1/pose and /1/1/tf
    const Channel* const kept = take(battery(0), LinkId{1}, MonoTime(30s));
    take(battery(1), LinkId{1}, MonoTime(30s));
    EXPECT_EQ(take(battery(2), LinkId{1}, MonoTime(59s)), nullptr);
    const Channel* const added = take(battery(2), LinkId{1}, MonoTime(61s));
    ASSERT_NE(added, nullptr);
    EXPECT_EQ(added->id, 6u);
    EXPECT_THAT(topics(), ElementsAre("/1/1/BATTERY_STATUS/0", "/1/1/BATTERY_STATUS/1", "/1/1/BATTERY_STATUS/2"));
    EXPECT_THAT(channels.take_forgotten(), ElementsAre(1u, 2u, 3u));
    EXPECT_EQ(channels.find(1), nullptr);
    EXPECT_EQ(take(battery(0), LinkId{1}, MonoTime(62s)), kept);
    EXPECT_EQ(take(frame_of(30), LinkId{1}, MonoTime(63s)), nullptr);  // it needs three
}

TEST_F(ChannelsTest, APoseForgetsThePositionThatWasForgotten) {
    take(frame_of(32));  // LOCAL_POSITION_NED
    const Channel* const attitude = take(frame_of(30));
    ASSERT_EQ(attitude->standards[0]->other, channels.find(1));
    take(battery(0));
    EXPECT_EQ(take(frame_of(30), LinkId{1}, MonoTime(60s)), attitude);
    take(battery(1), LinkId{1}, MonoTime(61s));
    EXPECT_EQ(attitude->standards[0]->other, nullptr);
}

TEST_F(ChannelsTest, TheirRateIsThatOfAllLinks) {
    const Channel* channel = nullptr;
    for (int second = 0; second <= 20; ++second)
        for (const std::uint32_t link : {1u, 2u}) channel = take(battery(0), LinkId{link}, MonoTime{second * 1s});
    EXPECT_NEAR(channel->traffic.recent_rate_hz(WallTime(20s)), 2.0, 0.3);
}

TEST_F(ChannelsTest, LinksShareOne) {
    Channel* const first = take(battery(0), LinkId{1});
    EXPECT_EQ(take(battery(0), LinkId{2}), first);
    EXPECT_EQ(first->traffic.count, 2u);
    EXPECT_EQ(first->latest()->traffic.link, LinkId{2});
    EXPECT_EQ(first->latest()->traffic.count, 1u);
}

TEST_F(ChannelsTest, ARowThatWasForgottenIsNotTheLatest) {
    Channel* const first = take(battery(0));
    for (std::uint32_t link = 2; link <= 8; ++link) take(battery(1), LinkId{link});
    ASSERT_NE(first->latest(), nullptr);
    const auto bytes = battery(1);
    Channel* const other = channels.take(*table.add({.frame = view(bytes), .link = LinkId{9}, .now = MonoTime(61s)}));
    EXPECT_NE(other, first);
    EXPECT_EQ(first->latest(), nullptr);
    EXPECT_EQ(other->latest()->traffic.link, LinkId{9});
    EXPECT_EQ(take(battery(0), LinkId{9}), first);
    EXPECT_NE(first->latest(), nullptr);
}

TEST(Channels, MessagesWithoutDefinitionHaveNone) {
    const dialect::Dialect none("none", {}, {});
    observe::LatestTable table(none);
    Channels channels(5);
    const auto bytes = battery(0);
    EXPECT_EQ(channels.take(*table.add({.frame = view(bytes)})), nullptr);
    EXPECT_EQ(channels.unknown(), 1u);
}

}  // namespace
}  // namespace mavloom::web
