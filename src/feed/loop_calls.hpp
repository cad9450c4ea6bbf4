// SPDX-License-Identifier: MIT
// LoopCalls: lets other threads run functions on a loop thread and wait until they are done. The loop calls `run` and
// `end_waits` between two turns, and `end` when it has ended.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <vector>

#include "mavloom/base/clock.hpp"

namespace mavloom::feed {

class LoopCalls {
public:
    // `wake` ends the loop's sleep. It is called from any thread, with a mutex held, and must not wait.
    explicit LoopCalls(std::function<void()> wake) : wake_(std::move(wake)) {}

    // ---- any thread but the loop's
    // Runs `work` on the loop thread and returns when it is done. Returns false, without running it, if the loop has
    // ended. `work` must not throw.
    bool call(std::function<void()> work);
    // Returns once `is_over()` is true, `limit` has passed or the loop has ended. The loop thread calls `is_over` after
    // each turn.
    void wait(std::function<bool()> is_over, Nanoseconds limit);

    // ---- loop thread
    void run();
    void end_waits();
    // When the earliest wait reaches its limit. A turn must not sleep beyond that time.
    [[nodiscard]] MonoTime first_limit() const noexcept;
    // Releases the threads that wait. Later calls return at once.
    void end();

private:
    struct Wait {
        std::function<bool()> is_over;
        MonoTime limit;
        bool* ended;  // guarded by mutex_
    };

    const std::function<void()> wake_;
    std::vector<Wait> waits_;  // used by the loop thread only

    std::mutex mutex_;
    std::condition_variable changed_;
    // Guarded by mutex_:
    std::vector<std::function<void()>> work_;
    bool ended_ = false;
};

}  // namespace mavloom::feed
