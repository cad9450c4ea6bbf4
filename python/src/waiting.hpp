// SPDX-License-Identifier: MIT
// Helpers for Python calls that wait: time-outs, turns between threads, and protection of forked children.
#pragma once

#include <nanobind/nanobind.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <thread>

#include "errors.hpp"
#include "gil.hpp"
#include "hub.hpp"
#include "mavloom/base/clock.hpp"

namespace mavloom::python {

// The longest wait without a pause. In the pause, signals are handled and other threads get their turn.
inline constexpr Nanoseconds longest_slice = std::chrono::milliseconds{50};

// Converts a number of seconds: negative ones become 0, more than a year becomes a year. Errors begin with `what`, the
// name of the argument.
[[nodiscard]] Nanoseconds duration_of(const char* what, const nb::object& given);
// Converts a time-out. None becomes nullopt, which means to wait for ever.
[[nodiscard]] std::optional<Nanoseconds> timeout_of(const nb::object& given);
// Returns the deadline of a wait that begins now.
[[nodiscard]] MonoTime deadline_after(std::optional<Nanoseconds> timeout);
[[nodiscard]] inline MonoTime deadline_after(const nb::object& timeout) { return deadline_after(timeout_of(timeout)); }
[[nodiscard]] inline MonoTime end_of_slice(MonoTime deadline) { return std::min(deadline, mono_now() + longest_slice); }

// Returns a number of this thread. It is never 0 and never reused, unlike a std::thread::id.
[[nodiscard]] inline std::uint64_t this_thread() noexcept {
    static std::atomic<std::uint64_t> threads{0};
    thread_local const std::uint64_t number = threads.fetch_add(1, std::memory_order_relaxed) + 1;
    return number;
}

// Marks an object that a forked child must neither use nor destroy, because its threads and locks stayed in the parent.
class BeforeFork {
public:
    [[nodiscard]] bool is_here() const noexcept { return born_ == Hub::forks(); }
    void check() const {
        if (!is_here()) raise_closed("opened before fork: open it again in this process");
    }

private:
    std::uint64_t born_ = Hub::forks();
};

// A mutex that threads hold while they wait, slice by slice. Between two slices, threads that already ask for it come
// first. A thread that needs the GIL must not hold it.
// One thread may also `glance`: hold the mutex for a moment, without waiting. Threads in `try_take` lose no turn to a
// glance.
class Turns {
public:
    using Lock = std::unique_lock<std::timed_mutex>;

    [[nodiscard]] Lock take() {
        const Asking asking(asking_);
        return Lock(mutex_);
    }
    // If the returned lock is not owned, another thread has its turn.
    [[nodiscard]] Lock try_take() {
        for (;;) {
            const unsigned glances = glances_.load();
            Lock lock(mutex_, std::try_to_lock);
            const bool is_glanced_at = glances % 2 == 1 || glances_.load() != glances;
            if (lock.owns_lock() || !is_glanced_at) return lock;
            std::this_thread::yield();
        }
    }
    // Calls `look(is_free)`, with the lock held if it was free. Never waits. One call at a time.
    [[nodiscard]] auto glance(auto&& look) {
        const Glance glance(glances_);
        const Lock lock(mutex_, std::try_to_lock);
        return look(lock.owns_lock());
    }
    // Waits until `deadline`, but at most for a slice. If the returned lock is not owned, another thread still has its
    // turn.
    [[nodiscard]] Lock take_until(MonoTime deadline) {
        Lock lock = try_take();
        if (lock.owns_lock()) return lock;
        const Asking asking(asking_);
        static_cast<void>(lock.try_lock_until(std::min(deadline, mono_now() + longest_slice)));
        return lock;
    }
    // Call between two slices, without the lock: lets threads that ask for it go first.
    void give_way() const {
        if (asking_.load(std::memory_order_relaxed) != 0) std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }

private:
    struct Asking {
        explicit Asking(std::atomic<int>& asking) : count(asking) { count.fetch_add(1, std::memory_order_relaxed); }
        Asking(const Asking&) = delete;
        Asking& operator=(const Asking&) = delete;
        ~Asking() { count.fetch_sub(1, std::memory_order_relaxed); }
        std::atomic<int>& count;
    };

    struct Glance {
        explicit Glance(std::atomic<unsigned>& glances) : count(glances) { count.fetch_add(1); }
        Glance(const Glance&) = delete;
        Glance& operator=(const Glance&) = delete;
        ~Glance() { count.fetch_add(1); }
        std::atomic<unsigned>& count;
    };

    std::timed_mutex mutex_;
    std::atomic<int> asking_{0};
    std::atomic<unsigned> glances_{0};  // odd during a glance
};

}  // namespace mavloom::python
