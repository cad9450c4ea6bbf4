// SPDX-License-Identifier: MIT
// Expected values: docs/guide/route.md (a frame may be about a second behind those of another link), by hand.
#include "runtime/late_frames.hpp"

#include <gtest/gtest.h>

namespace mavloom::runtime::detail {
namespace {

using std::chrono::milliseconds;

constexpr MonoTime begin{std::chrono::hours{1}};

// A sender with a frame every 10 ms, one tick apart: its signing clock does not run with ours.
struct Sender {
    LateFrames late;
    MonoTime now = begin;
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

TEST(LateFrames, NineTenthsOfASecondMayPass) {
    Sender sender;
    sender.fly(milliseconds{5000});
    EXPECT_TRUE(sender.takes(sender.newest - 80));
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
}  // namespace mavloom::runtime::detail
