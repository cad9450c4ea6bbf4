// SPDX-License-Identifier: MIT
// Delays turns under heavy load, much as network cards coalesce interrupts. When frames arrive in quick succession, a
// turn for each frame would spend most of its time on waking up. With a minimum interval between turns, several frames
// share one turn's system calls and datagrams. Private to module link; single owner thread.
#pragma once

#include <algorithm>
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
    // It also starts after a window with this many frames sent. Copies for many peers cost a datagram each, however
    // small. So the interval then grows with the datagrams of a turn, and more frames share them.
    static constexpr std::int64_t many_sent = 2000;
    static constexpr Nanoseconds interval_per_datagram = std::chrono::microseconds{10};
    static constexpr Nanoseconds max_interval = std::chrono::milliseconds{5};

    struct Turn {
        MonoTime began{};
        std::size_t frames = 0;  // handled
        std::size_t sent_frames = 0, sent_datagrams = 0;
        bool more_waits = false;  // it left input unread
    };
    // Reports a turn that ended at `now`.
    void count(const Turn& turn, MonoTime now) noexcept {
        frames_ += static_cast<std::int64_t>(turn.frames);
        sent_ += static_cast<std::int64_t>(turn.sent_frames);
        if (const Nanoseconds passed = now - since_; passed >= window) {
            is_busy_ = passed < frames_ * (window / many_frames);
            sends_much_ = passed < sent_ * (window / many_sent);
            since_ = now;
            frames_ = sent_ = 0;
        }
        rest_until_.reset();
        const MonoTime next = turn.began + interval_after(turn.sent_datagrams);
        if (allowed_ && !turn.more_waits && next > now) rest_until_ = next;
    }
    // When the next turn may start; empty: now.
    [[nodiscard]] std::optional<MonoTime> rest_until() const noexcept { return rest_until_; }

private:
    // The shortest time between the beginning of a turn that sent so many datagrams and the next one.
    [[nodiscard]] Nanoseconds interval_after(std::size_t datagrams) const noexcept {
        if (sends_much_)
            return std::clamp<Nanoseconds>(static_cast<std::int64_t>(datagrams) * interval_per_datagram, turn_interval,
                                           max_interval);
        return is_busy_ ? turn_interval : Nanoseconds{};
    }

    MonoTime since_{};
    std::int64_t frames_ = 0, sent_ = 0;
    bool is_busy_ = false, sends_much_ = false, allowed_ = true;
    std::optional<MonoTime> rest_until_;
};

}  // namespace mavloom::link::detail
