// SPDX-License-Identifier: MIT
// Limits frames to their Rates, separately for each source and message. Its deadlines do not drift: a 12 Hz stream
// limited to 10 Hz is sent at 10 Hz, not at 6. Frames may arrive early or late: a 10 Hz stream with jitter passes a
// limit of 10 Hz whole. One owner thread; allocates only at construction. `Time` is MonoTime for links, and WallTime
// for recordings, whose frames carry their own time.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <utility>
#include <vector>

#include "mavloom/base/secret_hash.hpp"
#include "mavloom/dialect/rates.hpp"
#include "mavloom/wire/frame.hpp"

namespace mavloom::dialect {

template <class Time>
class RateLimiter {
    struct Stream {
        std::uint64_t key = no_stream;
        Time due = Time::min();
    };

public:
    // The answer of `ask`. Pass it to `count` once the frame is sent.
    struct Answer {
        bool admitted = true;
        Stream* stream = nullptr;  // null if this message has no limit
        Nanoseconds interval{};
    };

    RateLimiter() = default;
    explicit RateLimiter(Rates rates) : rates_(std::move(rates)), streams_(rates_.empty() ? 0 : sets * ways) {}

    [[nodiscard]] bool limits() const noexcept { return !rates_.empty(); }

    // Checks whether a frame is within its rate, without counting it. Frames with different `lane` values are limited
    // separately: each lane may use the full rate.
    [[nodiscard]] Answer ask(const wire::FrameView& frame, Time now, std::uint8_t lane = 0) noexcept {
        const Nanoseconds* const interval = limits() ? rates_.interval_of(frame.id()) : nullptr;
        if (interval == nullptr) return {};
        const auto source = std::uint64_t{lane} << 16 | std::uint64_t{frame.system().value} << 8 |
                            frame.component().value;
        Stream& stream = stream_of(source << 24 | frame.id().value);
        // A deadline further away than any that `count` sets means that the clock was set back; the frame is then not
        // early. The first comparison keeps the difference from overflowing at Time::min().
        const Nanoseconds grace = grace_of(*interval);
        const bool is_early = now < stream.due && stream.due - now >= grace && stream.due - now <= *interval + grace;
        return {!is_early, &stream, *interval};
    }
    // Counts a frame as sent. Call it before the next `ask`, which may invalidate `answer`.
    static void count(const Answer& answer, Time now) noexcept {
        if (answer.stream == nullptr) return;
        Time& due = answer.stream->due;
        const bool in_step = due != Time::min() &&
                             (now < due ? due - now < grace_of(answer.interval)
                                        : now - due < std::max(answer.interval, 2 * shortest_grace));
        due = (in_step ? due : now) + answer.interval;
    }
    // Asks, and counts the frame if it is admitted.
    [[nodiscard]] bool admit(const wire::FrameView& frame, Time now) noexcept {
        const Answer answer = ask(frame, now);
        if (answer.admitted) count(answer, now);
        return answer.admitted;
    }

private:
    // Streams are stored in sets. A full set evicts the stream with the oldest deadline; the next frame of that stream
    // may then pass early.
    static constexpr std::size_t ways = 8, set_bits = 10, sets = std::size_t{1} << set_bits;
    static constexpr std::uint64_t no_stream = ~std::uint64_t{0};

    // How early a frame may be: less than half an interval. Radios and networks deliver several frames together, so it
    // is at least 50 ms. Jitter does not grow with the interval, so it is at most half a second. Frames that are early
    // do not move the deadlines, so the average rate still holds.
    static constexpr Nanoseconds shortest_grace = std::chrono::milliseconds{50},
                                 longest_grace = std::chrono::milliseconds{500};
    [[nodiscard]] static constexpr Nanoseconds grace_of(Nanoseconds interval) noexcept {
        return std::clamp<Nanoseconds>(interval / 2, shortest_grace, longest_grace);
    }

    [[nodiscard]] Stream& stream_of(std::uint64_t key) noexcept {
        Stream* const first = &streams_[(secret_hash(key) >> (64 - set_bits)) * ways];
        Stream* oldest = first;
        for (Stream* stream = first; stream != first + ways; ++stream) {
            if (stream->key == key) return *stream;
            if (stream->due < oldest->due) oldest = stream;
        }
        *oldest = {key, Time::min()};
        return *oldest;
    }

    Rates rates_;
    std::vector<Stream> streams_;
};

}  // namespace mavloom::dialect
