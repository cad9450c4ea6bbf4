// SPDX-License-Identifier: MIT
// Lets an event loop (epoll, asyncio) wait for rings: a helper thread sleeps on them and calls back when a writer wakes
// its readers.
//
//     auto waiter = shm::RingWaiter([&] { loop.wake(); });
//     waiter.watch({{reader.wake_word()}});          // when the reader is opened
//     waiter.arm();                                  // nothing to read: arm the waiter first,
//     const auto nap = reader.arm();                 // then the reader
//     sleep_in_epoll(nap);
//
// Use it from one thread, or under one lock. Not movable. The thread starts with the first ring. Linux 5.16 or newer
// sleeps on all rings at once (futex_waitv). On older kernels the thread polls several rings every millisecond.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "mavloom/shm/detail/words.hpp"

namespace mavloom::shm {

class RingWaiter {
public:
    using WakeWord = std::shared_ptr<const SharedWords::Word32>;
    // Beyond this number, the thread sleeps on the first rings only. The caller sees changes of the others when it
    // polls.
    static constexpr std::size_t max_rings = 127;

    // After arm(), the helper thread calls `wake` once. `wake` must not throw, and may call arm().
    explicit RingWaiter(std::function<void()> wake);
    RingWaiter(const RingWaiter&) = delete;
    RingWaiter& operator=(const RingWaiter&) = delete;
    ~RingWaiter();  // stops the thread

    // Replaces the watched rings. Changes between this call and arm() are not missed.
    void watch(std::vector<WakeWord> rings);
    // Requests one call of `wake` at the next change of any ring. A change since the last call of `wake` may trigger it
    // at once. With `longest`, as returned by RingReader::arm(), `wake` is also called when that time is over. If
    // arm(longest) is called several times, the earliest time counts.
    void arm() noexcept;
    void arm(Nanoseconds longest) noexcept;
    void disarm() noexcept;

private:
    class Thread;
    std::function<void()> wake_;
    std::unique_ptr<Thread> thread_;
};

}  // namespace mavloom::shm
