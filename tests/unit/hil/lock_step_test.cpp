// SPDX-License-Identifier: MIT
// The rules of time, with autopilots that are silent, slow, start again, repeat themselves or have times of their own.
#include "mavloom/hil/lock_step.hpp"

#include <gmock/gmock.h>

namespace mavloom::hil {
namespace {

using namespace std::chrono_literals;

constexpr MonoTime start{std::chrono::hours{5}};

class LockStepTest : public ::testing::Test {
protected:
    // Begins the next step at its time.
    FlightTime step() {
        now = std::max(now, clock.due());
        return clock.take(now);
    }
    Answer answer(FlightTime time) { return clock.answer(wire_time(time), true, now); }
    void boot() {
        clock.begin(now);
        answer(step());
        ASSERT_EQ(clock.state(), State::lock_step);
        booted = now = clock.due();  // the pace of the first step
    }
    // Steps that are due now, at most `most`.
    int steps_now(int most) {
        int steps = 0;
        while (steps < most && clock.due() <= now) {
            clock.take(now);
            ++steps;
        }
        return steps;
    }

    MonoTime now = start, booted{};
    LockStep clock{4ms, any_speed, false};
};

TEST_F(LockStepTest, WaitsForAnAutopilot) {
    EXPECT_EQ(clock.state(), State::waiting);
    EXPECT_EQ(clock.due(), MonoTime::max());
}

TEST_F(LockStepTest, ABootingAutopilotGetsRealTime) {
    clock.begin(now);
    for (int i = 0; i < 50; ++i) step();

    EXPECT_EQ(clock.state(), State::booting);
    EXPECT_EQ(now - start, 49 * 4ms);
    EXPECT_EQ(clock.time(), 50 * 4ms);
    EXPECT_EQ(clock.counters().unanswered, 0u);
}

TEST_F(LockStepTest, FromTheFirstAnswerOnEachStepWaitsForItsOwn) {
    boot();
    for (int i = 0; i < 1000; ++i) {
        EXPECT_LE(clock.due(), now);
        const FlightTime time = step();
        EXPECT_GT(clock.due(), now + 999ms);
        EXPECT_EQ(answer(time), Answer::in_time);
    }
    EXPECT_EQ(now, booted);  // as fast as it answers
    EXPECT_EQ(clock.counters().answered, 1001u);
}

TEST_F(LockStepTest, SpeedLimitsThePace) {
    LockStep twice(4ms, 2, false);
    twice.begin(now);
    twice.answer(wire_time(twice.take(now)), true, now);
    for (int i = 0; i < 500; ++i) {
        now = std::max(now, twice.due());
        twice.answer(wire_time(twice.take(now)), true, now);
    }
    EXPECT_NEAR(std::chrono::duration<double>(now - start).count(), 1, 0.01);
    EXPECT_NEAR(twice.speed_reached(), 2, 0.01);
}

TEST_F(LockStepTest, AStallIsNotMadeUpForInARush) {
    LockStep once(4ms, 1, false);
    once.begin(now);
    once.answer(wire_time(once.take(now)), true, now);
    now += 10s;
    int in_rush = 0;
    for (; once.due() <= now; ++in_rush) once.answer(wire_time(once.take(now)), true, now);
    EXPECT_LE(in_rush, 30);
}

TEST_F(LockStepTest, NoTimeIsRepeatedAndNoneGoesBack) {
    FlightTime last{};
    const auto expect_growth = [&] {
        for (int i = 0; i < 30; ++i) {
            const FlightTime time = step();
            EXPECT_GT(time, last);
            last = time;
            if (i % 3 == 0) answer(time);
            if (i % 7 == 0) answer(time);
        }
    };
    for (int restart = 0; restart < 3; ++restart) {
        clock.begin(now);
        expect_growth();
        clock.end();
    }
}

TEST_F(LockStepTest, ASilentAutopilotIsWaitedForOneSecondAStepThenPaced) {
    boot();
    for (unsigned i = 0; i < LockStep::max_missed; ++i) {
        step();
        EXPECT_EQ(clock.state(), State::lock_step);
    }
    EXPECT_EQ(now - booted, 9s);  // the first of the ten came at once
    step();
    EXPECT_EQ(clock.state(), State::lost);
    EXPECT_EQ(clock.counters().unanswered, 10u);
    EXPECT_EQ(clock.counters().losses, 1u);

    const MonoTime lost = now;
    for (int i = 0; i < 250; ++i) step();
    EXPECT_EQ(now - lost, 1s);
    EXPECT_EQ(clock.counters().unanswered, 260u);
    EXPECT_EQ(answer(clock.time()), Answer::in_time);
    for (unsigned i = 1; i < LockStep::enough_in_row; ++i) {
        EXPECT_EQ(clock.state(), State::lost);
        EXPECT_EQ(answer(step()), Answer::in_time);
    }
    EXPECT_EQ(clock.state(), State::lock_step);
    EXPECT_LE(clock.due(), now + 4ms);
}

// As PX4 without accelerometer, which would otherwise fly at a hundredth of real time.
TEST_F(LockStepTest, AnAutopilotThatAnswersEveryFourthStepIsPaced) {
    boot();
    const auto fly = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
            const FlightTime time = step();
            if (i % 4 == 0) answer(time);
        }
    };
    fly(20);
    EXPECT_EQ(clock.state(), State::lost);
    EXPECT_LE(now - booted, 10'100ms);
    const MonoTime lost = now;
    fly(250);
    EXPECT_EQ(clock.state(), State::lost);
    EXPECT_EQ(now - lost, 1s);
    EXPECT_EQ(clock.counters().losses, 1u);
}

TEST_F(LockStepTest, SingleStepsWithoutAnAnswerAreNoLoss) {
    boot();
    for (int i = 0; i < 1000; ++i) {
        const FlightTime time = step();
        if (i % 20 != 0) answer(time);
    }
    EXPECT_EQ(clock.state(), State::lock_step);
    EXPECT_EQ(clock.counters().unanswered, 50u);
    EXPECT_EQ(clock.counters().losses, 0u);
}

TEST_F(LockStepTest, ASlowAutopilotsLateAnswerCounts) {
    boot();
    const FlightTime first = step();
    const FlightTime second = step();  // one second later
    EXPECT_EQ(answer(first), Answer::late);
    EXPECT_GT(clock.due(), now);  // still waits for the second
    EXPECT_EQ(answer(second), Answer::in_time);
    EXPECT_EQ(clock.counters().late, 1u);
    EXPECT_EQ(clock.counters().unanswered, 1u);
}

TEST_F(LockStepTest, ALostAutopilotThatAnswersEachStepLateIsWaitedForAgain) {
    boot();
    for (int i = 0; i < 20; ++i) step();
    ASSERT_EQ(clock.state(), State::lost);
    FlightTime old = step();
    for (unsigned i = 0; i < LockStep::enough_in_row; ++i) {
        EXPECT_EQ(clock.state(), State::lost);
        const FlightTime next = step();
        EXPECT_EQ(answer(old), Answer::late);
        old = next;
    }
    EXPECT_EQ(clock.state(), State::lock_step);
    EXPECT_GE(clock.due(), now + 900ms);
    for (int i = 0; i < 5; ++i) step();
    EXPECT_EQ(clock.state(), State::lock_step);
}

TEST_F(LockStepTest, RepeatedAnswersBeginNoStep) {
    boot();
    const FlightTime time = step();
    EXPECT_EQ(answer(time), Answer::in_time);
    EXPECT_EQ(steps_now(5), 1);  // which waits for its answer
    EXPECT_EQ(answer(time), Answer::repeated);
    EXPECT_EQ(steps_now(5), 0);
    EXPECT_EQ(answer(clock.time()), Answer::in_time);
    EXPECT_EQ(answer(clock.time()), Answer::repeated);
    EXPECT_EQ(steps_now(5), 1);
    EXPECT_EQ(clock.counters().repeated, 2u);
    EXPECT_EQ(clock.counters().late, 0u);
}

TEST_F(LockStepTest, RepeatedAnswersDoNotEndALoss) {
    boot();
    const FlightTime time = step();
    EXPECT_EQ(answer(time), Answer::in_time);
    while (clock.state() != State::lost) step();
    EXPECT_EQ(answer(time), Answer::repeated);
    EXPECT_EQ(clock.state(), State::lost);
}

TEST_F(LockStepTest, AnswersWithTimesBeyondOursAreNoAnswers) {
    boot();
    const FlightTime time = step();
    for (const FlightTime beyond : {time + 4ms, time + 1h}) EXPECT_EQ(answer(beyond), Answer::foreign);
    EXPECT_EQ(clock.answer(UINT64_MAX, true, now), Answer::foreign);
    EXPECT_EQ(steps_now(5), 0);
    EXPECT_EQ(answer(time), Answer::in_time);
    EXPECT_EQ(steps_now(5), 1);
    EXPECT_EQ(answer(time), Answer::repeated);
    EXPECT_EQ(clock.counters().foreign, 3u);
}

TEST_F(LockStepTest, ARestartedAutopilotCannotAnswerForTheOneBefore) {
    boot();
    const FlightTime old = step();
    clock.end();
    EXPECT_EQ(clock.due(), MonoTime::max());
    clock.begin(now);
    const FlightTime time = step();
    EXPECT_GT(time, old);
    EXPECT_EQ(answer(old), Answer::foreign);
    EXPECT_EQ(clock.state(), State::booting);
    EXPECT_EQ(answer(time), Answer::in_time);
    EXPECT_EQ(clock.state(), State::lock_step);
}

TEST_F(LockStepTest, APauseOfAnyLengthCostsNothing) {
    boot();
    const FlightTime time = step();
    clock.pause(now);
    EXPECT_EQ(clock.due(), MonoTime::max());
    now += 1h;
    clock.resume(now);
    EXPECT_GE(clock.due(), now + 1s);  // it may still answer
    answer(time);
    EXPECT_EQ(steps_now(5), 1);
    EXPECT_EQ(clock.counters().unanswered, 0u);
}

TEST_F(LockStepTest, AllowsStepsWhilePaused) {
    boot();
    clock.pause(now);
    clock.allow(3);
    int steps = 0;
    for (; clock.due() <= now + 1s; ++steps) answer(step());
    EXPECT_EQ(steps, 3);
    EXPECT_EQ(clock.due(), MonoTime::max());

    clock.allow(3);
    clock.end();
    clock.begin(now);
    EXPECT_EQ(clock.due(), MonoTime::max());  // not for another autopilot
}

TEST_F(LockStepTest, ABoardFliesInRealTime) {
    LockStep board(4ms, 1, true);
    board.begin(now);
    for (int i = 0; i < 250; ++i) {
        now = std::max(now, board.due());
        board.take(now);
        board.answer(777, false, now);
    }
    EXPECT_EQ(board.state(), State::real_time);
    EXPECT_EQ(now - start, 249 * 4ms);
    EXPECT_EQ(board.counters().unanswered, 0u);

    for (int i = 0; i < 1000; ++i) {
        now = std::max(now, board.due());
        board.take(now);
    }
    EXPECT_EQ(board.state(), State::lost);
    board.answer(778, false, now);
    EXPECT_EQ(board.state(), State::real_time);
}

TEST_F(LockStepTest, AnAutopilotWithoutLockStepFliesInRealTime) {
    clock.begin(now);
    step();
    EXPECT_EQ(clock.answer(99'000'000, false, now), Answer::unasked);
    EXPECT_EQ(clock.state(), State::real_time);
    const MonoTime before = now;
    for (int i = 0; i < 250; ++i) step();
    EXPECT_EQ(now - before, 1s);
}

TEST(StepTimesTest, QuantilesAreTheUpperBoundsOfTheirBuckets) {
    StepTimes times;
    EXPECT_EQ(times.at(0.5), 0ns);
    for (int i = 1; i <= 1000; ++i) times.add(std::chrono::microseconds{i});
    for (const double quantile : {0.01, 0.5, 0.99}) {
        const auto exact = quantile * 1e6;
        EXPECT_GE(static_cast<double>(times.at(quantile).count()), exact);
        EXPECT_LE(static_cast<double>(times.at(quantile).count()), exact * 1.13 + 1);
    }
    times.add(1h);
    EXPECT_GT(times.at(1), 10s);
}

}  // namespace
}  // namespace mavloom::hil
