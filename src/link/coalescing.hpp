// SPDX-License-Identifier: MIT
// When turns begin, as network cards coalesce interrupts: where frames come so fast that the next is there as soon as a turn is over, a router
// that takes each by itself spends most of its time in waking up. Turns that begin at least an interval apart share system calls and datagrams.
// Private to module link.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "mavloom/base/clock.hpp"

namespace mavloom::link::detail {

class Coalescing {
public:
    // Without it every turn may begin at once.
    void allow(bool allowed) noexcept { allowed_ = allowed; }

    // It begins with a window of more than a frame every 20 us, far more than vehicles send, a burst of them included; and ends with one of fewer.
    static constexpr Nanoseconds window = std::chrono::milliseconds{10};
    static constexpr std::int64_t many_frames = 500;
    static constexpr Nanoseconds turn_interval = std::chrono::microseconds{200};

    // A turn that began at `began` and is over at `now` has handled `frames`, and left more to be read if `more_waits`.
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
    // When the next turn may begin; nothing where that is now.
    [[nodiscard]] std::optional<MonoTime> rest_until() const noexcept { return rest_until_; }

private:
    MonoTime since_{};
    std::int64_t frames_ = 0;
    bool busy_ = false, allowed_ = true;
    std::optional<MonoTime> rest_until_;
};

}  // namespace mavloom::link::detail
