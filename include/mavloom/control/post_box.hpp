// SPDX-License-Identifier: MIT
// A queue of work for its owner, a thread that runs a loop. Other threads post the work.
#pragma once

#include <atomic>
#include <deque>
#include <functional>
#include <mutex>
#include <utility>

namespace mavloom::control {

class PostBox {
public:
    using Work = std::function<void()>;

    // Any thread. The caller must wake the owner afterwards.
    void post(Work work) {
        const std::lock_guard lock(mutex_);
        work_.push_back(std::move(work));
        has_work_.store(true, std::memory_order_release);
    }
    [[nodiscard]] bool empty() const noexcept { return !has_work_.load(std::memory_order_acquire); }
    // The owner only. Runs the oldest item, without holding the lock.
    void run_one() {
        if (const Work work = take()) work();
    }
    // Any thread. Destroys the work that has not run yet.
    void drop() {
        std::deque<Work> work;
        const std::lock_guard lock(mutex_);
        work.swap(work_);
        has_work_.store(false, std::memory_order_relaxed);
    }

private:
    Work take() {
        const std::lock_guard lock(mutex_);
        if (work_.empty()) return {};
        Work work = std::move(work_.front());
        work_.pop_front();
        has_work_.store(!work_.empty(), std::memory_order_relaxed);
        return work;
    }

    std::atomic<bool> has_work_{false};
    std::mutex mutex_;
    std::deque<Work> work_;  // guarded by mutex_
};

}  // namespace mavloom::control
