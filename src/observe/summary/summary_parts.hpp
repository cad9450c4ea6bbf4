// SPDX-License-Identifier: MIT
// The parts of a Summarizer, and which message goes to which part. Private to module observe.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "mavloom/observe/summarizer.hpp"
#include "observe/summary/parameter_log.hpp"
#include "observe/summary/sender_log.hpp"
#include "observe/summary/text_log.hpp"

namespace mavloom::observe {

// The time that passes in a recording, without jumps of its clock.
class RunningClock {
public:
    // Returns the step if it is a jump.
    std::optional<Nanoseconds> set(WallTime time) noexcept {
        const auto step = first_ ? time - last_ : Nanoseconds{};
        if (!first_) first_ = time;
        last_ = time;
        if (step < -Summarizer::longest_step_back || step > Summarizer::longest_step) [[unlikely]]
            return step;
        passed_ += step;
        longest_ = std::max(longest_, passed_);
        return std::nullopt;
    }
    [[nodiscard]] When now() const noexcept { return {last_, passed_}; }
    [[nodiscard]] Nanoseconds longest() const noexcept { return longest_; }
    [[nodiscard]] std::optional<WallTime> first() const noexcept { return first_; }

private:
    std::optional<WallTime> first_;
    WallTime last_{};
    Nanoseconds passed_{}, longest_{};
};

struct SummaryParts {
    const dialect::Dialect& dialect;
    const bool with_tracks;
    const std::span<const wire::MessageInfo> messages = dialect.wire_table().messages();
    const std::vector<std::uint8_t> readers;  // by place in `messages`, for `read`; 0: nothing reads it
    wire::SequenceTracker losses{};
    RunningClock clock{};
    std::deque<SenderLog> senders{};
    std::vector<std::uint16_t> sender_at = std::vector<std::uint16_t>(65'536);  // by source, plus one; 0: none
    TextLog texts{};
    ParameterLog parameters{};
    std::vector<ClockJump> jumps{};
    std::uint64_t frames = 0, bytes = 0, unlisted_frames = 0, unlisted_entries = 0;

    // Null if there is no room for another one.
    [[nodiscard]] SenderLog* find_or_add(Source source);
    void count_entry(bool has_room) noexcept { unlisted_entries += has_room ? 0 : 1; }
};

// Which function reads each message, as a number. 0: none.
[[nodiscard]] std::vector<std::uint8_t> readers_of(std::span<const wire::MessageInfo> messages);
void read(std::uint8_t reader, SummaryParts& parts, SenderLog& sender, ByteView payload, const When& when);

}  // namespace mavloom::observe
