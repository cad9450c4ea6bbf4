// SPDX-License-Identifier: MIT
// Waits for descriptors, instants and wake-ups by epoll, and calls those who asked. It owns no descriptor but its own.
// One thread drives it; only `wake` may be called from others, and from a signal handler. Waiting and dispatch allocate nothing.
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
    bool failed = false;  // an error or hang-up is pending; reading or writing tells which
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

// What `watch` and `start_timer` give. Stale ids are harmless: they name nothing any more.
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

    // Level-triggered. `handler` must stay until `unwatch`, which may be called inside any callback: what is pending for it is not
    // delivered then.
    [[nodiscard]] SetupResult<WatchId> watch(int fd, bool readable, bool writable, IoHandler& handler);
    void change(WatchId id, bool readable, bool writable) noexcept;
    void unwatch(WatchId& id) noexcept;

    // Once, at or after `when`. Cancelling an expired or empty id does nothing.
    [[nodiscard]] TimerId start_timer(MonoTime when, TimerHandler& handler);
    void cancel_timer(TimerId& id) noexcept;

    // Waits until something happens, a timer is due, or `deadline`. May now and then return before with nothing to do.
    void wait(MonoTime deadline) noexcept;
    // Sleeps until `when` or a signal; nothing else ends it, `wake` neither.
    static void sleep_until(MonoTime when) noexcept;
    // Calls the handlers of what `wait` found: timers first. Returns true when `wake` was among the causes.
    bool dispatch(MonoTime now);
    bool run_once(MonoTime deadline) {
        wait(deadline);
        return dispatch(mono_now());
    }

    void wake() noexcept;
    // A duplicate of the wake-up's owner, for helper threads that may outlive the loop.
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
    Fd alarm_;  // a timerfd, for waits that are not short
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
