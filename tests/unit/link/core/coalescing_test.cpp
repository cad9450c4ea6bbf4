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
    for (; now < from + time; now += interval) turns.count({.began = now, .frames = 1}, now + microseconds{1});
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
    turns.count({.began = begin, .frames = 1}, begin + microseconds{1});
    const MonoTime later = begin + milliseconds{1};
    turns.count({.began = later, .frames = 500}, later + microseconds{100});
    turns.count({.began = begin + milliseconds{10}, .frames = 0}, begin + milliseconds{10} + microseconds{1});
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, AFirstBurstAfterALongSilenceIsNotHeldBack) {
    Coalescing turns;
    turns.count({.began = begin, .frames = 5000}, begin + microseconds{900});
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, AHundredThousandFramesASecondAreTakenTogether) {
    Coalescing turns;
    const MonoTime end = rush(turns, begin);
    turns.count({.began = end, .frames = 1}, end + microseconds{3});
    EXPECT_EQ(turns.rest_until(), end + microseconds{200});
}

// The rest after turns that each send copies of a frame to so many peers.
Nanoseconds rest_after(std::size_t peers, Nanoseconds interval) {
    Coalescing turns;
    MonoTime now = begin;
    const auto count = [&] {
        turns.count({.began = now, .frames = 1, .sent_frames = peers, .sent_datagrams = peers}, now + microseconds{1});
    };
    for (; now < begin + milliseconds{25}; now += interval) count();
    count();
    return turns.rest_until().value_or(now) - now;
}

TEST(Coalescing, TheMorePeersTheLongerTheirCopiesAreGathered) {
    EXPECT_EQ(rest_after(200, milliseconds{2}), Nanoseconds{0}) << "100,000 a second";
    EXPECT_EQ(rest_after(200, microseconds{500}), milliseconds{2}) << "400,000 a second";
    EXPECT_EQ(rest_after(10, microseconds{25}), microseconds{200}) << "400,000 a second";
    EXPECT_EQ(rest_after(100'000, milliseconds{1}), milliseconds{5});
}

TEST(Coalescing, DoesNotRestWhereMoreWaitsOrTheTurnTookLong) {
    Coalescing turns;
    const MonoTime end = rush(turns, begin);
    turns.count({.began = end, .frames = 64, .more_waits = true}, end + microseconds{3});
    EXPECT_FALSE(turns.rest_until());
    turns.count({.began = end, .frames = 1}, end + microseconds{200});
    EXPECT_FALSE(turns.rest_until());
}

TEST(Coalescing, NeverRestsWhereItIsNotAllowed) {
    Coalescing turns;
    turns.allow(false);
    const MonoTime end = rush(turns, begin);
    turns.count({.began = end, .frames = 1}, end + microseconds{3});
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
    turns.count({.began = end, .frames = 1}, end + microseconds{1});
    EXPECT_FALSE(turns.rest_until());
}

}  // namespace
}  // namespace mavloom::link::detail
