// SPDX-License-Identifier: MIT
// SlicedMutex: a mutex for threads that hold it while they wait for data. They wait in slices, so that other threads
// can take the mutex between two slices. Any thread may use it. `peek` is for one further thread that must never wait,
// such as the thread of RingAlarm.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <thread>

#include "mavloom/base/clock.hpp"

namespace mavloom::feed {

// The longest wait while holding the mutex. Between two slices, callers handle signals and other threads get the
// mutex.
inline constexpr Nanoseconds longest_slice = std::chrono::milliseconds{50};
[[nodiscard]] inline MonoTime end_of_slice(MonoTime deadline) { return std::min(deadline, mono_now() + longest_slice); }

// The number of this thread: never 0 and never reused, unlike a std::thread::id.
[[nodiscard]] inline std::uint64_t this_thread() noexcept {
    static std::atomic<std::uint64_t> threads{0};
    thread_local const std::uint64_t number = threads.fetch_add(1, std::memory_order_relaxed) + 1;
    return number;
}

class SlicedMutex {
public:
    using Lock = std::unique_lock<std::timed_mutex>;

    // Waits until the mutex is free.
    [[nodiscard]] Lock take() {
        const Asking asking(asking_);
        return Lock(mutex_);
    }
    // Waits only while a `peek` holds the mutex, which is short. If the returned lock is not owned, another thread has
    // the mutex.
    [[nodiscard]] Lock try_take() {
        for (;;) {
            const unsigned peeks = peeks_.load();
            Lock lock(mutex_, std::try_to_lock);
            const bool is_peeked_at = peeks % 2 == 1 || peeks_.load() != peeks;
            if (lock.owns_lock() || !is_peeked_at) return lock;
            std::this_thread::yield();
        }
    }
    // Waits until `deadline`, but at most for a slice. If the returned lock is not owned, another thread still has it.
    [[nodiscard]] Lock take_until(MonoTime deadline) {
        Lock lock = try_take();
        if (lock.owns_lock()) return lock;
        const Asking asking(asking_);
        static_cast<void>(lock.try_lock_until(end_of_slice(deadline)));
        return lock;
    }
    // Call between two slices, without the lock: lets threads that ask for it go first.
    void yield_to_waiters() const {
        if (asking_.load(std::memory_order_relaxed) != 0) std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    // Calls `look(is_free)` and returns its result. If the mutex was free, `peek` holds it during the call. Never
    // waits. Only one thread may call it at a time.
    [[nodiscard]] auto peek(auto&& look) {
        const Peek peek(peeks_);
        const Lock lock(mutex_, std::try_to_lock);
        return look(lock.owns_lock());
    }

private:
    struct Asking {
        explicit Asking(std::atomic<int>& asking) : count(asking) { count.fetch_add(1, std::memory_order_relaxed); }
        Asking(const Asking&) = delete;
        Asking& operator=(const Asking&) = delete;
        ~Asking() { count.fetch_sub(1, std::memory_order_relaxed); }
        std::atomic<int>& count;
    };

    struct Peek {
        explicit Peek(std::atomic<unsigned>& peeks) : count(peeks) { count.fetch_add(1); }
        Peek(const Peek&) = delete;
        Peek& operator=(const Peek&) = delete;
        ~Peek() { count.fetch_add(1); }
        std::atomic<unsigned>& count;
    };

    std::timed_mutex mutex_;
    std::atomic<int> asking_{0};
    std::atomic<unsigned> peeks_{0};  // odd during a peek
};

}  // namespace mavloom::feed
