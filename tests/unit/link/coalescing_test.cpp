// SPDX-License-Identifier: MIT
// Expected values: docs/guide/queues.md (500 frames, ten milliseconds, 0.2 ms), by hand.
#include "link/core/coalescing.hpp"

#include <gtest/gtest.h>

namespace mavloom::link::detail {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr MonoTime begin{std::chrono::hours{1}};

// Turns of one frame each, every `interval`, for as long as `time`; when the next would begin.
MonoTime pass(Coalescing& turns, MonoTime from, Nanoseconds interval, Nanoseconds time) {
    MonoTime now = from;
    for (; now < from + time; now += interval) turns.count(now, now + microseconds{1}, 1, false);
    return now;
}

// A window is closed by the first turn behind it.
MonoTime rush(Coalescing& turns, MonoTime from) { return pass(turns, from, microseconds{10}, milliseconds{21}); }

TEST(Coalescing, TenThousandFramesASecondAreNeverHeldBack) {
    Coalescing turns;
    MonoTime now = begin;
    for (int i = 0; i < 1000; ++i) {
        now = pass(turns, now, microseconds{100}, microseconds{100});
        ASSERT_FALSE(turns.rest_until()) << i;
    }
}

TEST(Coalescing, ABurstOfFiveHundredFramesIsNotHeldBack) {
    Coalescing turns;
    turns.count(begin, begin + microseconds{1}, 1, false);
    const MonoTime later = begin + milliseconds{1};
    turns.count(later, later + microseconds{100}, 500, false);
    turns.count(begin + milliseconds{10}, begin + milliseconds{10} + microseconds{1}, 0, false);
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, AFirstBurstAfterALongSilenceIsNotHeldBack) {
    Coalescing turns;
    turns.count(begin, begin + microseconds{900}, 5000, false);
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, AHundredThousandFramesASecondAreTakenTogether) {
    Coalescing turns;
    const MonoTime end = rush(turns, begin);
    turns.count(end, end + microseconds{3}, 1, false);
    EXPECT_EQ(turns.rest_until(), end + microseconds{200});
}

TEST(Coalescing, DoesNotRestWhereMoreWaitsOrTheTurnTookLong) {
    Coalescing turns;
    const MonoTime end = rush(turns, begin);
    turns.count(end, end + microseconds{3}, 64, true);
    EXPECT_FALSE(turns.rest_until());
    turns.count(end, end + microseconds{200}, 1, false);
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, NeverRestsWhereItIsNotAllowed) {
    Coalescing turns;
    turns.allow(false);
    const MonoTime end = rush(turns, begin);
    turns.count(end, end + microseconds{3}, 1, false);
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, EndsWithTheSecondWindowAfterTheRush) {
    Coalescing turns;
    const MonoTime end = rush(turns, begin);
    ASSERT_TRUE(turns.rest_until());
    pass(turns, end, microseconds{100}, milliseconds{21});
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, AFrameAfterALongSilenceEndsIt) {
    Coalescing turns;
    const MonoTime end = rush(turns, begin) + std::chrono::hours{200'000};
    turns.count(end, end + microseconds{1}, 1, false);
    EXPECT_FALSE(turns.rest_until());
}

}  // namespace
}  // namespace mavloom::link::detail
