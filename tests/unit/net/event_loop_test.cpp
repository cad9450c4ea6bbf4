// SPDX-License-Identifier: MIT
#include "mavloom/net/event_loop.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <thread>
#include <vector>

namespace mavloom::net {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

struct Handler : IoHandler, TimerHandler {
    void on_io(IoEvents events) override {
        ++calls;
        last = events;
        if (then) then();
    }
    void on_timer(MonoTime) override {
        ++timers;
        if (then) then();
    }
    int calls = 0, timers = 0;
    IoEvents last;
    std::function<void()> then;
};

struct Pipe {
    Pipe() {
        int fds[2];
        EXPECT_EQ(::pipe(fds), 0);
        read = Fd(fds[0]);
        write = Fd(fds[1]);
    }
    void fill() const { EXPECT_EQ(::write(write.get(), "x", 1), 1); }
    Fd read, write;
};

struct EventLoopTest : ::testing::Test {
    std::unique_ptr<EventLoop> loop = std::move(*EventLoop::create());
};

TEST_F(EventLoopTest, ReportsWhatIsReadable) {
    const Pipe pipe;
    Handler handler;
    ASSERT_TRUE(loop->watch(pipe.read.get(), true, false, handler));
    loop->run_once(mono_now());
    EXPECT_EQ(handler.calls, 0);
    pipe.fill();
    loop->run_once(mono_now() + seconds(5));
    EXPECT_EQ(handler.calls, 1);
    EXPECT_TRUE(handler.last.readable);
    EXPECT_FALSE(handler.last.writable);
}

TEST_F(EventLoopTest, InterestCanChange) {
    const Pipe pipe;
    Handler handler;
    const auto id = *loop->watch(pipe.write.get(), false, false, handler);
    loop->run_once(mono_now());
    EXPECT_EQ(handler.calls, 0);
    loop->change(id, false, true);
    loop->run_once(mono_now() + seconds(5));
    EXPECT_TRUE(handler.last.writable);
}

TEST_F(EventLoopTest, AHandlerThatWasUnwatchedInTheSameTurnIsNotCalled) {
    const Pipe a, b;
    Handler first, second;
    auto id_a = *loop->watch(a.read.get(), true, false, first);
    auto id_b = *loop->watch(b.read.get(), true, false, second);
    first.then = [&] { loop->unwatch(id_b); };
    second.then = [&] { loop->unwatch(id_a); };
    a.fill();
    b.fill();
    loop->run_once(mono_now() + seconds(5));
    EXPECT_EQ(first.calls + second.calls, 1);
}

TEST_F(EventLoopTest, AReusedSlotDoesNotAnswerToTheOldId) {
    const Pipe a, b;
    Handler first, second;
    auto old = *loop->watch(a.read.get(), true, false, first);
    auto stale = old;
    loop->unwatch(old);
    EXPECT_FALSE(old.valid());
    ASSERT_TRUE(loop->watch(b.read.get(), true, false, second));
    loop->unwatch(stale);
    b.fill();
    loop->run_once(mono_now() + seconds(5));
    EXPECT_EQ(second.calls, 1);
}

TEST_F(EventLoopTest, RunsTimersInOrderAndOnce) {
    Handler early, late, never;
    std::vector<int> order;
    early.then = [&] { order.push_back(1); };
    late.then = [&] { order.push_back(2); };
    const MonoTime now = mono_now();
    EXPECT_TRUE(loop->start_timer(now + milliseconds(4), late).valid());
    EXPECT_TRUE(loop->start_timer(now + milliseconds(2), early).valid());
    auto cancelled = loop->start_timer(now + milliseconds(1), never);
    loop->cancel_timer(cancelled);
    while (late.timers == 0) loop->run_once(mono_now() + seconds(5));
    EXPECT_EQ(order, (std::vector{1, 2}));
    EXPECT_GE(mono_now(), now + milliseconds(4));
    EXPECT_EQ(never.timers, 0);
    loop->run_once(mono_now());
    EXPECT_EQ(early.timers, 1);
}

TEST_F(EventLoopTest, ATimerThatStartsItselfAgainAtOnceDoesNotHoldTheTurn) {
    Handler handler;
    handler.then = [&] { (void)loop->start_timer(MonoTime{}, handler); };
    (void)loop->start_timer(MonoTime{}, handler);
    loop->run_once(mono_now());
    EXPECT_EQ(handler.timers, 1);
    loop->run_once(mono_now());
    EXPECT_EQ(handler.timers, 2);
}

TEST_F(EventLoopTest, ReturnsAtTheDeadline) {
    const MonoTime deadline = mono_now() + milliseconds(3);
    EXPECT_FALSE(loop->run_once(deadline));
    EXPECT_GE(mono_now(), deadline);
}

TEST_F(EventLoopTest, DeadlinesThatAreNotShortMoveToAndFro) {
    Handler never;
    for (const auto wait : {milliseconds(40), milliseconds(15), milliseconds(30)}) {
        auto sooner = loop->start_timer(mono_now() + wait / 2 + milliseconds(8), never);
        loop->cancel_timer(sooner);
        const MonoTime deadline = mono_now() + wait;
        int turns = 0;
        for (; mono_now() < deadline; ++turns) loop->run_once(deadline);
        EXPECT_LE(turns, 4);
    }
    EXPECT_EQ(never.timers, 0);
}

TEST_F(EventLoopTest, SleepsUntilTheInstantAndForThePastNotAtAll) {
    const MonoTime begin = mono_now();
    EventLoop::sleep_until(begin + milliseconds(3));
    EXPECT_GE(mono_now(), begin + milliseconds(3));
    EventLoop::sleep_until(begin);
    EventLoop::sleep_until(MonoTime{});
}

TEST_F(EventLoopTest, WakesFromAnotherThread) {
    std::thread other([&] { loop->wake(); });
    EXPECT_TRUE(loop->run_once(mono_now() + seconds(10)));
    other.join();
}

}  // namespace
}  // namespace mavloom::net
