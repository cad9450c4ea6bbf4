// SPDX-License-Identifier: MIT
#include "output.hpp"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>

#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr auto longest_after_signal = 1s;
constexpr int look_for_signals_ms = 100;

}  // namespace

// A pipe that polls writable takes PIPE_BUF bytes without blocking, so that a signal is never missed in a write that does not return.
bool Output::wait_for_room() {
    for (;;) {
        pollfd out{STDOUT_FILENO, POLLOUT, 0};
        if (::poll(&out, 1, look_for_signals_ms) == 1) return true;
        if (!Signals::received() && mono_now() < end_) continue;
        if (!give_up_) give_up_ = mono_now() + longest_after_signal;
        if (mono_now() >= *give_up_) return false;
    }
}

Output::State Output::flush() {
    const char* p = buffer_.data();
    std::size_t left = buffer_.size();
    while (left != 0 && state_ == State::open) {
        if (!wait_for_room()) {
            state_ = State::interrupted;
            break;
        }
        const auto written = ::write(STDOUT_FILENO, p, std::min<std::size_t>(left, PIPE_BUF));
        if (written >= 0) {
            p += written;
            left -= static_cast<std::size_t>(written);
        } else if (errno == EPIPE) {
            state_ = State::closed_by_reader;
        } else if (errno != EINTR && errno != EAGAIN) {
            error_ = system_error("cannot write to standard output", errno).value();
            state_ = State::failed;
        }
    }
    lost_lines_ += static_cast<std::uint64_t>(std::count(p, p + left, '\n'));
    buffer_.clear();
    return state_;
}

Exit print_at_end(std::string_view text, Exit otherwise) {
    Output output;
    output.buffer().append(text);
    return output.flush() == Output::State::failed ? fail(output.error()) : otherwise;
}

}  // namespace mavloom::app
