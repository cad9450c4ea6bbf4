// SPDX-License-Identifier: MIT
#include "mavloom/wire/sequence.hpp"

#include <gtest/gtest.h>

#include "mavloom/wire/frame_writer.hpp"
#include "support/golden_frames.hpp"

namespace mavloom::wire {

using Verdict = SequenceTracker::Verdict;

namespace {

// A heartbeat-shaped frame; `content` goes into the payload and, in place of a checksum, makes the bytes differ.
struct TestFrame {
    test::Bytes bytes = test::heartbeat_v2;
    explicit TestFrame(unsigned sequence, std::uint8_t system = 1, std::uint8_t content = 0) {
        bytes[4] = static_cast<std::uint8_t>(sequence);
        bytes[5] = system;
        bytes[10] = content;
        bytes[bytes.size() - 2] = static_cast<std::uint8_t>(content ^ sequence);
    }
    operator FrameView() const { return FrameView::unchecked(bytes); }
};

}  // namespace

TEST(SequenceTracker, CountsNothingLostOverTwoWraps) {
    SequenceTracker sut;
    for (unsigned s = 250; s < 250 + 600; ++s) sut.update(TestFrame(s));

    EXPECT_EQ(sut.total().received, 600u);
    EXPECT_EQ(sut.total().lost, 0u);
    EXPECT_EQ(sut.total().resync, 0u);
}

TEST(SequenceTracker, CountsAGapAcrossTheWrap) {
    SequenceTracker sut;
    sut.update(TestFrame(254));

    const auto update = sut.update(TestFrame(2));

    EXPECT_EQ(update.verdict, Verdict::gap);
    EXPECT_EQ(update.lost, 3);  // 255, 0 and 1
    EXPECT_EQ(sut.total().lost, 3u);
}

TEST(SequenceTracker, RecognisesARepeatedFrameAtEverySequenceNumber) {
    SequenceTracker sut;
    for (unsigned s = 0; s < 300; ++s) {
        sut.update(TestFrame(s));
        if (s < 5) continue;
        EXPECT_EQ(sut.update(TestFrame(s - 5)).verdict, Verdict::duplicate) << s;
    }
}

TEST(SequenceTracker, StartsOverWithTheSumsItHas) {
    SequenceTracker sut;
    sut.update(TestFrame(1));
    sut.update(TestFrame(4));
    sut.restart();

    EXPECT_EQ(sut.update(TestFrame(77)).verdict, Verdict::first);
    EXPECT_EQ(sut.update(TestFrame(80)).verdict, Verdict::gap);
    EXPECT_EQ(sut.total().received, 4u);
    EXPECT_EQ(sut.total().lost, 4u);
    EXPECT_EQ(sut.total().resync, 0u);
}

TEST(SequenceTracker, DistinguishesAGapOf100FromAResyncOf101) {
    SequenceTracker sut;
    sut.update(TestFrame(0));

    EXPECT_EQ(sut.update(TestFrame(101)).verdict, Verdict::gap);
    EXPECT_EQ(sut.total().lost, 100u);
    EXPECT_EQ(sut.update(TestFrame(101 + 102)).verdict, Verdict::resync);
    EXPECT_EQ(sut.total().lost, 100u);
    EXPECT_EQ(sut.total().resync, 1u);
}

TEST(SequenceTracker, TakesALateFrameBackFromTheLost) {
    SequenceTracker sut;
    for (unsigned s : {1u, 2u, 4u}) sut.update(TestFrame(s));
    EXPECT_EQ(sut.total().lost, 1u);

    EXPECT_EQ(sut.update(TestFrame(3)).verdict, Verdict::late);
    EXPECT_EQ(sut.total().lost, 0u);
    EXPECT_EQ(sut.total().late, 1u);
    EXPECT_EQ(sut.update(TestFrame(5)).verdict, Verdict::good);
}

TEST(SequenceTracker, ADuplicateIsNotLoss) {
    SequenceTracker sut;
    for (unsigned s = 0; s < 10; ++s) sut.update(TestFrame(s));

    EXPECT_EQ(sut.update(TestFrame(9)).verdict, Verdict::duplicate);
    EXPECT_EQ(sut.update(TestFrame(5)).verdict, Verdict::duplicate);
    EXPECT_EQ(sut.total().lost, 0u);
    EXPECT_EQ(sut.total().duplicate, 2u);
}

TEST(SequenceTracker, LateIsAtMost30Behind) {
    SequenceTracker sut;
    for (unsigned s = 0; s < 60; s += 2) sut.update(TestFrame(s));  // expected is now 59

    EXPECT_EQ(sut.update(TestFrame(29, 1, 9)).verdict, Verdict::late);    // 30 behind
    EXPECT_EQ(sut.update(TestFrame(28, 1, 9)).verdict, Verdict::resync);  // 31 behind
}

TEST(SequenceTracker, MarksASenderThatDoesNotCount) {
    SequenceTracker sut;
    for (int i = 0; i < 50; ++i) sut.update(TestFrame(0, 1, static_cast<std::uint8_t>(i)));

    EXPECT_TRUE(sut.sources()[0].no_sequence);
    EXPECT_EQ(sut.total().lost, 0u);
    EXPECT_EQ(sut.total().duplicate, 0u);
    EXPECT_EQ(sut.total().received, 50u);
}

TEST(SequenceTracker, KeepsSourcesApart) {
    SequenceTracker sut;
    for (unsigned s = 0; s < 100; ++s) {
        sut.update(TestFrame(s, 1));
        sut.update(TestFrame(200 + s, 2));
    }

    ASSERT_EQ(sut.sources().size(), 2u);
    EXPECT_EQ(sut.total().lost, 0u);
    EXPECT_EQ(sut.sources()[1].source.system, SystemId{2});
    EXPECT_EQ(sut.sources()[1].received, 100u);
}

TEST(SequenceTracker, BoundsItsMemory) {
    SequenceTracker sut;
    for (unsigned system = 0; system < 256; ++system) {
        for (unsigned component = 0; component < 256; ++component) {
            TestFrame frame(0, static_cast<std::uint8_t>(system));
            frame.bytes[6] = static_cast<std::uint8_t>(component);
            sut.update(frame);
        }
    }

    EXPECT_EQ(sut.sources().size(), SequenceTracker::max_sources);
    EXPECT_EQ(sut.untracked(), 65536u - SequenceTracker::max_sources);
}

void hear_sources(SequenceTracker& sut, unsigned count) {
    for (unsigned source = 0; source < count; ++source) {
        TestFrame frame(0, static_cast<std::uint8_t>(source >> 8));
        frame.bytes[6] = static_cast<std::uint8_t>(source);
        sut.update(frame);
    }
}

TEST(SequenceTracker, SharesABudgetButKeepsAFewSourcesOfItsOwn) {
    SourceBudget budget(100);
    SequenceTracker honest;
    honest.limit_by(budget);
    {
        SequenceTracker greedy;
        greedy.limit_by(budget);
        hear_sources(greedy, 1000);
        EXPECT_EQ(greedy.sources().size(), 100 + SequenceTracker::own_sources);
        EXPECT_EQ(greedy.untracked(), 1000 - greedy.sources().size());
        hear_sources(honest, 20);
        EXPECT_EQ(honest.sources().size(), SequenceTracker::own_sources);
    }
    hear_sources(honest, 30);  // the other one has given back what it took
    EXPECT_EQ(honest.sources().size(), 30u);
}

// ---- restarts. Rules: docs/guide/routing.md. Offsets are common.xml's: ATTITUDE and GLOBAL_POSITION_INT begin with
// time_boot_ms, in SYSTEM_TIME it stands behind eight bytes.

namespace {

constexpr MessageInfo system_time{MessageId{2}, 137, 12, 12, 0xff, 0xff, 8},
    attitude_info{MessageId{30}, 39, 28, 28, 0xff, 0xff, 0}, position{MessageId{33}, 104, 28, 28, 0xff, 0xff, 0},
    heartbeat_info{MessageId{0}, 50, 9, 9};

// The frames of one vehicle with a sequence of its own.
struct Vehicle {
    SequenceTracker& tracker;
    std::uint8_t component = 1;
    std::uint8_t sequence = 0;

    SequenceTracker::Update send(const MessageInfo& info, std::uint32_t boot_ms = 0) {
        std::vector<std::uint8_t> payload(info.max_length, 7);
        if (info.boot_time_offset != MessageInfo::no_boot_time)
            for (int i = 0; i < 4; ++i)
                payload[info.boot_time_offset + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(boot_ms >>
                                                                                                         8 * i);
        FrameBuffer buffer;
        const auto frame = write_frame(
            buffer, {.sequence = sequence++, .source = {SystemId{1}, ComponentId{component}}}, info, payload);
        return tracker.update(frame, &info);
    }
    void fly(std::uint32_t from_ms, int frames) {
        for (int i = 0; i < frames; ++i) send(attitude_info, from_ms + static_cast<std::uint32_t>(20 * i));
    }
};

}  // namespace

TEST(Restart, ShowsBySystemTimeAtOnceAndIsNoLoss) {
    SequenceTracker sut;
    Vehicle vehicle{sut};
    vehicle.fly(100'000, 20);
    vehicle.send(system_time, 100'400);
    vehicle.sequence = 60;

    EXPECT_EQ(vehicle.send(heartbeat_info).verdict, Verdict::gap);
    const auto update = vehicle.send(system_time, 1'200);

    EXPECT_EQ(update.verdict, Verdict::reboot);
    EXPECT_EQ(update.lost, -39);
    EXPECT_EQ(update.resync, 1);
    EXPECT_EQ(sut.total().lost, 0u);
    EXPECT_EQ(sut.total().resync, 1u);
}

TEST(Restart, ShowsByTheSecondFrameOfAnotherMessage) {
    SequenceTracker sut;
    Vehicle vehicle{sut};
    vehicle.fly(100'000, 50);
    vehicle.sequence = 0;

    EXPECT_EQ(vehicle.send(attitude_info, 300).verdict, Verdict::resync);
    EXPECT_EQ(vehicle.send(heartbeat_info).verdict, Verdict::good);
    const auto update = vehicle.send(attitude_info, 320);
    EXPECT_EQ(update.verdict, Verdict::reboot);
    EXPECT_EQ(update.resync, 0);  // counted already
    vehicle.fly(340, 50);

    EXPECT_EQ(sut.total().lost, 0u);
    EXPECT_EQ(sut.total().resync, 1u);
}

TEST(Restart, TakesBackTheFramesThatSeemedLate) {
    SequenceTracker sut;
    Vehicle vehicle{sut};
    vehicle.fly(100'000, 20);
    vehicle.sequence = 25;
    vehicle.send(attitude_info, 100'400);  // five lost, truly
    vehicle.sequence = 0;                  // 26 back: late

    vehicle.fly(100, 10);

    EXPECT_EQ(sut.total().lost, 5u);
    EXPECT_EQ(sut.total().late, 0u);
    EXPECT_EQ(sut.total().resync, 1u);
}

TEST(Restart, IsNoneOfOneFrameThatComesLate) {
    SequenceTracker sut;
    Vehicle vehicle{sut};
    vehicle.fly(100'000, 20);

    EXPECT_NE(vehicle.send(attitude_info, 90'000).verdict, Verdict::reboot);
    EXPECT_NE(vehicle.send(attitude_info, 100'420).verdict, Verdict::reboot);
    EXPECT_NE(vehicle.send(attitude_info, 90'020).verdict, Verdict::reboot);
    EXPECT_EQ(sut.total().resync, 0u);
}

TEST(Restart, IsNoneWithinTheTolerance) {
    SequenceTracker sut;
    Vehicle vehicle{sut};
    vehicle.fly(100'000, 2);

    for (const auto back : {99'020u, 98'100u, 97'100u})
        EXPECT_EQ(vehicle.send(attitude_info, back).verdict, Verdict::good);
    EXPECT_EQ(vehicle.send(system_time, 200'000).verdict, Verdict::good);
    EXPECT_EQ(vehicle.send(system_time, 199'000).verdict, Verdict::good);
}

TEST(Restart, IsComparedWithinOneMessage) {
    SequenceTracker sut;
    Vehicle vehicle{sut};
    vehicle.fly(100'000, 2);

    for (int i = 0; i < 5; ++i) EXPECT_EQ(vehicle.send(position, 5'000).verdict, Verdict::good);  // another clock
}

TEST(Restart, IsThatOfAnAutopilot) {
    SequenceTracker sut;
    Vehicle camera{sut, 100};
    camera.fly(100'000, 2);
    for (int i = 0; i < 5; ++i) EXPECT_EQ(camera.send(attitude_info, 300).verdict, Verdict::good);

    EXPECT_EQ(camera.send(system_time, 100'000).verdict, Verdict::good);
    EXPECT_EQ(camera.send(system_time, 300).verdict, Verdict::reboot);  // any component that sends SYSTEM_TIME
}

TEST(Restart, IsNotShownByAClockOfZero) {
    SequenceTracker sut;
    Vehicle vehicle{sut};
    vehicle.fly(100'000, 2);
    vehicle.send(system_time, 100'100);

    for (int i = 0; i < 5; ++i) {
        EXPECT_EQ(vehicle.send(attitude_info, 0).verdict, Verdict::good);
        EXPECT_EQ(vehicle.send(system_time, 0).verdict, Verdict::good);
    }
}

TEST(Restart, OfOneSourceIsNoneOfAnother) {
    SequenceTracker sut;
    Vehicle vehicle{sut}, radio{sut, 51};
    radio.send(heartbeat_info);
    radio.sequence = 4;
    radio.send(heartbeat_info);
    vehicle.fly(100'000, 2);
    vehicle.fly(300, 2);

    EXPECT_EQ(sut.sources()[0].lost, 3u);
    EXPECT_EQ(sut.sources()[1].resync, 1u);
}

}  // namespace mavloom::wire
