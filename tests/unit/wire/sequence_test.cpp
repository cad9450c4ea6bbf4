// SPDX-License-Identifier: MIT
#include "mavloom/wire/sequence.hpp"

#include <gtest/gtest.h>

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

TEST(SequenceTracker, BeginsAnewWithTheSumsItHas) {
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

TEST(SequenceTracker, TellsAGapOf100FromAResyncOf101) {
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

}  // namespace mavloom::wire
