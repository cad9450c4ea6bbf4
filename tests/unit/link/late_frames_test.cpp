// SPDX-License-Identifier: MIT
// Expected values: docs/guide/route.md (a frame may be half a second behind those of another link), by hand.
#include "link/signing/late_frames.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace mavloom::link::detail {
namespace {

using std::chrono::milliseconds;

constexpr MonoTime first_time{std::chrono::hours{1}};

// A sender with a frame every 10 ms, one tick apart: its signing clock does not run with ours.
struct Sender {
    LateFrames late;
    MonoTime now = first_time;
    std::uint64_t newest = 1000;

    bool takes(std::uint64_t ticks) { return !late.is_too_late(7, {ticks}, {newest}, now); }
    void fly(milliseconds time) {
        for (const MonoTime end = now + time; now < end; now += milliseconds{10}) {
            EXPECT_TRUE(takes(newest + 1));
            ++newest;
        }
    }
};

TEST(LateFrames, WhatIsNewerThanEverythingIsTaken) { EXPECT_TRUE(Sender().takes(1001)); }

TEST(LateFrames, HalfASecondMayPass) {
    Sender sender;
    sender.fly(milliseconds{5000});
    EXPECT_TRUE(sender.takes(sender.newest - 50));
}

// Whatever the pace: a frame that was taken as long ago as its bytes are remembered, and any older one.
TEST(LateFrames, NothingIsTakenTwiceAfterItsBytesAreForgotten) {
    for (milliseconds period{10}; period < milliseconds{3000}; period += milliseconds{10}) {
        Sender sender;
        std::vector<MonoTime> taken;
        for (int i = 0; i < 12; ++i, sender.now += period) {
            for (milliseconds later{0}; later < period; later += milliseconds{100}) {
                Sender copy = sender;
                copy.now += later;
                const auto forgotten = std::ranges::count_if(
                    taken, [&](MonoTime t) { return t <= copy.now - LateFrames::oldest; });
                if (forgotten != 0) {
                    ASSERT_FALSE(copy.takes(1000 + static_cast<std::uint64_t>(forgotten))) << period.count();
                }
            }
            ASSERT_TRUE(sender.takes(sender.newest + 1));
            taken.push_back(sender.now);
            ++sender.newest;
        }
    }
}

TEST(LateFrames, BehindAsLongAsBytesAreRememberedIsTooLate) {
    Sender sender;
    for (int i = 0; i < 200; ++i) {
        sender.fly(milliseconds{20});
        if (sender.newest > 1200) {
            EXPECT_FALSE(sender.takes(sender.newest - 181)) << i;
        }
    }
}

TEST(LateFrames, ASilentSenderMakesNoExceptions) {
    Sender sender;
    sender.fly(milliseconds{3000});
    sender.now += milliseconds{1800};
    EXPECT_FALSE(sender.takes(sender.newest));
    EXPECT_TRUE(sender.takes(sender.newest + 1));
}

TEST(LateFrames, SendersAreJudgedApart) {
    Sender sender;
    sender.fly(milliseconds{3000});
    EXPECT_FALSE(sender.late.is_too_late(8, {5}, {4}, sender.now));
}

}  // namespace
}  // namespace mavloom::link::detail
