// SPDX-License-Identifier: MIT
#include "mavloom/ring/frames.hpp"

#include <gtest/gtest.h>

namespace mavloom::ring {
namespace {

using route::Verdict;

// The numbers of docs/formats/ring.md.
TEST(RingFrames, VerdictsHaveTheNumbersOfTheFormat) {
    EXPECT_EQ(ring_verdict(Verdict::forwarded, FrameSignature::none), 0x01);
    EXPECT_EQ(ring_verdict(Verdict::filtered, FrameSignature::none), 0x03);
    EXPECT_EQ(ring_verdict(Verdict::forwarded, FrameSignature::unchecked), 0x11);
    EXPECT_EQ(ring_verdict(Verdict::unknown_target, FrameSignature::good), 0x27);
    EXPECT_EQ(ring_verdict(Verdict::unknown_link, FrameSignature::bad), 0x3b);
}

TEST(RingFrames, EachVerdictIsReadBack) {
    for (int v = 0; v <= static_cast<int>(Verdict::unknown_link); ++v)
        for (const auto signature :
             {FrameSignature::none, FrameSignature::unchecked, FrameSignature::good, FrameSignature::bad}) {
            const auto byte = ring_verdict(static_cast<Verdict>(v), signature);
            EXPECT_EQ(verdict_of(byte), static_cast<Verdict>(v));
            EXPECT_EQ(signature_of(byte), signature);
        }
}

TEST(RingFrames, OtherWritersSayNothing) {
    EXPECT_EQ(verdict_of(0), std::nullopt);
    for (const int later : {12, 13, 14, 15}) EXPECT_EQ(verdict_of(static_cast<std::uint8_t>(later)), std::nullopt);
    EXPECT_EQ(verdict_of(0xc1), Verdict::forwarded) << "bits 6 and 7 are reserved";
}

}  // namespace
}  // namespace mavloom::ring
