// SPDX-License-Identifier: MIT
// An epoll event loop: it waits for descriptors, timers and wake-ups, then calls their handlers.
//
// The loop owns only its own descriptors; callers own the ones that it watches. One thread drives the loop. Only `wake`
// may be called from other threads, and from signal handlers. Waiting and dispatching allocate nothing.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/fd.hpp"

struct epoll_event;

namespace mavloom::net {

struct IoEvents {
    bool readable = false;
    bool writable = false;
    bool failed = false;  // an error or hang-up is pending; read or write to get the reason
};

class IoHandler {
public:
    virtual ~IoHandler() = default;
    virtual void on_io(IoEvents events) = 0;
};

class TimerHandler {
public:
    virtual ~TimerHandler() = default;
    virtual void on_timer(MonoTime now) = 0;
};

// Handles that `watch` and `start_timer` return. Using a stale one is harmless: it refers to nothing.
struct WatchId {
    std::uint32_t slot = 0, generation = 0;
    [[nodiscard]] bool valid() const noexcept { return generation != 0; }
};
struct TimerId {
    MonoTime when{};
    std::uint64_t number = 0;
    [[nodiscard]] bool valid() const noexcept { return number != 0; }
    friend auto operator<=>(const TimerId&, const TimerId&) = default;
};

class EventLoop {
public:
    [[nodiscard]] static SetupResult<std::unique_ptr<EventLoop>> create();
    EventLoop(const EventLoop&) = delete;
    EventLoop& operator=(const EventLoop&) = delete;
    ~EventLoop();

    // Watches `fd`, level-triggered. `handler` must live until `unwatch`. A callback may call `unwatch`: events that
    // are still pending for that handler are then discarded.
    [[nodiscard]] SetupResult<WatchId> watch(int fd, bool readable, bool writable, IoHandler& handler);
    void change(WatchId id, bool readable, bool writable) noexcept;
    void unwatch(WatchId& id) noexcept;

    // Calls `handler` once, at or after `when`.
    [[nodiscard]] TimerId start_timer(MonoTime when, TimerHandler& handler);
    // Does nothing for an expired or empty timer.
    void cancel_timer(TimerId& id) noexcept;

    // Waits for an event, a due timer or `deadline`, whichever comes first. May occasionally return early with nothing
    // to do.
    void wait(MonoTime deadline) noexcept;
    // Sleeps until `when` or a signal. Nothing else ends the sleep, not even `wake`.
    static void sleep_until(MonoTime when) noexcept;
    // Calls the due timers, then the handlers of the events that `wait` found. Returns true if `wake` was called.
    bool dispatch(MonoTime now);
    bool run_once(MonoTime deadline) {
        wait(deadline);
        return dispatch(mono_now());
    }

    void wake() noexcept;
    // Shared ownership of the wake-up descriptor, for helper threads that may outlive the loop.
    [[nodiscard]] std::shared_ptr<const Fd> wake_handle() const noexcept { return wake_; }
    static void wake(const Fd& handle) noexcept;

private:
    struct Watch {
        IoHandler* handler = nullptr;
        int fd = -1;
        std::uint32_t generation = 1;
    };
    EventLoop(Fd epoll, Fd alarm, std::shared_ptr<const Fd> wake);

    void set_alarm(MonoTime when) noexcept;
    void run_timers(MonoTime now);
    [[nodiscard]] Watch* find(WatchId id) noexcept;

    Fd epoll_;
    Fd alarm_;  // a timerfd, used for all but short waits
    MonoTime alarm_at_ = MonoTime::max();
    std::shared_ptr<const Fd> wake_;
    std::vector<Watch> watches_;
    std::vector<std::uint32_t> free_;
    std::map<TimerId, TimerHandler*> timers_;
    std::uint64_t last_timer_ = 0;
    std::unique_ptr<epoll_event[]> events_;
    int count_ = 0;
};

}  // namespace mavloom::net
