// SPDX-License-Identifier: MIT
// How an endpoint tries again for ever: 100 ms after the first failure, doubling to 5 s (DESIGN.md section 4); of a series of failures the
// first is told. Private to module link; one owner thread.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "link/core.hpp"

namespace mavloom::link::detail {

// The endpoint's one timer for that: when it fires, `handler` looks what is to be done.
class Retry {
public:
    static constexpr Nanoseconds first = std::chrono::milliseconds(100);
    static constexpr Nanoseconds longest = std::chrono::seconds(5);
    // A connection that held for so long begins anew with the first delay when it ends.
    static constexpr std::chrono::seconds lasting{5};

    Retry(Core& core, OpenEndpoint& endpoint, net::TimerHandler& handler)
        : core_(core), endpoint_(endpoint), handler_(handler) {}
    Retry(const Retry&) = delete;
    Retry& operator=(const Retry&) = delete;
    ~Retry() { cancel(); }

    void fail(const SetupError& error) {
        tell(error.text, "trying again");
        fail_silently(error);
    }
    // Of one that was told of already.
    void fail_silently(const SetupError& error) {
        endpoint_.failure = error;
        later();
    }
    void tell(std::string_view what, std::string_view then) {
        if (std::exchange(told_, true)) return;
        core_.notice(endpoint_.info.id, fmt::format("{}: {}; {}", endpoint_.info.endpoint.label(), what, then));
    }
    [[nodiscard]] bool failing() const noexcept { return told_; }
    // The next failure is the first of another series.
    void settle() noexcept { told_ = false; }
    void begin_anew() noexcept { delay_ = first; }

    void later() { after(std::exchange(delay_, std::min(delay_ * 2, longest))); }
    void after(Nanoseconds delay) {
        cancel();
        timer_ = core_.loop().start_timer(core_.now() + delay, handler_);
    }
    void cancel() noexcept { core_.loop().cancel_timer(timer_); }
    [[nodiscard]] bool waits() const noexcept { return timer_.valid(); }
    [[nodiscard]] bool within(Nanoseconds delay) const noexcept {
        return timer_.valid() && timer_.when - core_.now() <= delay;
    }
    // For a handler that has other timers too, or asks `waits` or `within`, to call first; false when it was another timer that fired.
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
    Nanoseconds delay_ = first;
    bool told_ = false;
};

}  // namespace mavloom::link::detail
