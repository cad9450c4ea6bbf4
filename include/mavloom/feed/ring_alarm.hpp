// SPDX-License-Identifier: MIT
// RingAlarm: a descriptor that becomes readable when a ring's reader has something to read, for epoll or asyncio.
// One thread serves all alarms of a process. It starts with the first alarm. Any thread. In a forked child, an alarm of
// the parent does nothing; it may be destroyed.
#pragma once

#include <functional>
#include <memory>

#include "mavloom/base/result.hpp"
#include "mavloom/feed/fork.hpp"
#include "mavloom/shm/ring_waiter.hpp"

namespace mavloom::feed {

class RingAlarm {
public:
    // Returns how long the reader can be left alone; 0 if something waits for it. It is called with a lock held, also
    // on the alarm thread. It must neither wait nor call functions of RingAlarm.
    using Nap = std::function<Nanoseconds()>;
    // Returns an alarm whose descriptor is readable, so that the first look at the ring is not missed.
    [[nodiscard]] static SetupResult<std::unique_ptr<RingAlarm>> make(shm::RingWaiter::WakeWord word, Nap nap);
    // Ends the thread. Armed alarms, and those that are armed later, become readable at once.
    static void stop_all();

    RingAlarm(const RingAlarm&) = delete;
    RingAlarm& operator=(const RingAlarm&) = delete;
    ~RingAlarm();

    // An eventfd. The alarm closes it; the caller reads it empty.
    [[nodiscard]] int fd() const noexcept { return fd_; }
    // Makes the descriptor readable once, when something waits; at once if something waits already.
    void arm();
    // Makes the descriptor readable now.
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

}  // namespace mavloom::feed
