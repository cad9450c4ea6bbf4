// SPDX-License-Identifier: MIT
#include "mavloom/record/pacer.hpp"

#include <gtest/gtest.h>

namespace mavloom::record {
namespace {

using namespace std::chrono_literals;

constexpr MonoTime start{1000s};
constexpr WallTime recorded{1'700'000'000s};

TEST(Pacer, TheFirstRecordIsDueAtTheStart) {
    Pacer pacer(1, start);

    EXPECT_EQ(pacer.due(recorded), start);
}

TEST(Pacer, KeepsTheRecordedDistances) {
    Pacer pacer(1, start);

    EXPECT_EQ(pacer.due(recorded), start);
    EXPECT_EQ(pacer.due(recorded + 20ms), start + 20ms);
    EXPECT_EQ(pacer.due(recorded + 20ms), start + 20ms);
    EXPECT_EQ(pacer.due(recorded + 59s), start + 59s);
}

TEST(Pacer, DividesTheDistancesByTheSpeed) {
    Pacer fast(10, start), slow(0.5, start);

    EXPECT_EQ(fast.due(recorded), start);
    EXPECT_EQ(fast.due(recorded + 10s), start + 1s);
    EXPECT_EQ(slow.due(recorded), start);
    EXPECT_EQ(slow.due(recorded + 10s), start + 20s);
}

TEST(Pacer, AtAVerySlowSpeedTheNextRecordIsDueInYears) {
    Pacer pacer(1e-300, start);

    EXPECT_EQ(pacer.due(recorded), start);
    EXPECT_GT(pacer.due(recorded + 10s), start + 24h * 3650);
}

TEST(Pacer, AtMaximumSpeedEverythingIsDueAtOnce) {
    Pacer pacer(Pacer::max_speed, start);

    EXPECT_EQ(pacer.due(recorded), start);
    EXPECT_EQ(pacer.due(recorded + 50s), start);
}

TEST(Pacer, DoesNotDriftOverADay) {
    Pacer pacer(3, start);
    MonoTime due{};
    for (int i = 0; i <= 86'400; ++i) due = pacer.due(recorded + i * 1s);

    EXPECT_EQ(due, start + 28'800s);
}

TEST(Pacer, RecordsOutOfOrderAreDueAtOnceAndMoveNothing) {
    Pacer pacer(1, start);
    EXPECT_EQ(pacer.due(recorded), start);
    EXPECT_EQ(pacer.due(recorded + 500ms), start + 500ms);

    EXPECT_EQ(pacer.due(recorded + 100ms), start + 500ms);
    EXPECT_EQ(pacer.due(recorded + 700ms), start + 700ms);
    EXPECT_EQ(pacer.jumps(), 0u);
}

TEST(Pacer, ALongGapIsSkipped) {
    Pacer pacer(1, start);
    EXPECT_EQ(pacer.due(recorded), start);
    EXPECT_EQ(pacer.due(recorded + 60s), start + 60s);  // the longest gap that is waited for

    EXPECT_EQ(pacer.due(recorded + 120s + 1ns), start + 60s);
    EXPECT_EQ(pacer.due(recorded + 121s), start + 61s - 1ns);
    EXPECT_EQ(pacer.jumps(), 1u);
}

TEST(Pacer, AClockSetBackIsSkipped) {
    Pacer pacer(2, start);
    EXPECT_EQ(pacer.due(recorded), start);
    EXPECT_EQ(pacer.due(recorded + 10s), start + 5s);

    EXPECT_EQ(pacer.due(WallTime{}), start + 5s);
    EXPECT_EQ(pacer.due(WallTime{4s}), start + 7s);
    EXPECT_EQ(pacer.jumps(), 1u);
}

TEST(Pacer, LimitsCanBeSet) {
    Pacer pacer(1, start, {.longest_gap = 1s, .longest_step_back = 0s});
    EXPECT_EQ(pacer.due(recorded), start);

    EXPECT_EQ(pacer.due(recorded + 2s), start);
    EXPECT_EQ(pacer.due(recorded + 1s), start);
    EXPECT_EQ(pacer.jumps(), 2u);
}

}  // namespace
}  // namespace mavloom::record
