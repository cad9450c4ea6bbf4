// SPDX-License-Identifier: MIT
// Expected values of the recording: reckoned from its times by a dozen lines of Python, which follow the length bytes.
#include "mavloom/observe/latest_table.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/named_value_float.hpp"
#include "unit/observe/fixture.hpp"

namespace mavloom::observe {
namespace {

using namespace testing;
using ::testing::ElementsAre;

struct LatestTableTest : ::testing::Test {
    template <class Message>
    const LatestRow* hear(const Message& message, Nanoseconds at = 0s, Source source = vehicle, LinkId link = LinkId{1}) {
        const auto bytes = frame_of(message, source);
        return table.add({.frame = view(bytes), .link = link, .link_name = "a", .time = wall(at), .now = mono(at)});
    }
    LatestTable table{dialect::default_dialect(), LatestTable::WhenFull::forgets, 3};
};

TEST_F(LatestTableTest, InstancesAreNumbersOrTexts) {
    const auto* const first = hear(msg::BatteryStatus{.id_ = 0});
    const auto* const second = hear(msg::BatteryStatus{.id_ = 1, .battery_remaining = 40});
    EXPECT_NE(first, second);
    EXPECT_EQ(hear(msg::BatteryStatus{.id_ = 1, .battery_remaining = 39}), second);
    EXPECT_EQ(second->instance(), message::Instance(std::int64_t{1}));
    EXPECT_EQ(second->traffic.count, 2u);
    EXPECT_EQ(msg::BatteryStatus::decode(second->payload()).battery_remaining, 39);
    const auto* const named = hear(msg::NamedValueFloat{.name_ = {'a', 'b'}});
    EXPECT_EQ(named->instance(), message::Instance(std::string("ab")));
}

TEST_F(LatestTableTest, EachLinkHasItsOwnRows) {
    EXPECT_NE(hear(msg::Heartbeat{}, 0s, vehicle, LinkId{1}), hear(msg::Heartbeat{}, 0s, vehicle, LinkId{2}));
    EXPECT_EQ(hear(msg::Heartbeat{})->instance(), std::nullopt);
}

// RFC 3550: J += (|D| - J) / 16. The usual gap is 100 ms, then 100 + 16/16.
TEST_F(LatestTableTest, JitterIsThatOfTheGaps) {
    for (const auto at : {0ms, 100ms, 216ms}) hear(msg::Heartbeat{}, at);
    const auto& row = table.rows().front();
    EXPECT_EQ(row.jitter, 1ms);
    EXPECT_EQ(row.usual_gap, 101ms);
    hear(msg::Heartbeat{}, 216ms + 101ms);
    EXPECT_EQ(row.jitter, 937'500ns);
    hear(msg::Heartbeat{}, 100ms);  // the clock was set back
    EXPECT_EQ(row.jitter, 937'500ns);
}

TEST_F(LatestTableTest, OnlyWhatComesSteadilyCanFallSilent) {
    const auto* const row = hear(msg::Heartbeat{});
    for (const auto at : {1s, 2s, 3s}) hear(msg::Heartbeat{}, at);
    EXPECT_EQ(row->silent_after(), std::nullopt) << "too few";
    for (auto at = 4s; at <= 10s; ++at) hear(msg::Heartbeat{}, at);
    EXPECT_EQ(row->silent_after(), 5s);
    const auto* const rare = hear(msg::BatteryStatus{});
    for (auto at = 10s; at <= 50s; at += 10s) hear(msg::BatteryStatus{}, at);
    EXPECT_EQ(rare->silent_after(), 30s);
    const auto* const events = hear(msg::NamedValueFloat{});
    for (const auto at : {1ms, 2ms, 3ms, 7000ms, 7001ms, 40'000ms, 40'001ms}) hear(msg::NamedValueFloat{}, at);
    EXPECT_EQ(events->silent_after(), std::nullopt);
}

TEST_F(LatestTableTest, FramesBeyondTheLimitAreCounted) {
    for (std::uint8_t i = 0; i < 5; ++i) hear(msg::BatteryStatus{.id_ = i});
    EXPECT_EQ(table.rows().size(), 3u);
    EXPECT_EQ(table.unlisted(), 2u);
    EXPECT_EQ(table.frames(), 5u);
}

TEST_F(LatestTableTest, SilentRowsLeaveTheirPlaceWhenItIsFull) {
    const auto* const gone = hear(msg::BatteryStatus{.id_ = 0}, 0s, vehicle, LinkId{1});
    hear(msg::BatteryStatus{.id_ = 1}, 30s, vehicle, LinkId{2});
    hear(msg::BatteryStatus{.id_ = 2}, 30s, vehicle, LinkId{2});
    const auto born = gone->born;
    EXPECT_EQ(hear(msg::BatteryStatus{.id_ = 3}, 40s, vehicle, LinkId{3}), nullptr);
    const auto* const newcomer = hear(msg::BatteryStatus{.id_ = 3}, 61s, vehicle, LinkId{3});
    EXPECT_EQ(newcomer, gone);
    EXPECT_NE(newcomer->born, born);
    EXPECT_EQ(newcomer->traffic.count, 1u);
    EXPECT_EQ(table.sorted().size(), 3u);
}

struct Expected {
    Source source;
    std::uint32_t id;
    std::uint64_t count, bytes;
    std::chrono::microseconds shortest, longest;
    double share, hz, jitter_us;
};

struct RecordingTest : InspectorTest {};

TEST_F(RecordingTest, RowsOfAFlight) {
    hear_recording("px4_gcs_flight.tlog");
    const auto rows = inspector.latest().sorted();
    EXPECT_EQ(rows.size(), 39u);
    for (const auto& expected : {
             Expected{vehicle, 30, 5312, 212480, 18289us, 70848us, 0.115799, 49.060603, 124.382},
             Expected{vehicle, 74, 425, 13092, 250028us, 305729us, 0.007135, 3.924810, 3627.042},
             Expected{vehicle, 147, 53, 2809, 2019451us, 2082905us, 0.001531, 0.490558, 13383.237},
             Expected{station, 0, 108, 2268, 1000150us, 1001738us, 0.001236, 0.999752, 62.006},
         }) {
        const auto at = std::ranges::find_if(rows, [&](const LatestRow* row) {
            return row->traffic.source == expected.source && row->traffic.id.value == expected.id;
        });
        ASSERT_NE(at, rows.end()) << expected.id;
        const auto& row = **at;
        EXPECT_EQ(row.traffic.count, expected.count) << expected.id;
        EXPECT_EQ(row.traffic.bytes, expected.bytes) << expected.id;
        EXPECT_EQ(row.traffic.shortest_gap, expected.shortest) << expected.id;
        EXPECT_EQ(row.traffic.longest_gap, expected.longest) << expected.id;
        EXPECT_NEAR(row.share(), expected.share, 1e-6) << expected.id;
        EXPECT_NEAR(row.traffic.rate_hz(), expected.hz, 1e-6) << expected.id;
        EXPECT_NEAR(std::chrono::duration<double>(row.jitter).count() * 1e6, expected.jitter_us, 0.1) << expected.id;
    }
}

}  // namespace
}  // namespace mavloom::observe
