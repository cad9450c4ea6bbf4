// SPDX-License-Identifier: MIT
// How long to wait before the next attempt: 100 ms first, doubling to 5 s, for ever (DESIGN.md section 4). Private to module runtime.
#pragma once

#include <algorithm>
#include <utility>

#include "mavloom/base/clock.hpp"

namespace mavloom::runtime::detail {

class Backoff {
public:
    static constexpr Nanoseconds first = std::chrono::milliseconds(100);
    static constexpr Nanoseconds longest = std::chrono::seconds(5);

    [[nodiscard]] Nanoseconds next() noexcept { return std::exchange(delay_, std::min(delay_ * 2, longest)); }
    void reset() noexcept { delay_ = first; }

private:
    Nanoseconds delay_ = first;
};

}  // namespace mavloom::runtime::detail
