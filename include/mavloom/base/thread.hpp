// SPDX-License-Identifier: MIT
// Starts threads that receive no signals, so that signals reach only the program's own threads.
#pragma once

#include <pthread.h>
#include <signal.h>

#include <thread>
#include <utility>

namespace mavloom {

// While this object lives, the calling thread blocks all signals except those that report its own faults. A thread
// started during that time inherits the signal mask.
class BlockedSignals {
public:
    BlockedSignals() noexcept {
        sigset_t all;
        ::sigfillset(&all);
        // If a thread blocks these, a fault of its own ends the process, whatever handler is installed (sigaction(2)).
        for (const int fault : {SIGBUS, SIGSEGV, SIGFPE, SIGILL, SIGTRAP}) ::sigdelset(&all, fault);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;
    ~BlockedSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

private:
    sigset_t before_;
};

// Throws std::system_error if the system cannot create a thread.
template <class Run>
[[nodiscard]] std::thread thread_without_signals(Run&& run) {
    const BlockedSignals blocked;
    return std::thread(std::forward<Run>(run));
}

}  // namespace mavloom
