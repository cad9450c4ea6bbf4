// SPDX-License-Identifier: MIT
// Limits the log lines about one subject, so that an event that repeats cannot flood the log. Single owner thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

namespace mavloom {

// Allows a burst of 100 lines, then two more after each refill. Counts the lines that it suppresses.
class LineBudget {
public:
    static constexpr std::size_t burst = 100, each_refill = 2;

    // Spends one line. If none is left, counts the line as suppressed and returns false.
    [[nodiscard]] bool spend() noexcept {
        if (left_ == 0) {
            ++suppressed_;
            return false;
        }
        --left_;
        return true;
    }
    // Adds two lines, up to the burst. Returns how many lines were suppressed since the last refill.
    [[nodiscard]] std::size_t refill() noexcept {
        left_ = std::min(burst, left_ + each_refill);
        return std::exchange(suppressed_, 0);
    }

private:
    std::size_t left_ = burst, suppressed_ = 0;
};

}  // namespace mavloom
