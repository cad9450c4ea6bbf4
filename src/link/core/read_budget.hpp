// SPDX-License-Identifier: MIT
// Limits how much one socket gives to a turn, so that a sender whose frames cost much does not delay other sockets.
// Private to module link; single owner thread.
#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cstddef>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

// Counts datagrams or bytes. The limit falls at once and grows by `min` a turn, because a sender may mix cheap and
// costly datagrams. The time to send the frames at the end of the turn is not measured.
class ReadBudget {
public:
    ReadBudget(std::size_t min, std::size_t max) noexcept : min_(min), max_(max), limit_(max) { assert(min <= max); }

    // How much to read in this turn.
    [[nodiscard]] std::size_t limit() const noexcept { return limit_; }
    // Calls `work`, which handles `count` datagrams or bytes, `bytes` bytes in total, and adjusts the limit to the time
    // that it took. A few bytes at the full limit are not timed.
    void spend(std::size_t count, std::size_t bytes, auto&& work) {
        if (bytes < worth_measuring && limit_ == max_) return work();
        const MonoTime begin = mono_now();
        work();
        note(count, mono_now() - begin);
    }
    // Adjusts the limit: `count` datagrams or bytes were handled in `took`.
    void note(std::size_t count, Nanoseconds took) noexcept {
        const auto fits = count * turn_share / static_cast<std::size_t>(std::max(took.count(), Nanoseconds::rep{1}));
        limit_ = std::clamp(std::min(fits, limit_ + min_), min_, max_);
    }

private:
    static constexpr std::size_t worth_measuring = 4096;
    static constexpr std::size_t turn_share = 1'000'000;  // ns of a turn, for each socket

    std::size_t min_, max_, limit_;
};

}  // namespace mavloom::link::detail
