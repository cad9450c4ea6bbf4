// SPDX-License-Identifier: MIT
#include "mavloom/wire/stream_parser.hpp"

#include <gmock/gmock.h>

#include "support/golden_frames.hpp"
#include "support/parse_log.hpp"

namespace mavloom::wire {

using namespace std::chrono_literals;
using test::Bytes;
using test::join;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

namespace {

struct StreamParserTest : ::testing::Test {
    MessageTable table{test::golden_messages};
    StreamParser sut{table};
    test::ParseLog log;
    MonoTime now{1h};

    void feed(const Bytes& bytes) { sut.feed(bytes, now, log); }
    void tick_after(Nanoseconds pause) {
        now += pause;
        sut.tick(now, log);
    }
};

const Bytes five_frames = join(
    {test::heartbeat_v2, test::attitude_v1, test::tunnel_v2, test::heartbeat_signed_1, test::ping_zero_v2});

}  // namespace

TEST_F(StreamParserTest, FindsFramesFedByteByByte) {
    for (const auto byte : five_frames) feed({byte});

    EXPECT_THAT(log.events, ElementsAre("frame 0/7", "frame 30/200", "frame 385/9", "frame 0/7", "frame 4/0"));
    EXPECT_EQ(log.frames[2], test::tunnel_v2);
    EXPECT_EQ(sut.pending_bytes(), 0u);
}

TEST_F(StreamParserTest, FindsFramesCutAnywhereInTwo) {
    for (std::size_t cut = 0; cut <= five_frames.size(); ++cut) {
        StreamParser parser(table);
        test::ParseLog found;
        parser.feed(ByteView{five_frames}.first(cut), now, found);
        parser.feed(ByteView{five_frames}.subspan(cut), now, found);
        ASSERT_THAT(found.events, ElementsAre("frame 0/7", "frame 30/200", "frame 385/9", "frame 0/7", "frame 4/0"))
            << cut;
    }
}

// One byte is missing. At most that frame is lost, and the frames behind it arrive without waiting for more input.
TEST_F(StreamParserTest, LosesOnlyTheFrameThatLacksAByte) {
    auto first = test::attitude_v1;
    first.erase(first.begin() + 12);

    feed(join({first, test::heartbeat_v2, test::attitude_v2}));

    EXPECT_THAT(log.frames, ElementsAre(test::heartbeat_v2, test::attitude_v2));
    EXPECT_EQ(sut.counters().junk_bytes.value(), first.size());
}

// A start byte in noise announces 255 bytes. The parser holds back fewer than 280 bytes and reports no false frame.
TEST_F(StreamParserTest, AFalseStartHoldsBackLessThan280Bytes) {
    feed({0xfd, 255, 0, 0, 0, 1, 1, 30, 0, 0});
    std::size_t fed = 10;
    while (log.frames.empty() && fed < 1000) {
        feed(test::heartbeat_v2);
        fed += test::heartbeat_v2.size();
    }

    EXPECT_LT(fed, 10u + 280u);
    EXPECT_EQ(log.frames[0], test::heartbeat_v2);
    EXPECT_EQ(sut.counters().junk_bytes.value(), 10u);
}

TEST_F(StreamParserTest, GivesAFalseStartUpAfterSilence) {
    feed(join({{0xfe, 200}, test::heartbeat_v2, test::attitude_v1}));
    EXPECT_THAT(log.events, IsEmpty());
    ASSERT_EQ(sut.deadline(), now + StreamParser::default_hold);

    tick_after(StreamParser::default_hold - 1ns);
    EXPECT_THAT(log.events, IsEmpty());
    tick_after(1ns);

    EXPECT_THAT(log.events, ElementsAre("junk 2", "frame 0/7", "frame 30/200"));
    EXPECT_EQ(sut.deadline(), std::nullopt);
}

TEST_F(StreamParserTest, CompletesATrueFrameAfterALongPause) {
    const auto& frame = test::tunnel_v2;
    feed({frame.begin(), frame.begin() + 50});

    tick_after(10s);
    EXPECT_EQ(sut.deadline(), std::nullopt);
    feed({frame.begin() + 50, frame.end()});

    EXPECT_THAT(log.events, ElementsAre("frame 385/9"));
}

TEST_F(StreamParserTest, KeepsTheIncompleteFrameBehindAGivenUpStart) {
    feed(join({{0xfe, 200}, test::heartbeat_v2, Bytes(test::attitude_v1.begin(), test::attitude_v1.begin() + 9)}));

    tick_after(StreamParser::default_hold);
    feed({test::attitude_v1.begin() + 9, test::attitude_v1.end()});

    EXPECT_THAT(log.events, ElementsAre("junk 2", "frame 0/7", "frame 30/200"));
}

TEST_F(StreamParserTest, FinishTurnsTheRestIntoJunk) {
    feed(join({test::heartbeat_v2, {0xfd, 20, 0}}));

    sut.finish(log);

    EXPECT_THAT(log.events, ElementsAre("frame 0/7", "junk 3"));
    EXPECT_EQ(sut.pending_bytes(), 0u);
}

TEST_F(StreamParserTest, ReportsEndlessJunkInPieces) {
    feed(Bytes(10'000, 0x11));
    EXPECT_THAT(log.events, ElementsAre("junk 4096", "junk 4096"));

    feed(test::heartbeat_v2);
    EXPECT_THAT(log.events, ElementsAre("junk 4096", "junk 4096", "junk 1808", "frame 0/7"));
}

TEST_F(StreamParserTest, TakesAnUnknownIdBetweenGoodFramesOnceTheNextByteIsThere) {
    const MessageTable only_heartbeat{std::span(test::golden_messages).first(1)};
    StreamParser parser{only_heartbeat};

    parser.feed(join({test::heartbeat_v2, test::tunnel_v2}), now, log);
    EXPECT_THAT(log.events, ElementsAre("frame 0/7"));
    parser.feed(test::heartbeat_v1, now, log);

    EXPECT_THAT(log.events, ElementsAre("frame 0/7", "frame 385/9", "frame 0/7"));
}

TEST_F(StreamParserTest, TakesAnUnknownIdAtTheEndOfAnIdleStream) {
    const MessageTable only_heartbeat{std::span(test::golden_messages).first(1)};
    StreamParser parser{only_heartbeat};
    parser.feed(join({test::heartbeat_v2, test::tunnel_v2}), now, log);

    parser.tick(now + StreamParser::default_hold, log);

    EXPECT_THAT(log.events, ElementsAre("frame 0/7", "frame 385/9"));
}

TEST_F(StreamParserTest, SettlesAnUnknownIdAndJunk) {
    const MessageTable only_heartbeat{std::span(test::golden_messages).first(1)};
    StreamParser parser{only_heartbeat};
    parser.feed(join({test::heartbeat_v2, test::tunnel_v2}), now, log);

    parser.settle(log);
    parser.feed(join({Bytes(5, 0), Bytes(test::heartbeat_v1.begin(), test::heartbeat_v1.begin() + 4)}), now, log);
    parser.settle(log);

    EXPECT_THAT(log.events, ElementsAre("frame 0/7", "frame 385/9", "junk 5"));
    EXPECT_EQ(parser.pending_bytes(), 4u);
}

TEST_F(StreamParserTest, SettlesNoFrameWithinAnIncompleteFrame) {
    Bytes start = {0xfe, 200, 0, 1, 1, 30};
    feed(join({start, test::heartbeat_v2}));

    sut.settle(log);

    EXPECT_THAT(log.events, IsEmpty());
    EXPECT_EQ(sut.pending_bytes(), start.size() + test::heartbeat_v2.size());
}

TEST_F(StreamParserTest, DoesNotTakeAnUnknownIdOutOfSync) {
    const MessageTable only_heartbeat{std::span(test::golden_messages).first(1)};
    StreamParser parser{only_heartbeat};

    parser.feed(join({{0x01}, test::ping_zero_v2, test::heartbeat_v2}), now, log);

    EXPECT_THAT(log.events, ElementsAre("junk 14", "frame 0/7"));
}

TEST_F(StreamParserTest, ChecksALearnedIdLikeAKnownOne) {
    const MessageTable only_heartbeat{std::span(test::golden_messages).first(1)};
    StreamParser parser{only_heartbeat};
    for (int i = 0; i < 3; ++i) parser.feed(join({test::heartbeat_v2, test::tunnel_v2}), now, log);
    parser.feed(test::heartbeat_v2, now, log);
    log = {};

    auto damaged = test::tunnel_v2;
    damaged[40] ^= 0x01;
    parser.feed(join({damaged, test::tunnel_v2}), now, log);

    EXPECT_THAT(log.frames, ElementsAre(test::tunnel_v2));  // at once: a learned checksum needs no look-ahead
    EXPECT_EQ(parser.counters().crc_error.value(), 1u);
}

TEST_F(StreamParserTest, SurvivesAMebibyteOfStartBytes) {
    for (const std::uint8_t start : {stx_v1, stx_v2}) {
        StreamParser parser{table};
        test::ParseLog found;
        parser.feed(Bytes(1 << 20, start), now, found);
        parser.feed(test::heartbeat_v2, now, found);
        parser.finish(found);
        ASSERT_EQ(found.frames.size(), 1u);
        EXPECT_EQ(parser.counters().junk_bytes.value(), 1u << 20);
    }
}

}  // namespace mavloom::wire
