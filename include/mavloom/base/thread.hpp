// SPDX-License-Identifier: MIT
// A thread that no signal is delivered to: those are for the program's own threads.
#pragma once

#include <pthread.h>
#include <signal.h>

#include <thread>
#include <utility>

namespace mavloom {

// All signals blocked in the calling thread for as long as it lives; threads that begin meanwhile inherit that.
class BlockedSignals {
public:
    BlockedSignals() noexcept {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;
    ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

private:
    sigset_t before_;
};

// Throws std::system_error where the system has no thread left.
template <class Run>
[[nodiscard]] std::thread thread_without_signals(Run&& run) {
    const BlockedSignals blocked;
    return std::thread(std::forward<Run>(run));
}

}  // namespace mavloom
