// SPDX-License-Identifier: MIT
#include "feed/loop_calls.hpp"

#include <gtest/gtest.h>

#include <condition_variable>

#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;

// A loop thread that sleeps until somebody wakes it.
class Loop {
public:
    Loop() : thread_([this] { run(); }) {}
    ~Loop() { stop(); }
    void stop() {
        stopping_ = true;
        wake();
        if (thread_.joinable()) thread_.join();
    }
    [[nodiscard]] bool is_here() const { return std::this_thread::get_id() == thread_.get_id(); }
    [[nodiscard]] int turns() const { return turns_; }
    void wake() {
        const std::lock_guard lock(mutex_);
        woken_ = true;
        changed_.notify_all();
    }

    LoopCalls calls{[this] { wake(); }};

private:
    void run() {
        while (!stopping_) {
            calls.run();
            calls.end_waits();
            ++turns_;
            std::unique_lock lock(mutex_);
            const auto limit = std::min(calls.first_limit(), mono_now() + long_enough);
            changed_.wait_until(lock, limit, [this] { return std::exchange(woken_, false); });
        }
        calls.end();
    }
    std::mutex mutex_;
    std::condition_variable changed_;
    bool woken_ = false;
    std::atomic<bool> stopping_{false};
    std::atomic<int> turns_{0};
    std::thread thread_;
};

TEST(LoopCalls, WorkRunsOnTheLoopThreadAndIsDoneOnReturn) {
    Loop loop;
    int result = 0;
    bool was_there = false;
    EXPECT_TRUE(loop.calls.call([&] {
        was_there = loop.is_here();
        result = 7;
    }));
    EXPECT_TRUE(was_there);
    EXPECT_EQ(result, 7);
}

TEST(LoopCalls, WorkOfOneThreadKeepsItsOrderAndOfSeveralNoneIsLost) {
    Loop loop;
    std::map<int, std::vector<int>> done;  // used by the loop thread only
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 4; ++caller)
        callers.emplace_back([&, caller] {
            for (int i = 0; i < 300; ++i) EXPECT_TRUE(loop.calls.call([&, i] { done[caller].push_back(i); }));
        });
    for (auto& caller : callers) caller.join();
    loop.stop();
    for (const auto& [caller, numbers] : done) {
        EXPECT_EQ(numbers.size(), 300u);
        EXPECT_TRUE(std::ranges::is_sorted(numbers));
    }
    EXPECT_EQ(done.size(), 4u);
}

TEST(LoopCalls, AWaitEndsWhenItIsOver) {
    Loop loop;
    std::atomic<int> turns_left{5};
    std::atomic<bool> ended{false};
    std::thread waiting([&] {
        loop.calls.wait([&] { return turns_left == 0; }, long_enough);
        ended = true;
    });
    while (turns_left != 0) {
        EXPECT_FALSE(ended);
        EXPECT_TRUE(loop.calls.call([&] { --turns_left; }));
    }
    loop.wake();
    waiting.join();
}

TEST(LoopCalls, AWaitEndsAtItsLimitEvenIfTheLoopHasNothingElseToDo) {
    Loop loop;
    loop.calls.wait([] { return false; }, 1ms);
    std::vector<std::thread> waiting;
    for (const auto limit : {3ms, 1ms, 2ms})
        waiting.emplace_back([&, limit] { loop.calls.wait([] { return false; }, limit); });
    for (auto& thread : waiting) thread.join();
}

TEST(LoopCalls, WaitsOfSeveralThreadsEndEachByItself) {
    Loop loop;
    std::atomic<int> open{1};
    std::vector<std::thread> waiting;
    std::atomic<int> ended{0};
    for (int number = 1; number <= 5; ++number)
        waiting.emplace_back([&, number] {
            loop.calls.wait([&, number] { return open > number; }, long_enough);
            EXPECT_GT(open, number);
            ++ended;
        });
    for (int number = 1; number <= 5; ++number) {
        ++open;
        EXPECT_TRUE(eventually([&] {
            loop.wake();
            return ended >= number;
        }));
    }
    for (auto& thread : waiting) thread.join();
}

TEST(LoopCalls, TheEndReleasesThoseWhoWaitAndRefusesTheRest) {
    for (int round = 0; round < 20; ++round) {
        Loop loop;
        std::atomic<int> calls{0}, done{0};
        std::vector<std::thread> callers;
        for (int i = 0; i < 3; ++i)
            callers.emplace_back([&] {
                int mine = 0;  // dead when the thread ends: work that is left must not run later
                while (loop.calls.call([&] {
                    ++mine;
                    ++done;
                }))
                    ++calls;
            });
        std::thread waiting([&] { loop.calls.wait([] { return false; }, 10 * long_enough); });
        EXPECT_TRUE(eventually([&] { return calls > 10; }));
        loop.stop();
        for (auto& caller : callers) caller.join();
        waiting.join();
        EXPECT_EQ(calls, done);  // what returned true was done, what returned false was not
        EXPECT_FALSE(loop.calls.call([&] { ++done; }));
        loop.calls.wait([] { return false; }, 10 * long_enough);
        EXPECT_EQ(calls, done);
    }
}

}  // namespace
}  // namespace mavloom::feed
