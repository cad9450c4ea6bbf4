// SPDX-License-Identifier: MIT
#include "mavloom/wire/frame_checksum.hpp"

#include <gtest/gtest.h>

#include "support/bytes.hpp"
#include "support/golden_frames.hpp"

namespace mavloom::wire {
namespace {

FrameView view(const test::Bytes& bytes) { return FrameView::unchecked(bytes); }

// CRC_EXTRA of HEARTBEAT and ATTITUDE as pymavlink's common dialect has them.
TEST(FrameChecksum, ShowsTheCrcExtra) {
    EXPECT_EQ(crc_extra_of(view(test::heartbeat_v2)), 50);
    EXPECT_EQ(crc_extra_of(view(test::heartbeat_v1)), 50);
    EXPECT_EQ(crc_extra_of(view(test::heartbeat_signed_1)), 50);
    EXPECT_EQ(crc_extra_of(view(test::attitude_v2)), 39);
}

// Id 50000, whose checksum pymavlink's x25crc made with CRC_EXTRA 77.
TEST(FrameChecksum, ShowsTheCrcExtraOfAnIdWithoutDefinition) {
    EXPECT_EQ(crc_extra_of(view(test::hex("fd03000009010150c300010203e4d4"))), 77);
}

TEST(FrameChecksum, OneIn256FitsSomeCrcExtra) {
    auto damaged = test::heartbeat_v2;
    int fitting = 0;
    for (unsigned checksum = 0; checksum < 65536; ++checksum) {
        damaged[damaged.size() - 2] = static_cast<std::uint8_t>(checksum);
        damaged[damaged.size() - 1] = static_cast<std::uint8_t>(checksum >> 8);
        fitting += crc_extra_of(view(damaged)) >= 0;
    }
    EXPECT_EQ(fitting, 256);
}

}  // namespace
}  // namespace mavloom::wire
