// SPDX-License-Identifier: MIT
// Turns the sleep of ring readers into a call, for loops that wait in epoll or asyncio: one thread sleeps on the words of any number of rings, and calls
// back when the writer of one of them wakes its readers. The thread begins with the first ring; without one there is none.
//
//     auto waiter = shm::RingWaiter([&] { loop.wake(); });
//     waiter.watch({{reader.wake_word()}});          // when the reader is opened
//     waiter.arm();                                  // nothing to read: first the waiter,
//     const auto nap = reader.arm();                 // then the reader
//     sleep_in_epoll(nap);
//
// One owner thread, or one lock; not movable. Linux 5.16 or newer sleeps on all rings at once (futex_waitv); an older one looks at several each millisecond.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "mavloom/shm/detail/words.hpp"

namespace mavloom::shm {

class RingWaiter {
public:
    using WakeWord = std::shared_ptr<const SharedWords::Word32>;
    static constexpr std::size_t most_rings =
        127;  // of more only the first are slept on; the others are seen when they are polled

    // `wake` is called on the waiter's thread, once after each arm(); it must not throw, and may call arm().
    explicit RingWaiter(std::function<void()> wake);
    RingWaiter(const RingWaiter&) = delete;
    RingWaiter& operator=(const RingWaiter&) = delete;
    ~RingWaiter();  // ends the thread

    // The rings from now on, in the place of those before. A change between this call and arm() is not overlooked.
    void watch(std::vector<WakeWord> rings);
    // The next change is told, once. One that came since the last call may be told too. With `longest`, as RingReader::arm() gives it, the end of that
    // time is told as a change is; of several calls the earliest counts.
    void arm() noexcept;
    void arm(Nanoseconds longest) noexcept;
    void disarm() noexcept;

private:
    class Thread;
    std::function<void()> wake_;
    std::unique_ptr<Thread> thread_;
};

}  // namespace mavloom::shm
