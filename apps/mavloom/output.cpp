// SPDX-License-Identifier: MIT
#include "output.hpp"

#include <poll.h>
#include <unistd.h>

#include <cerrno>

#include "signals.hpp"

namespace mavloom::app {

// After Ctrl-C a slow reader gets a second to take more.
static bool takes_more() {
    pollfd out{STDOUT_FILENO, POLLOUT, 0};
    return ::poll(&out, 1, 1000) == 1;
}

Output::State Output::flush() {
    const char* p = buffer_.data();
    std::size_t left = buffer_.size();
    while (left != 0 && state_ == State::open) {
        const auto written = ::write(STDOUT_FILENO, p, left);
        if (written >= 0) {
            p += written;
            left -= static_cast<std::size_t>(written);
        } else if (errno == EPIPE) {
            state_ = State::closed_by_reader;
        } else if (errno == EINTR) {
            if (Signals::received() && !takes_more()) state_ = State::interrupted;
        } else if (errno != EAGAIN) {
            error_ = system_error("cannot write to standard output", errno).value();
            state_ = State::failed;
        }
    }
    buffer_.clear();
    return state_;
}

}  // namespace mavloom::app
