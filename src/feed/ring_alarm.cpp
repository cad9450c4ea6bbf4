// SPDX-License-Identifier: MIT
#include "mavloom/feed/ring_alarm.hpp"

#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <mutex>
#include <system_error>
#include <utility>
#include <vector>

namespace mavloom::feed {

// All alarms of a process. A forked child creates a new Clock and leaves the old one alone, whose thread and locks
// stayed in the parent.
class RingAlarm::Clock {
public:
    [[nodiscard]] static Clock& here() {
        Clock* known = current.load();
        while (known == nullptr || !known->fork_.is_own_process()) {
            auto made = std::make_unique<Clock>();
            if (current.compare_exchange_strong(known, made.get())) return *made.release();
        }
        return *known;
    }
    [[nodiscard]] static Clock* made() noexcept { return current.load(); }
    [[nodiscard]] bool is_own_process() const noexcept { return fork_.is_own_process(); }

    void add(RingAlarm& alarm) {
        const std::lock_guard lock(mutex_);
        alarms_.push_back(&alarm);
        try {
            watch();
        } catch (...) {
            alarms_.pop_back();
            throw;
        }
    }
    void remove(RingAlarm& alarm) {
        const std::lock_guard lock(mutex_);
        std::erase(alarms_, &alarm);
        watch();
    }
    void arm(RingAlarm& alarm) {
        const std::lock_guard lock(mutex_);
        alarm.armed_ = true;
        if (waiter_) waiter_->arm();  // before looking at the ring, so that no later record is missed
        poll(alarm);
    }
    void stop() {
        std::unique_ptr<shm::RingWaiter> ending;  // joined after the mutex is unlocked, because the thread may need it
        const std::lock_guard lock(mutex_);
        ending = std::exchange(waiter_, nullptr);
        poll_all();
    }

private:
    void watch() {
        if (!waiter_) return;
        std::vector<shm::RingWaiter::WakeWord> words;
        words.reserve(alarms_.size());
        for (const auto* alarm : alarms_) words.push_back(alarm->word_);
        is_crowded_ = words.size() > shm::RingWaiter::max_rings;
        waiter_->watch(std::move(words));
        poll_all();
    }
    // Also called on the waiter's thread.
    void poll_all() {
        if (waiter_) waiter_->arm();
        for (auto* alarm : alarms_)
            if (alarm->armed_) poll(*alarm);
    }
    void poll(RingAlarm& alarm) {
        Nanoseconds sleep_time = waiter_ ? alarm.sleep_time_() : Nanoseconds{};
        if (is_crowded_) sleep_time = std::min<Nanoseconds>(sleep_time, std::chrono::milliseconds{1});
        alarm.armed_ = sleep_time != Nanoseconds{};
        if (alarm.armed_) waiter_->arm(sleep_time);
        else alarm.signal();
    }

    inline static std::atomic<Clock*> current{nullptr};
    const ForkGuard fork_;
    std::mutex mutex_;
    // Guarded by mutex_:
    std::vector<RingAlarm*> alarms_;
    bool is_crowded_ = false;  // more rings than the thread can sleep on
    std::unique_ptr<shm::RingWaiter> waiter_ = std::make_unique<shm::RingWaiter>([this] {
        const std::lock_guard lock(mutex_);
        poll_all();
    });
};

SetupResult<std::unique_ptr<RingAlarm>> RingAlarm::make(shm::RingWaiter::WakeWord word, SleepTime sleep_time) {
    const int fd = ::eventfd(1, EFD_NONBLOCK | EFD_CLOEXEC);
    if (fd < 0) return system_error("eventfd", errno);
    std::unique_ptr<RingAlarm> alarm(new RingAlarm(fd, std::move(word), std::move(sleep_time)));
    try {
        alarm->clock_.add(*alarm);
    } catch (const std::system_error& error) {
        return system_error("cannot start the thread that waits for rings", error.code().value());
    }
    return alarm;
}

RingAlarm::RingAlarm(int fd, shm::RingWaiter::WakeWord word, SleepTime sleep_time)
    : fd_(fd), word_(std::move(word)), sleep_time_(std::move(sleep_time)), clock_(Clock::here()) {}

RingAlarm::~RingAlarm() {
    if (fork_.is_own_process()) clock_.remove(*this);
    ::close(fd_);
}

void RingAlarm::arm() {
    if (fork_.is_own_process()) clock_.arm(*this);
}

void RingAlarm::signal() const noexcept {
    if (!fork_.is_own_process()) return;  // the parent would be signalled too: both share the eventfd
    const std::uint64_t one = 1;
    // If the counter is full, the write fails and the descriptor is readable already.
    [[maybe_unused]] const auto written = ::write(fd_, &one, sizeof one);
}

void RingAlarm::stop_all() {
    if (auto* const clock = Clock::made(); clock != nullptr && clock->is_own_process()) clock->stop();
}

}  // namespace mavloom::feed
