// SPDX-License-Identifier: MIT
#include "mavloom/base/pace.hpp"

#include <gtest/gtest.h>

namespace mavloom {
namespace {

using namespace std::chrono_literals;

constexpr MonoTime pace_start{1000s};

TEST(Pace, ThreeAtOnceThenOneASecondAndThreeAfterARest) {
    Pace sut(1s, 3);
    const auto taken_at = [&](Nanoseconds passed) {
        int taken = 0;
        while (sut.take(pace_start + passed)) ++taken;
        return taken;
    };

    EXPECT_EQ(taken_at(0s), 3);
    EXPECT_EQ(taken_at(999ms), 0);
    EXPECT_EQ(taken_at(1s), 1);
    EXPECT_EQ(taken_at(2500ms), 1);
    EXPECT_EQ(taken_at(3s), 1);
    EXPECT_EQ(taken_at(60s), 3);
}

}  // namespace
}  // namespace mavloom
