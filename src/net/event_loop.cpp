// SPDX-License-Identifier: MIT
#include "mavloom/net/event_loop.hpp"

#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <ctime>

namespace mavloom::net {

static constexpr int events_per_wait = 64;
static constexpr std::uint64_t wake_token = 0, alarm_token = 1;
// A wait of at most this length passes its timeout to epoll. A longer one uses the alarm (a timerfd).
static constexpr std::chrono::milliseconds short_wait{10};

static std::uint32_t interest(bool readable, bool writable) noexcept {
    return (readable ? std::uint32_t{EPOLLIN} : 0) | (writable ? std::uint32_t{EPOLLOUT} : 0);
}

static timespec timespec_of(Nanoseconds time) noexcept {
    return {static_cast<std::time_t>(time.count() / 1'000'000'000), static_cast<long>(time.count() % 1'000'000'000)};
}

// Generations start at 1, so no token equals wake_token or alarm_token.
static std::uint64_t token_of(WatchId id) noexcept { return std::uint64_t{id.generation} << 32 | id.slot; }

SetupResult<std::unique_ptr<EventLoop>> EventLoop::create() {
    Fd epoll(epoll_create1(EPOLL_CLOEXEC));
    if (!epoll) return system_error("cannot create an epoll descriptor", errno);
    auto wake = std::make_shared<const Fd>(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
    if (!*wake) return system_error("cannot create an event descriptor", errno);
    Fd alarm(timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK));
    if (!alarm) return system_error("cannot create a timer descriptor", errno);
    epoll_event on_wake{EPOLLIN, {.u64 = wake_token}};
    epoll_event on_alarm{EPOLLIN | EPOLLET, {.u64 = alarm_token}};  // never read: setting the timer again clears it
    if (epoll_ctl(epoll.get(), EPOLL_CTL_ADD, wake->get(), &on_wake) != 0 ||
        epoll_ctl(epoll.get(), EPOLL_CTL_ADD, alarm.get(), &on_alarm) != 0)
        return system_error("cannot watch a descriptor", errno);
    return std::unique_ptr<EventLoop>(new EventLoop(std::move(epoll), std::move(alarm), std::move(wake)));
}

EventLoop::EventLoop(Fd epoll, Fd alarm, std::shared_ptr<const Fd> wake)
    : epoll_(std::move(epoll)),
      alarm_(std::move(alarm)),
      wake_(std::move(wake)),
      events_(std::make_unique<epoll_event[]>(events_per_wait)) {}

EventLoop::~EventLoop() = default;

SetupResult<WatchId> EventLoop::watch(int fd, bool readable, bool writable, IoHandler& handler) {
    if (free_.empty()) {
        free_.push_back(static_cast<std::uint32_t>(watches_.size()));
        watches_.emplace_back();
    }
    const std::uint32_t slot = free_.back();
    assert(watches_[slot].handler == nullptr && watches_[slot].generation != 0);
    const WatchId id{slot, watches_[slot].generation};
    epoll_event event{};
    event.events = interest(readable, writable);
    event.data.u64 = token_of(id);
    if (epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, fd, &event) != 0)
        return system_error("cannot watch a descriptor", errno);
    free_.pop_back();
    watches_[slot].handler = &handler;
    watches_[slot].fd = fd;
    return id;
}

EventLoop::Watch* EventLoop::find(WatchId id) noexcept {
    if (id.slot >= watches_.size()) return nullptr;
    Watch& watch = watches_[id.slot];
    return watch.generation == id.generation && watch.handler != nullptr ? &watch : nullptr;
}

void EventLoop::change(WatchId id, bool readable, bool writable) noexcept {
    const Watch* watch = find(id);
    if (watch == nullptr) return;
    epoll_event event{};
    event.events = interest(readable, writable);
    event.data.u64 = token_of(id);
    epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, watch->fd, &event);
}

void EventLoop::unwatch(WatchId& id) noexcept {
    if (Watch* watch = find(id)) {
        epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, watch->fd, nullptr);
        watch->handler = nullptr;
        watch->fd = -1;
        watch->generation = std::max(watch->generation + 1, 1u);
        free_.push_back(id.slot);
        assert(free_.size() <= watches_.size());
    }
    id = {};
}

TimerId EventLoop::start_timer(MonoTime when, TimerHandler& handler) {
    const TimerId id{when, ++last_timer_};
    assert(!timers_.contains(id));
    timers_.emplace(id, &handler);
    return id;
}

void EventLoop::cancel_timer(TimerId& id) noexcept {
    timers_.erase(id);
    id = {};
}

// Leaves an earlier alarm as it is. Deadlines move with every turn, and the next alarm is set after this one has fired.
void EventLoop::set_alarm(MonoTime when) noexcept {
    if (alarm_at_ <= when) return;
    alarm_at_ = when;
    const itimerspec at{{}, timespec_of(when.time_since_epoch())};
    timerfd_settime(alarm_.get(), TFD_TIMER_ABSTIME, &at, nullptr);
}

// An epoll timeout makes the kernel program the machine's timer before the wait, and again after it. In a virtual
// machine, that takes longer than receiving a datagram. So long waits rely on the alarm, which is rarely set.
void EventLoop::wait(MonoTime deadline) noexcept {
    if (!timers_.empty()) deadline = std::min(deadline, timers_.begin()->first.when);
    const Nanoseconds left = deadline == MonoTime::max() ? Nanoseconds::max()
                                                         : std::max(deadline - mono_now(), Nanoseconds{});
    const bool is_short = left <= short_wait;
    if (!is_short && deadline != MonoTime::max()) set_alarm(deadline);
    // epoll_pwait2 has nanosecond timeouts. Before Linux 5.11 there are only milliseconds, rounded up so that the loop
    // does not spin.
    const timespec limit = timespec_of(is_short ? left : Nanoseconds{});
    count_ = epoll_pwait2(epoll_.get(), events_.get(), events_per_wait, is_short ? &limit : nullptr, nullptr);
    if (count_ >= 0 || errno != ENOSYS) return;
    const int ms = is_short ? static_cast<int>((left.count() + 999'999) / 1'000'000) : -1;
    count_ = epoll_wait(epoll_.get(), events_.get(), events_per_wait, ms);
}

void EventLoop::sleep_until(MonoTime when) noexcept {
    const timespec at = timespec_of(when.time_since_epoch());
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr);
}

// Timers that a callback starts wait for the next turn, even if they are already due.
void EventLoop::run_timers(MonoTime now) {
    const std::uint64_t newest = last_timer_;
    for (auto it = timers_.begin(); it != timers_.end() && it->first.when <= now;) {
        if (it->first.number > newest) {
            ++it;
            continue;
        }
        TimerHandler* const handler = it->second;
        timers_.erase(it);
        handler->on_timer(now);
        it = timers_.begin();
    }
}

bool EventLoop::dispatch(MonoTime now) {
    run_timers(now);
    bool woken = false;
    for (int i = 0; i < count_; ++i) {
        const epoll_event& event = events_[i];
        if (event.data.u64 == wake_token) {
            std::uint64_t times;
            woken = ::read(wake_->get(), &times, sizeof times) == sizeof times || woken;
            continue;
        }
        if (event.data.u64 == alarm_token) {
            alarm_at_ = MonoTime::max();
            continue;
        }
        const Watch* watch = find(
            {static_cast<std::uint32_t>(event.data.u64), static_cast<std::uint32_t>(event.data.u64 >> 32)});
        if (watch == nullptr) continue;  // unwatched by an earlier callback in this turn
        watch->handler->on_io({(event.events & (EPOLLIN | EPOLLHUP | EPOLLRDHUP)) != 0, (event.events & EPOLLOUT) != 0,
                               (event.events & (EPOLLERR | EPOLLHUP)) != 0});
    }
    return woken;
}

void EventLoop::wake(const Fd& handle) noexcept {
    const std::uint64_t one = 1;
    // Fails only if 2^64 - 2 wake-ups are pending. The loop then wakes up anyway.
    [[maybe_unused]] const auto written = ::write(handle.get(), &one, sizeof one);
}

void EventLoop::wake() noexcept { wake(*wake_); }

}  // namespace mavloom::net
