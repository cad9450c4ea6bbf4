// SPDX-License-Identifier: MIT
// A descriptor that tells a loop (asyncio, epoll) when a ring's reader has something to read. Behind all of a process stands one thread, which begins with
// the first of them and never touches Python. Any thread.
#pragma once

#include <functional>
#include <memory>

#include "mavloom/shm/ring_waiter.hpp"
#include "waiting.hpp"

namespace mavloom::python {

class RingAlarm {
public:
    // How long the reader may be left alone, 0 when something waits for it. Called with a lock held, on the thread as well: must not wait.
    using Nap = std::function<Nanoseconds()>;
    [[nodiscard]] static SetupResult<std::unique_ptr<RingAlarm>> make(shm::RingWaiter::WakeWord word, Nap nap);
    // At the interpreter's exit: ends the thread. Those that are armed later tell at once.
    static void stop_all();

    RingAlarm(const RingAlarm&) = delete;
    RingAlarm& operator=(const RingAlarm&) = delete;
    ~RingAlarm();

    [[nodiscard]] int fd() const noexcept { return fd_; }
    // Becomes readable, once, when something waits; at once where it does already.
    void arm();
    // Becomes readable now.
    void tell() const noexcept;

private:
    class Clock;
    RingAlarm(int fd, shm::RingWaiter::WakeWord word, Nap nap);

    const BeforeFork fork_;
    const int fd_;
    const shm::RingWaiter::WakeWord word_;
    const Nap nap_;
    Clock& clock_;
    bool armed_ = false;  // guarded by the clock's mutex
};

}  // namespace mavloom::python
