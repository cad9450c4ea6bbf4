// SPDX-License-Identifier: MIT
#include "mavloom/wire/unknown_ids.hpp"

#include <gtest/gtest.h>

#include "mavloom/wire/frame_writer.hpp"
#include "support/golden_frames.hpp"

namespace mavloom::wire {

using IdVerdict = UnknownIds::Verdict;

namespace {

// A frame of id 60000 whose checksum was made with `extra`.
struct Stranger {
    FrameBuffer buffer{};
    FrameView with(std::uint8_t extra, std::uint8_t system = 1, std::uint32_t id = 60000) {
        return write_frame(buffer, {Version::v2, 0, {SystemId{system}, ComponentId{1}}, 0},
                           {MessageId{id}, extra, 4, 4}, test::hex("01020304"));
    }
};

}  // namespace

TEST(UnknownIds, RefusesAChecksumThatNoExtraByteGives) {
    UnknownIds sut;
    auto bytes = test::copy(Stranger{}.with(77).bytes());
    bytes.back() ^= 0x01;

    EXPECT_EQ(sut.judge(FrameView::unchecked(bytes)), IdVerdict::impossible);
    EXPECT_FALSE(sut.learn(FrameView::unchecked(bytes)));
    EXPECT_EQ(sut.size(), 0u);
}

TEST(UnknownIds, LearnsAfterThreeAgreeingFrames) {
    UnknownIds sut;
    Stranger stranger;
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(sut.judge(stranger.with(77)), IdVerdict::possible);
        EXPECT_TRUE(sut.learn(stranger.with(77)));
    }

    EXPECT_EQ(sut.judge(stranger.with(77)), IdVerdict::confirmed);
    EXPECT_EQ(sut.judge(stranger.with(78)), IdVerdict::impossible);
    EXPECT_EQ(sut.judge(stranger.with(78, 2)), IdVerdict::possible);  // another sender
}

TEST(UnknownIds, RelearnsAfterAsManyAgreeingOthers) {
    UnknownIds sut;
    Stranger stranger;
    for (int i = 0; i < 10; ++i) ASSERT_TRUE(sut.learn(stranger.with(77)));

    EXPECT_FALSE(sut.learn(stranger.with(90)));
    EXPECT_FALSE(sut.learn(stranger.with(90)));
    EXPECT_TRUE(sut.learn(stranger.with(90)));
    EXPECT_EQ(sut.judge(stranger.with(90)), IdVerdict::confirmed);
}

TEST(UnknownIds, NobodyCanSilenceATrueSenderWithFramesInBetween) {
    UnknownIds sut;
    Stranger stranger;
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(sut.learn(stranger.with(77)));
    for (int i = 0; i < 100; ++i) {
        EXPECT_FALSE(sut.learn(stranger.with(90)));
        EXPECT_FALSE(sut.learn(stranger.with(90)));
        ASSERT_TRUE(sut.learn(stranger.with(77)));
    }
}

TEST(UnknownIds, HoldsAtMost256) {
    UnknownIds sut;
    Stranger stranger;
    for (std::uint32_t id = 0; id < 1000; ++id) EXPECT_TRUE(sut.learn(stranger.with(5, 1, 70000 + id)));

    EXPECT_EQ(sut.size(), UnknownIds::capacity);
}

}  // namespace mavloom::wire
