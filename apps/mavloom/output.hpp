// SPDX-License-Identifier: MIT
// Standard output. A reader that went away (`| head`) is an end, not an error; a full disk is an error; one that stalls is waited for, until the
// end is asked for: from then on it has to take something within a second of a signal, or within ten seconds of `end_at`. Pipes take whole lines.
// Single owner.
#pragma once

#include <sys/types.h>

#include <optional>

#include "command.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/message/format.hpp"

namespace mavloom::app {

class Output {
public:
    enum class State : std::uint8_t { open, closed_by_reader, failed, interrupted };

    // Where lines are appended; hand over with `flush_if_full` after each and `flush` when idle.
    [[nodiscard]] message::TextBuffer& buffer() noexcept { return buffer_; }
    State flush_if_full() { return full() ? flush() : state_; }
    // Writes all, however long the reader takes; when the end was asked for, only while it takes anything, then `interrupted`.
    State flush();
    // Never waits: writes the lines that fit, and leaves the others in the buffer. Who appends looks whether it is `full`.
    State flush_what_fits();
    [[nodiscard]] bool full() const noexcept { return buffer_.size() >= flush_bytes; }
    // False when a reader stalls and the end was asked for.
    [[nodiscard]] bool wait_for_room();

    // Asks for the end then (`--for`).
    void end_at(MonoTime end) noexcept { end_ = end; }

    // Lines given up when the wait was interrupted.
    [[nodiscard]] std::uint64_t lost_lines() const noexcept { return lost_lines_; }

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] const SetupError& error() const noexcept { return *error_; }  // of `failed`

private:
    static constexpr std::size_t flush_bytes = 64 * 1024;
    enum class Way : std::uint8_t { whole, not_blocking, after_poll };

    [[nodiscard]] static Way way_to_standard_output() noexcept;
    [[nodiscard]] ssize_t write_some(const char* bytes, std::size_t size) noexcept;
    void take_error(int error);

    message::TextBuffer buffer_;
    Way way_ = way_to_standard_output();
    State state_ = State::open;
    std::optional<SetupError> error_;
    MonoTime end_ = MonoTime::max();
    std::optional<MonoTime> stalled_since_;  // after the end was asked for
    std::uint64_t lost_lines_ = 0;
};

// Prints what a command ends with; `otherwise` unless that fails.
[[nodiscard]] Exit print_at_end(std::string_view text, Exit otherwise);

}  // namespace mavloom::app
