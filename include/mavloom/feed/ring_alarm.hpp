// SPDX-License-Identifier: MIT
// RingAlarm: a descriptor that becomes readable when a ring's reader has something to read, for epoll or asyncio. One
// thread serves all alarms of a process; it starts with the first alarm. Any thread may call the functions. In a forked
// child, an alarm of the parent does nothing, and may be destroyed.
#pragma once

#include <functional>
#include <memory>

#include "mavloom/base/result.hpp"
#include "mavloom/feed/fork.hpp"
#include "mavloom/shm/ring_waiter.hpp"

namespace mavloom::feed {

class RingAlarm {
public:
    // Returns the time after which the alarm thread must check the reader again, or 0 if the reader has something to
    // read. It is called with a lock held, on the alarm thread or on a thread that calls RingAlarm. It must neither
    // wait nor call functions of RingAlarm.
    using SleepTime = std::function<Nanoseconds()>;
    // Returns an alarm whose descriptor is already readable, so that the caller checks the ring once before it waits.
    [[nodiscard]] static SetupResult<std::unique_ptr<RingAlarm>> make(shm::RingWaiter::WakeWord word,
                                                                      SleepTime sleep_time);
    // Ends the thread. Armed alarms, and those that are armed later, become readable at once.
    static void stop_all();

    RingAlarm(const RingAlarm&) = delete;
    RingAlarm& operator=(const RingAlarm&) = delete;
    ~RingAlarm();

    // An eventfd. The alarm closes it; the caller reads it to clear it.
    [[nodiscard]] int fd() const noexcept { return fd_; }
    // Makes the descriptor readable once, as soon as there is something to read.
    void arm();
    // Makes the descriptor readable now.
    void signal() const noexcept;

private:
    class Clock;
    RingAlarm(int fd, shm::RingWaiter::WakeWord word, SleepTime sleep_time);

    const ForkGuard fork_;
    const int fd_;
    const shm::RingWaiter::WakeWord word_;
    const SleepTime sleep_time_;
    Clock& clock_;
    bool armed_ = false;  // guarded by the clock's mutex
};

}  // namespace mavloom::feed
