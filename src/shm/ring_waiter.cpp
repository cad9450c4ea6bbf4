// SPDX-License-Identifier: MIT
#include "mavloom/shm/ring_waiter.hpp"

#include <linux/futex.h>
#include <linux/time_types.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <utility>

#include "mavloom/base/thread.hpp"

namespace mavloom::shm {

// On a kernel without futex_waitv, the thread sleeps this long on its only ring, or on the first of several. Then it
// checks all rings.
static constexpr Nanoseconds nap_of_one = std::chrono::milliseconds(20), nap_of_many = std::chrono::milliseconds(1);

namespace {

struct Watched {
    RingWaiter::WakeWord word;
    std::uint32_t seen = 0;  // changes up to this value have been handled
};

[[nodiscard]] bool sleep_on_all(std::span<futex_waitv> words, MonoTime until) noexcept {
    const auto since_epoch = until.time_since_epoch();
    const auto seconds = std::chrono::floor<std::chrono::seconds>(since_epoch);
    const __kernel_timespec end{seconds.count(), (since_epoch - seconds).count()};
    const auto woken = ::syscall(SYS_futex_waitv, words.data(), static_cast<unsigned>(words.size()), 0u,
                                 until == MonoTime::max() ? nullptr : &end, CLOCK_MONOTONIC);
    return woken >= 0 || (errno != ENOSYS && errno != EPERM);
}

[[nodiscard]] futex_waitv sleep_on(const SharedWords::Word32& word, std::uint32_t value) noexcept {
    return {value, reinterpret_cast<std::uintptr_t>(&word), FUTEX_32, 0};
}

}  // namespace

class RingWaiter::Thread {
public:
    explicit Thread(const std::function<void()>& wake) : wake_(wake) {
        thread_ = thread_without_signals([this] { run(); });
    }
    Thread(const Thread&) = delete;
    Thread& operator=(const Thread&) = delete;
    ~Thread() {
        ends_.store(true, std::memory_order_relaxed);
        interrupt();
        thread_.join();
    }

    void watch(std::vector<Watched> rings) {
        {
            const std::lock_guard lock(mutex_);
            next_ = std::move(rings);
        }
        interrupt();
    }
    void arm() noexcept { armed_.store(true, std::memory_order_seq_cst); }
    void arm_until(MonoTime due) noexcept {
        arm();
        // All accesses here and in is_due() and wake_if_armed() are sequentially consistent, and those two take `due_`
        // before `armed_`. So if this thread still reads an earlier due time, the helper thread has not taken `armed_`
        // yet, and will call `wake_`.
        MonoTime before = due_.load(std::memory_order_seq_cst);
        do
            if (before <= due) return;
        while (!due_.compare_exchange_weak(before, due, std::memory_order_seq_cst));
        interrupt();
    }
    void disarm() noexcept { armed_.store(false, std::memory_order_relaxed); }

private:
    void interrupt() noexcept {
        changes_.fetch_add(1, std::memory_order_release);  // pairs with the acquire in run()
        SharedWords::wake(changes_);
    }

    void run() {
        std::uint32_t changes = 0;
        while (!ends_.load(std::memory_order_relaxed)) {
            if (const auto now = changes_.load(std::memory_order_acquire); now != changes) {
                changes = now;
                const std::lock_guard lock(mutex_);
                if (next_) rings_ = std::move(*std::exchange(next_, std::nullopt));
            }
            const bool changed = look(), due = is_due();  // always evaluates both
            if (changed || due) wake_if_armed();
            if (!ends_.load(std::memory_order_relaxed)) sleep(changes);
        }
    }

    // Returns whether a word has changed since the last look.
    bool look() noexcept {
        bool changed = false;
        for (auto& [word, seen] : rings_) changed |= std::exchange(seen, word->load(std::memory_order_seq_cst)) != seen;
        return changed;
    }
    bool is_due() noexcept {
        MonoTime due = due_.load(std::memory_order_seq_cst);
        if (due == MonoTime::max() || mono_now() < due) return false;
        // If this exchange fails, another call has set an earlier time, which is due too.
        due_.compare_exchange_strong(due, MonoTime::max(), std::memory_order_seq_cst);
        return true;
    }
    void wake_if_armed() {
        if (armed_.exchange(false, std::memory_order_seq_cst)) wake_();
    }

    void sleep(std::uint32_t changes) noexcept {
        assert(rings_.size() <= max_rings);
        std::array<futex_waitv, max_rings + 1> words;
        std::size_t count = 0;
        words[count++] = sleep_on(changes_, changes);
        for (const auto& [word, seen] : rings_) words[count++] = sleep_on(*word, seen);
        const MonoTime due = due_.load(std::memory_order_relaxed);
        if (waits_for_all_ && (waits_for_all_ = sleep_on_all(std::span(words).first(count), due))) return;
        const Nanoseconds nap = std::min(rings_.size() > 1 ? nap_of_many : nap_of_one, due - mono_now());
        if (rings_.empty()) SharedWords::sleep(changes_, changes, nap);
        else SharedWords::sleep(*rings_.front().word, rings_.front().seen, nap);
    }

    const std::function<void()>& wake_;
    std::atomic<bool> ends_{false}, armed_{false};
    std::atomic<MonoTime> due_{MonoTime::max()};
    SharedWords::Word32 changes_{0};
    std::mutex mutex_;
    std::optional<std::vector<Watched>> next_;  // guarded by mutex_
    std::vector<Watched> rings_;                // used only by the thread
    bool waits_for_all_ = true;                 // whether the kernel supports it; used only by the thread
    std::thread thread_;
};

RingWaiter::RingWaiter(std::function<void()> wake) : wake_(std::move(wake)) {}
RingWaiter::~RingWaiter() = default;

void RingWaiter::watch(std::vector<WakeWord> rings) {
    if (!thread_ && rings.empty()) return;
    if (!thread_) thread_ = std::make_unique<Thread>(wake_);
    std::vector<Watched> watched;
    for (std::size_t i = 0; i < std::min(rings.size(), max_rings); ++i) {
        const auto seen = rings[i]->load(std::memory_order_seq_cst);
        watched.push_back({std::move(rings[i]), seen});
    }
    thread_->watch(std::move(watched));
}

void RingWaiter::arm() noexcept {
    if (thread_) thread_->arm();
}

void RingWaiter::arm(Nanoseconds longest) noexcept {
    if (thread_) thread_->arm_until(mono_now() + longest);
}

void RingWaiter::disarm() noexcept {
    if (thread_) thread_->disarm();
}

}  // namespace mavloom::shm
