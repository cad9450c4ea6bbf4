// SPDX-License-Identifier: MIT
// Limits how much one socket gives to a turn, so that a sender whose frames cost much does not delay other sockets.
// Private to module link; single owner thread.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

// Counts datagrams or bytes. The limit falls at once and grows by `least` a turn, because a sender may mix cheap and
// costly datagrams. Reading less than `worth_measuring` bytes never takes long enough to look at the clock.
class ReadBudget {
public:
    static constexpr std::size_t worth_measuring = 16 * 1024;

    ReadBudget(std::size_t least, std::size_t most) noexcept : least_(least), most_(most), limit_(most) {}

    // How much to read in this turn.
    [[nodiscard]] std::size_t limit() const noexcept { return limit_; }
    // Call it after `count` of them were handled, in `took`; zero if that was not measured.
    void note(std::size_t count, Nanoseconds took) noexcept {
        const auto fits = took <= Nanoseconds{} ? most_ : count * turn_share / static_cast<std::size_t>(took.count());
        limit_ = std::clamp(std::min(fits, limit_ + least_), least_, most_);
    }

private:
    static constexpr std::size_t turn_share = 1'000'000;  // ns of a turn, for each socket

    std::size_t least_, most_, limit_;
};

}  // namespace mavloom::link::detail
