// SPDX-License-Identifier: MIT
// The way of one vehicle: where it was, how high, how fast, how far. Private to module observe.
#pragma once

#include <optional>

#include "mavloom/observe/summary.hpp"

namespace mavloom::observe {

class JourneyLog {
public:
    // `is_flown`: the way to this place counts as distance.
    void add(const Fix& fix, std::optional<double> speed_m_s, bool is_flown, bool with_track);
    [[nodiscard]] const Journey& journey() const noexcept { return journey_; }

private:
    // Positions come up to 50 times a second; maps need a few. If a flight is long, every other point is dropped.
    static constexpr std::size_t max_points = 1u << 16;
    static constexpr Nanoseconds first_interval = std::chrono::milliseconds{200}, longest_gap = std::chrono::seconds{10};

    [[nodiscard]] bool move_to(const Fix& fix, bool is_flown) noexcept;
    void add_point(const Fix& fix, bool jumped);
    void thin_out();

    Journey journey_;
    Fix anchor_;  // the end of the distance so far
    Nanoseconds interval_ = first_interval, last_point_{};
};

}  // namespace mavloom::observe
