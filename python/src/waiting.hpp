// SPDX-License-Identifier: MIT
// How calls of Python wait: time-outs as users give them, threads that take turns, what a forked child must leave alone.
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

// A wait ends after this time for a moment, so that signals and other threads get their turn.
inline constexpr Nanoseconds longest_slice = std::chrono::milliseconds{50};

// Seconds as users give them; 0 for less, a year at most. `what` is the argument's name.
[[nodiscard]] Nanoseconds duration_of(const char* what, const nb::object& given);
// A time-out as users give it; None, and nothing here, waits for ever.
[[nodiscard]] std::optional<Nanoseconds> timeout_of(const nb::object& given);
// When a wait ends that begins now.
[[nodiscard]] MonoTime deadline_after(std::optional<Nanoseconds> timeout);
[[nodiscard]] inline MonoTime deadline_after(const nb::object& timeout) { return deadline_after(timeout_of(timeout)); }
[[nodiscard]] inline MonoTime end_of_slice(MonoTime deadline) { return std::min(deadline, mono_now() + longest_slice); }

// Never 0, and never another thread's, as a std::thread::id may be once its thread has ended.
[[nodiscard]] inline std::uint64_t this_thread() noexcept {
    static std::atomic<std::uint64_t> threads{0};
    thread_local const std::uint64_t number = threads.fetch_add(1, std::memory_order_relaxed) + 1;
    return number;
}

// Something that a forked child must neither use nor destroy: its threads and locks stayed in the parent.
class BeforeFork {
public:
    [[nodiscard]] bool is_here() const noexcept { return born_ == Hub::forks(); }
    void check() const {
        if (!is_here()) raise_closed("opened before fork: open it again in this process");
    }

private:
    std::uint64_t born_ = Hub::forks();
};

// A mutex that is held while waiting, slice by slice; between two of them those who ask come first. Nobody holds it who needs the GIL. One thread may
// glance: hold it for a moment, without waiting, which takes no turn from those that try.
class Turns {
public:
    using Lock = std::unique_lock<std::timed_mutex>;

    [[nodiscard]] Lock take() {
        const Asking asking(asking_);
        return Lock(mutex_);
    }
    // Those that come back without owning it say that it is not their turn: yet, or before the deadline and the slice's end.
    [[nodiscard]] Lock try_take() {
        for (;;) {
            const unsigned glances = glances_.load();
            Lock lock(mutex_, std::try_to_lock);
            const bool is_glanced_at = glances % 2 == 1 || glances_.load() != glances;
            if (lock.owns_lock() || !is_glanced_at) return lock;
            std::this_thread::yield();
        }
    }
    // `look(is_free)` with the lock where nobody has it; at once in either case. One call at a time.
    [[nodiscard]] auto glance(auto&& look) {
        const Glance glance(glances_);
        const Lock lock(mutex_, std::try_to_lock);
        return look(lock.owns_lock());
    }
    [[nodiscard]] Lock take_until(MonoTime deadline) {
        Lock lock = try_take();
        if (lock.owns_lock()) return lock;
        const Asking asking(asking_);
        static_cast<void>(lock.try_lock_until(std::min(deadline, mono_now() + longest_slice)));
        return lock;
    }
    // Between two slices, without the lock.
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
    std::atomic<unsigned> glances_{0};  // odd during one
};

}  // namespace mavloom::python
