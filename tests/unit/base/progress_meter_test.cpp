// SPDX-License-Identifier: MIT
#include "mavloom/base/progress_meter.hpp"

#include <gtest/gtest.h>

namespace mavloom {
namespace {

using namespace std::chrono_literals;

const MonoTime begin{100s};

TEST(ProgressMeter, StatesPartAmountTimeRateAndTimeLeft) {
    ProgressMeter meter(begin);

    const auto line = meter.line({.frames = 500, .bytes = 25'000, .part = 0.25}, begin + 10s, 200);

    EXPECT_EQ(line, "[#####...............]   25 %  500 frames  25.0 kB  00:10  50 frames/s  00:30 left");
}

TEST(ProgressMeter, WithoutAnEndHasNoBarAndNoTimeLeft) {
    ProgressMeter meter(begin);

    EXPECT_EQ(meter.line({.frames = 1, .bytes = 43}, begin + 1s, 200), "1 frame  43 B  00:01  1 frames/s");
}

TEST(ProgressMeter, LeavesOutPiecesForWhichThereIsNoRoom) {
    const ProgressMade made{.frames = 123456, .bytes = 5'600'000, .part = 0.5};
    for (const int width : {10, 20, 40, 60, 80, 100}) {
        ProgressMeter meter(begin);

        const auto line = meter.line(made, begin + 3700s, width);

        EXPECT_LT(static_cast<int>(line.size()), width);
        EXPECT_NE(line.find("50 %"), std::string::npos) << line;
    }
    ProgressMeter meter(begin);
    EXPECT_EQ(meter.line(made, begin + 3700s, 40), " 50 %  123456 frames  1:01:40 left");
}

TEST(ProgressMeter, ThrowsAwayTheRateOfLongAgo) {
    ProgressMeter meter(begin);
    for (int s = 1; s <= 20; ++s)
        static_cast<void>(meter.line({.frames = 1000 * s}, begin + std::chrono::seconds(s), 200));

    std::string line;
    for (int s = 21; s <= 30; ++s) line = meter.line({.frames = 20'000}, begin + std::chrono::seconds(s), 200);

    EXPECT_EQ(line, "20000 frames  0 B  00:30  0 frames/s");
}

TEST(ProgressMeter, BoundsNonsense) {
    ProgressMeter meter(begin);

    EXPECT_EQ(meter.line({.part = 1.5}, begin, 200), "[####################]  100 %  0 B  00:00  00:00 left");
    EXPECT_EQ(meter.line({.part = 0.0}, begin + 1s, 200), "[....................]    0 %  0 B  00:01  0 B/s");
}

}  // namespace
}  // namespace mavloom
