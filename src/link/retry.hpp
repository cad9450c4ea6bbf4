// SPDX-License-Identifier: MIT
// Retries an endpoint indefinitely. The delay is 100 ms after the first failure and doubles up to 5 s. The first
// failure of a series is reported, and each that has another cause. Private to module link; single owner thread.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "link/core/core.hpp"

namespace mavloom::link::detail {

// The endpoint's retry timer. When it fires, `handler` decides what to do.
class Retry {
public:
    static constexpr Nanoseconds initial_delay = std::chrono::milliseconds(100);
    static constexpr Nanoseconds max_delay = std::chrono::seconds(5);
    static constexpr std::size_t max_reports = 4;
    // After a connection that lasted this long, the delay starts again at `initial_delay`.
    static constexpr std::chrono::seconds lasting{5};

    Retry(Core& core, OpenEndpoint& endpoint, net::TimerHandler& handler)
        : core_(core), endpoint_(endpoint), handler_(handler) {}
    Retry(const Retry&) = delete;
    Retry& operator=(const Retry&) = delete;
    ~Retry() { cancel(); }

    void fail(const SetupError& error) {
        report(error.text, "trying again");
        fail_silently(error);
    }
    // Retries without a report, for an error that was already reported.
    void fail_silently(const SetupError& error) {
        endpoint_.failure = error;
        later();
    }
    void report(std::string_view what, std::string_view then) {
        if (std::ranges::find(reported_, what) != reported_.end() || reported_.size() == max_reports) return;
        reported_.emplace_back(what);
        core_.events.notice(endpoint_.info.id, fmt::format("{}: {}; {}", endpoint_.info.endpoint.label(), what, then));
    }
    [[nodiscard]] bool is_failing() const noexcept { return !reported_.empty(); }
    // Ends the series: the next failure is reported again.
    void settle() noexcept { reported_.clear(); }
    void reset() noexcept { delay_ = initial_delay; }

    void later() { after(std::exchange(delay_, std::min(delay_ * 2, max_delay))); }
    void after(Nanoseconds delay) {
        cancel();
        timer_ = core_.loop().start_timer(core_.now() + delay, handler_);
    }
    void cancel() noexcept { core_.loop().cancel_timer(timer_); }
    [[nodiscard]] bool waits() const noexcept { return timer_.valid(); }
    [[nodiscard]] bool within(Nanoseconds delay) const noexcept {
        return timer_.valid() && timer_.when - core_.now() <= delay;
    }
    // Call it first in a handler that has other timers, or that uses `waits` or `within`. Returns false if another
    // timer fired.
    bool fired(MonoTime now) noexcept {
        if (!timer_.valid() || timer_.when > now) return false;
        timer_ = {};
        return true;
    }

private:
    Core& core_;
    OpenEndpoint& endpoint_;
    net::TimerHandler& handler_;
    net::TimerId timer_;
    Nanoseconds delay_ = initial_delay;
    std::vector<std::string> reported_;  // causes, in this series
};

}  // namespace mavloom::link::detail
