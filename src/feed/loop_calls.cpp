// SPDX-License-Identifier: MIT
#include "feed/loop_calls.hpp"

#include <algorithm>

namespace mavloom::feed {

bool LoopCalls::call(std::function<void()> work) {
    bool done = false;
    std::unique_lock lock(mutex_);
    if (ended_) return false;
    work_.push_back([&] {
        work();
        const std::lock_guard inner(mutex_);
        done = true;
        changed_.notify_all();
    });
    wake_();
    changed_.wait(lock, [&] { return done || ended_; });
    return done;
}

void LoopCalls::wait(std::function<bool()> is_over, Nanoseconds limit) {
    bool ended = false;
    call([&] { waits_.push_back({std::move(is_over), mono_now() + limit, &ended}); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return ended || ended_; });
}

void LoopCalls::run() {
    std::vector<std::function<void()>> work;
    {
        const std::lock_guard lock(mutex_);
        work.swap(work_);
    }
    for (const auto& task : work) task();
}

void LoopCalls::end_waits() {
    if (waits_.empty()) return;
    const MonoTime now = mono_now();
    const auto over = std::partition(waits_.begin(), waits_.end(),
                                     [&](const Wait& wait) { return now < wait.limit && !wait.is_over(); });
    if (over == waits_.end()) return;
    const std::lock_guard lock(mutex_);
    std::for_each(over, waits_.end(), [](const Wait& wait) { *wait.ended = true; });
    waits_.erase(over, waits_.end());
    changed_.notify_all();
}

MonoTime LoopCalls::first_limit() const noexcept {
    const auto first = std::ranges::min_element(waits_, {}, &Wait::limit);
    return first == waits_.end() ? MonoTime::max() : first->limit;
}

void LoopCalls::end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    work_.clear();
    changed_.notify_all();
}

}  // namespace mavloom::feed
