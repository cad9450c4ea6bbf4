// SPDX-License-Identifier: MIT
#include "mavloom/observe/frame_log.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "unit/observe/fixture.hpp"

namespace mavloom::observe {
namespace {

using namespace testing;

struct FrameLogTest : ::testing::Test {
    template <class Message>
    static void add(FrameLog& log, const Message& message, int sequence) {
        auto bytes = frame_of(message);
        bytes[4] = static_cast<std::uint8_t>(sequence);
        log.add({.frame = view(bytes), .link = LinkId{1}, .link_name = "a", .time = {}, .now = {}});
    }
    static msg::Attitude attitude(int number) { return {.time_boot_ms = static_cast<std::uint32_t>(number + 1)}; }
    [[nodiscard]] Passage passage() const {
        const auto all = compare(a, b);
        return all.empty() ? Passage{} : all.front();
    }

    FrameLog a{dialect::default_dialect().wire_table()}, b{dialect::default_dialect().wire_table()};
};

TEST_F(FrameLogTest, OnlyTheCommonTimeCounts) {
    for (int i = 0; i < 1000; ++i) add(a, attitude(i), i);
    for (int i = 500; i < 1500; ++i)
        if (i % 10 != 3) add(b, attitude(i), i);
    EXPECT_TRUE(passage().is_comparable);
    EXPECT_FALSE(passage().is_rewritten);
    EXPECT_EQ(passage().before, 500u);
    EXPECT_EQ(passage().lost, 50u);
    EXPECT_EQ(passage().added, 0u);
    ASSERT_EQ(passage().messages.size(), 1u);
    EXPECT_EQ(passage().messages.front().id, msg::Attitude::id);
}

// An equal HEARTBEAT with the same number comes every 256 frames, and must stand for one only.
TEST_F(FrameLogTest, EqualFramesAreCounted) {
    for (int i = 0; i < 2560; ++i) {
        if (i % 256 == 0) add(a, msg::Heartbeat{}, i);
        else add(a, attitude(i), i);
        if (i % 256 == 0 && i != 1024) add(b, msg::Heartbeat{}, i);
        else if (i % 256 != 0) add(b, attitude(i), i);
    }
    EXPECT_EQ(passage().lost, 1u);
    EXPECT_EQ(passage().messages.front().id, msg::Heartbeat::id);
}

TEST_F(FrameLogTest, FramesThatChangePlacesAreThere) {
    for (int i = 0; i < 400; ++i) add(a, attitude(i), i);
    for (int i = 0; i < 400; i += 4)
        for (const int j : {2, 0, 3, 1}) add(b, attitude(i + j), i + j);
    EXPECT_EQ(passage().lost + passage().added, 0u);
}

TEST_F(FrameLogTest, AMessageOfWhichNoneCameIsFiltered) {
    for (int i = 0; i < 400; ++i) {
        if (i % 4 == 0) add(a, msg::VfrHud{.airspeed = static_cast<float>(i)}, i);
        else add(a, attitude(i), i);
        if (i % 4 != 0) add(b, attitude(i), i);
    }
    EXPECT_EQ(passage().lost, 0u);
    EXPECT_NEAR(static_cast<double>(passage().filtered), 100, 1);
    EXPECT_TRUE(passage().messages.front().is_filtered);
}

// Commands and answers go to one station only.
TEST_F(FrameLogTest, FramesForAnotherSystemAreNotMissed) {
    for (int i = 0; i < 400; ++i) {
        if (i % 4 == 1) add(a, msg::CommandAck{.command = static_cast<std::uint16_t>(i), .target_system = 255}, i);
        else add(a, attitude(i), i);
        if (i % 4 != 1) add(b, attitude(i), i);
    }
    EXPECT_EQ(passage().lost + passage().filtered, 0u);
    EXPECT_EQ(passage().targeted, 100u);
}

TEST_F(FrameLogTest, FramesThatAreNumberedAgainAreComparedByContent) {
    for (int i = 0; i < 400; ++i) add(a, attitude(i), i);
    int sequence = 77;
    for (int i = 0; i < 400; ++i)
        if (i % 8 != 5) add(b, attitude(i), sequence++);
    EXPECT_TRUE(passage().is_comparable);
    EXPECT_TRUE(passage().is_rewritten);
    EXPECT_EQ(passage().lost, 50u);
}

TEST_F(FrameLogTest, TwoStreamsOfOneVehicleAreNotCompared) {
    for (int i = 0; i < 400; ++i) add(a, attitude(i * 50), i);
    for (int i = 0; i < 200; ++i) add(b, attitude(i * 100 + 13), i);
    EXPECT_FALSE(passage().is_comparable);
    EXPECT_FALSE(passage().has_few);
    EXPECT_EQ(passage().lost, 0u);
}

TEST_F(FrameLogTest, AFewFramesAreNotCompared) {
    for (int i = 0; i < 100; ++i) add(a, attitude(i), i);
    for (int i = 0; i < 7; ++i) add(b, attitude(i), i);
    EXPECT_FALSE(passage().is_comparable);
    EXPECT_TRUE(passage().has_few);
}

TEST_F(FrameLogTest, ASenderThatOneDidNotHearIsLeftOut) {
    for (int i = 0; i < 400; ++i) add(a, attitude(i), i);
    EXPECT_TRUE(compare(a, b).empty());
}

}  // namespace
}  // namespace mavloom::observe
