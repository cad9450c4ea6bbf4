// SPDX-License-Identifier: MIT
// Standard output in large writes. A reader that went away (`| head`) is an end, not an error; a full disk is an error. Single owner.
#pragma once

#include <optional>

#include "mavloom/base/result.hpp"
#include "mavloom/message/format.hpp"

namespace mavloom::app {

class Output {
public:
    enum class State : std::uint8_t { open, closed_by_reader, failed, interrupted };

    // Where lines are appended; hand over with `flush_if_full` after each and `flush` when idle.
    [[nodiscard]] message::TextBuffer& buffer() noexcept { return buffer_; }
    State flush_if_full() { return buffer_.size() >= flush_bytes ? flush() : state_; }
    // Writes all, however long the reader takes; a signal ends the wait (`interrupted`).
    State flush();

    // What is written after a signal had ended a wait (the closing table) is tried anew.
    void reopen_after_signal() noexcept {
        if (state_ == State::interrupted) state_ = State::open;
    }

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] const SetupError& error() const noexcept { return *error_; }  // of `failed`

private:
    static constexpr std::size_t flush_bytes = 64 * 1024;

    message::TextBuffer buffer_;
    State state_ = State::open;
    std::optional<SetupError> error_;
};

}  // namespace mavloom::app
