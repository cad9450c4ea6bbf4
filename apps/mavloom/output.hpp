// SPDX-License-Identifier: MIT
// A buffer of lines for standard output. It handles readers that are slow or close the pipe. Single owner.
//
// - A reader that closes the pipe (`| head`) ends the output normally. A full disk is an error.
// - If the reader stalls, the output waits until the end is requested, by a signal or at the time of `end_at`.
// - After that, the reader must accept some data within one second of a signal, or within ten seconds of `end_at`.
// - A pipe receives whole lines, as long as a line fits into PIPE_BUF bytes.
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

    // Append lines here. Call `flush_if_full` after each line and `flush` when idle.
    [[nodiscard]] message::TextBuffer& buffer() noexcept { return buffer_; }
    State flush_if_full() { return full() ? flush() : state_; }
    // Writes everything, and waits for a slow reader. After the end was requested, waits only while the reader still
    // accepts data; otherwise discards the rest and returns `interrupted`.
    State flush();
    // Never waits: writes the lines that fit and leaves the rest in the buffer. Check `full` before appending more.
    State flush_what_fits();
    [[nodiscard]] bool full() const noexcept { return buffer_.size() >= flush_bytes; }
    // Waits until standard output accepts data. Returns false if the reader stalls after the end was requested.
    [[nodiscard]] bool wait_for_room();

    // Sets the time after which the end counts as requested (`--for`).
    void end_at(MonoTime end) noexcept { end_ = end; }

    // Lines that `flush` discarded because the reader stalled or closed, or because writing failed.
    [[nodiscard]] std::uint64_t lost_lines() const noexcept { return lost_lines_; }

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] const SetupError& error() const noexcept { return *error_; }  // only if state() is `failed`

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
    std::optional<MonoTime> stalled_since_;  // set only after the end was requested
    std::uint64_t lost_lines_ = 0;
};

// The columns of the terminal, else those that COLUMNS gives, else `otherwise`.
[[nodiscard]] int width_of_output(int otherwise);
// False if NO_COLOR is set (https://no-color.org).
[[nodiscard]] bool wants_color();

// Prints the last text of a command. Returns `otherwise`, or an error status if printing fails.
[[nodiscard]] Exit print_at_end(std::string_view text, Exit otherwise);

}  // namespace mavloom::app
