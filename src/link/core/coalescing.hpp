// SPDX-License-Identifier: MIT
// Delays turns under heavy load, much as network cards coalesce interrupts. When frames arrive in quick succession, a
// turn for each frame would spend most of its time on waking up. With a minimum interval between turns, several frames
// share one turn's system calls and datagrams. Private to module link; single owner thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

class Coalescing {
public:
    // With `allowed` false, every turn may start at once.
    void allow(bool allowed) noexcept { allowed_ = allowed; }

    // Coalescing starts after a window with more than one frame every 20 us on average, and stops after a window with
    // fewer. Vehicles send far less than that, even in bursts.
    static constexpr Nanoseconds window = std::chrono::milliseconds{10};
    static constexpr std::int64_t many_frames = 500;
    static constexpr Nanoseconds turn_interval = std::chrono::microseconds{200};

    // Reports a finished turn: it began at `began`, ended at `now` and handled `frames`. `more_waits`: it left input
    // unread.
    void count(MonoTime began, MonoTime now, std::size_t frames, bool more_waits) noexcept {
        frames_ += static_cast<std::int64_t>(frames);
        if (const Nanoseconds passed = now - since_; passed >= window) {
            busy_ = passed < frames_ * (window / many_frames);
            since_ = now;
            frames_ = 0;
        }
        rest_until_.reset();
        if (allowed_ && busy_ && !more_waits && began + turn_interval > now) rest_until_ = began + turn_interval;
    }
    // When the next turn may start; empty: now.
    [[nodiscard]] std::optional<MonoTime> rest_until() const noexcept { return rest_until_; }

private:
    MonoTime since_{};
    std::int64_t frames_ = 0;
    bool busy_ = false, allowed_ = true;
    std::optional<MonoTime> rest_until_;
};

}  // namespace mavloom::link::detail
