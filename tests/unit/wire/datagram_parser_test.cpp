// SPDX-License-Identifier: MIT
#include "mavloom/wire/datagram_parser.hpp"

#include <gmock/gmock.h>

#include "support/golden_frames.hpp"
#include "support/parse_log.hpp"

namespace mavloom::wire {

using test::Bytes;
using test::join;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

namespace {

struct DatagramParserTest : ::testing::Test {
    MessageTable table{test::golden_messages};
    DatagramParser sut{table};
    std::vector<std::string> parse(const Bytes& datagram) {
        test::ParseLog log;
        sut.parse(datagram, log);
        return log.events;
    }
};

// A heartbeat with an incompatibility flag that nobody has defined, and the checksum that belongs to it (by pymavlink's
// x25crc).
const Bytes heartbeat_flag_4 = test::hex("fd09040007010100000000000402020c510403921c");
// test::ping_zero_v2 as if PING's CRC_EXTRA were 1 (by pymavlink's x25crc).
const Bytes ping_with_extra_1 = test::hex("fd01000000010104000000dd02");

}  // namespace

TEST_F(DatagramParserTest, FindsAllFramesOfADatagram) {
    EXPECT_THAT(parse(join({test::heartbeat_v2, test::attitude_v1, test::tunnel_v2, test::heartbeat_signed_1,
                            test::ping_zero_v2})),
                ElementsAre("frame 0/7", "frame 30/200", "frame 385/9", "frame 0/7", "frame 4/0"));
}

TEST_F(DatagramParserTest, NeverJoinsTwoDatagrams) {
    const auto& frame = test::attitude_v1;

    EXPECT_THAT(parse({frame.begin(), frame.begin() + 20}), ElementsAre("junk 20"));
    EXPECT_THAT(parse({frame.begin() + 20, frame.end()}), ElementsAre("junk 16"));
    EXPECT_THAT(parse(test::heartbeat_v2), ElementsAre("frame 0/7"));
}

// The datagrams of a gomavlib test: a lone start byte, an unknown flag, a heartbeat followed by junk, a heartbeat.
TEST_F(DatagramParserTest, CaseG1) {
    EXPECT_THAT(parse({0xfd}), ElementsAre("junk 1"));
    EXPECT_THAT(parse(heartbeat_flag_4), ElementsAre("flags 0"));
    EXPECT_THAT(parse(join({test::heartbeat_v2, {1, 2, 3, 4, 5}})), ElementsAre("frame 0/7", "junk 5"));
    EXPECT_THAT(parse(test::heartbeat_v2), ElementsAre("frame 0/7"));
    EXPECT_EQ(sut.counters().unknown_flags.value(), 1u);
}

TEST_F(DatagramParserTest, ADamagedFrameIsNotReportedAsAFrame) {
    auto damaged = test::attitude_v1;
    damaged[10] ^= 0x10;

    EXPECT_THAT(parse(damaged), ElementsAre("bad 30", "junk 36"));
    EXPECT_EQ(sut.counters().crc_error.value(), 1u);
    EXPECT_EQ(sut.counters().junk_bytes.value(), 36u);
}

TEST_F(DatagramParserTest, FindsAnIntactFrameInsideTheClaimOfAFalseStart) {
    const Bytes false_start{0xfd, 9, 0, 0};  // with the heartbeat behind it: a frame of id 0x010700

    EXPECT_THAT(parse(join({false_start, test::heartbeat_v2, test::heartbeat_v1})),
                ElementsAre("bad 67328", "junk 4", "frame 0/7", "frame 0/7"));
}

TEST_F(DatagramParserTest, NothingComesOfAnEmptyDatagram) { EXPECT_THAT(parse({}), IsEmpty()); }

TEST_F(DatagramParserTest, TakesAnUnknownIdThatFillsTheDatagramOrEndsAtAnotherStart) {
    const MessageTable without_tunnel{std::span(test::golden_messages).first(4)};
    DatagramParser parser{without_tunnel};
    test::ParseLog log;

    parser.parse(test::tunnel_v2, log);
    parser.parse(join({test::tunnel_v2, test::heartbeat_v2}), log);

    EXPECT_THAT(log.events, ElementsAre("frame 385/9", "frame 385/9", "frame 0/7"));
    EXPECT_EQ(log.frames[0], test::tunnel_v2);
    EXPECT_EQ(parser.counters().unknown_ids.value(), 2u);
}

TEST_F(DatagramParserTest, RefusesAnUnknownIdInTheMiddleOfNoise) {
    const MessageTable empty{{}};
    DatagramParser parser{empty};
    test::ParseLog log;

    parser.parse(join({test::ping_zero_v2, {0x55}}), log);

    EXPECT_THAT(log.events, ElementsAre("junk 14"));
    EXPECT_EQ(parser.counters().implausible_unknown.value(), 1u);
}

// Frames of another CRC_EXTRA that lie in noise: three of them would replace the byte if they were learned from.
TEST_F(DatagramParserTest, NoiseDoesNotReplaceALearnedExtraByte) {
    const MessageTable empty{{}};
    DatagramParser parser{empty};
    test::ParseLog log;
    const Bytes in_noise = join({ping_with_extra_1, {0x55}});

    for (const Bytes& datagram :
         {test::ping_zero_v2, test::ping_zero_v2, test::ping_zero_v2, in_noise, in_noise, in_noise})
        parser.parse(datagram, log);
    log.events.clear();
    parser.parse(test::ping_zero_v2, log);

    EXPECT_THAT(log.events, ElementsAre("frame 4/0"));
}

TEST_F(DatagramParserTest, CountsEveryByteOnce) {
    const auto datagram = join({{7, 7}, test::heartbeat_v2, heartbeat_flag_4, {0xfe, 3}, test::attitude_v2, {0xfd}});
    parse(datagram);

    const auto& counters = sut.counters();
    EXPECT_EQ(counters.frame_bytes.value() + counters.flagged_bytes.value() + counters.junk_bytes.value(),
              datagram.size());
    EXPECT_EQ(counters.frame_bytes.value(), test::heartbeat_v2.size() + test::attitude_v2.size());
}

}  // namespace mavloom::wire
