// SPDX-License-Identifier: MIT
// How well each stream of a link kept its rate. Plain values, copied from a vehicle on its owner's thread.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/ids.hpp"

namespace mavloom::sim {

// Histogram of the delays with which messages were sent. Each bucket ends at twice the time of the one before: 10 us,
// 20 us, 40 us ... 5 s. The last one counts all messages with a longer delay.
struct Lateness {
    static constexpr std::size_t buckets = 21;
    std::array<std::uint32_t, buckets> counts{};

    void add(Nanoseconds late) noexcept;
    // The upper bound of the bucket in which the quantile lies; 0 if nothing was counted. `quantile` is 0 to 1.
    [[nodiscard]] Nanoseconds at(double quantile) const noexcept;
};

struct StreamReport {
    SystemId system;
    LinkId link;
    MessageId message;
    std::string_view name;  // of the message
    double asked_hz = 0;
    // (messages - 1) / (time from the first message sent to the last), without the time of skipped instants.
    double achieved_hz = 0;
    std::uint64_t sent = 0;
    std::uint64_t skipped = 0;  // messages that were never sent, because the machine stalled when they were due
    Lateness lateness;
};

}  // namespace mavloom::sim
