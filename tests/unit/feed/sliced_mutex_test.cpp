// SPDX-License-Identifier: MIT
#include "mavloom/feed/sliced_mutex.hpp"

#include <gtest/gtest.h>

#include <pthread.h>

#include <cerrno>
#include <ctime>
#include <set>
#include <thread>
#include <vector>

#include "support/thread_sanitizer.hpp"
#include "unit/feed/fixture.hpp"

#ifdef MAVLOOM_THREAD_SANITIZER
// Clang 16's thread sanitizer does not know this function, behind std::timed_mutex::try_lock_until, and would not see
// the lock. Here it is made of one that it knows.
extern "C" int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const timespec* until) noexcept {
    for (;;) {
        if (const int error = ::pthread_mutex_trylock(mutex); error != EBUSY) return error;
        timespec now{};
        ::clock_gettime(clock, &now);
        if (now.tv_sec > until->tv_sec || (now.tv_sec == until->tv_sec && now.tv_nsec >= until->tv_nsec))
            return ETIMEDOUT;
        std::this_thread::yield();
    }
}
#endif

namespace mavloom::feed {
namespace {

using namespace testing;

TEST(SlicedMutex, OneThreadAtATimeHasIt) {
    SlicedMutex mutex;
    int guarded = 0;  // what the thread sanitizer watches
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i)
        threads.emplace_back([&] {
            for (int round = 0; round < 500; ++round) {
                {
                    const auto lock = mutex.take();
                    ++guarded;
                }
                if (const auto lock = mutex.try_take(); lock.owns_lock()) --guarded, ++guarded;
                if (const auto lock = mutex.take_until(mono_now() + long_enough); lock.owns_lock()) ++guarded;
                else --round;  // after a slice: again
                mutex.yield_to_waiters();
            }
        });
    for (auto& thread : threads) thread.join();
    const auto lock = mutex.take();
    EXPECT_GE(guarded, 4 * 500 * 2);
}

TEST(SlicedMutex, TryTakeFailsWhileAnotherThreadHoldsIt) {
    SlicedMutex mutex;
    const auto held = mutex.take();
    bool refused = false, refused_after_a_slice = false;
    std::thread([&] {
        refused = !mutex.try_take().owns_lock();
        refused_after_a_slice = !mutex.take_until(MonoTime::max()).owns_lock();
    }).join();
    EXPECT_TRUE(refused);
    EXPECT_TRUE(refused_after_a_slice);
}

// A thread that waits slice by slice and lets others in between must not starve the others.
TEST(SlicedMutex, AThreadThatAsksGetsItBetweenTwoSlices) {
    SlicedMutex mutex;
    std::atomic<bool> had_it{false};
    std::thread asking([&] {
        const auto lock = mutex.take();
        had_it = true;
    });
    EXPECT_TRUE(eventually([&] {
        for (int slice = 0; slice < 100 && !had_it; ++slice) {
            mutex.yield_to_waiters();
            const auto lock = mutex.take_until(MonoTime::max());
        }
        return had_it.load();
    }));
    asking.join();
}

TEST(SlicedMutex, PeekNeverWaitsAndSeesWhetherItIsFree) {
    SlicedMutex mutex;
    EXPECT_TRUE(mutex.peek([](bool is_free) { return is_free; }));
    const auto held = mutex.take();
    bool free = true;
    std::thread([&] { free = mutex.peek([](bool is_free) { return is_free; }); }).join();
    EXPECT_FALSE(free);
}

// Otherwise a read that does not wait would find nothing, although there are records.
TEST(SlicedMutex, TryTakeSucceedsDuringAPeek) {
    SlicedMutex mutex;
    constexpr int enough = 20'000;
    std::atomic<int> peeks{0};
    int guarded = 0;
    std::thread peeking([&] {
        while (peeks < enough)
            peeks += mutex.peek([&](bool is_free) {
                if (is_free) ++guarded;
                return 1;
            });
    });
    int refused = 0;
    while (peeks < enough) {
        {
            const auto lock = mutex.try_take();
            if (lock.owns_lock()) --guarded;
            else ++refused;
        }
        std::this_thread::yield();  // to the peeking thread, so that it gets the lock too
    }
    peeking.join();
    EXPECT_EQ(refused, 0);
}

TEST(ThisThread, NumbersAreNeverReusedNorZero) {
    std::set<std::uint64_t> numbers{this_thread()};
    EXPECT_EQ(this_thread(), *numbers.begin());
    for (int i = 0; i < 100; ++i) std::thread([&] { numbers.insert(this_thread()); }).join();
    EXPECT_EQ(numbers.size(), 101u);
    EXPECT_FALSE(numbers.contains(0));
}

}  // namespace
}  // namespace mavloom::feed
