// SPDX-License-Identifier: MIT
#include "output.hpp"

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>

#include "signals.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr auto longest_stall = 10s, longest_stall_after_signal = 1s;
constexpr int signal_poll_ms = 100;

}  // namespace

bool Output::wait_for_room() {
    for (;;) {
        pollfd out{STDOUT_FILENO, POLLOUT, 0};
        if (::poll(&out, 1, signal_poll_ms) == 1) return true;
        const auto now = mono_now();
        if (!Signals::received() && now < end_) continue;
        if (!stalled_since_) stalled_since_ = now;
        if (now - *stalled_since_ >= (Signals::received() ? longest_stall_after_signal : longest_stall)) return false;
    }
}

// A regular file has no reader to wait for, so it is written as a whole.
Output::Way Output::way_to_standard_output() noexcept {
    struct stat status {};
    return ::fstat(STDOUT_FILENO, &status) == 0 && S_ISREG(status.st_mode) ? Way::whole : Way::not_blocking;
}

// Never blocks on a stalled reader, so that no signal is missed in a call that does not return. Where the kernel cannot
// guarantee that (pipes before Linux 6.4, terminals), callers poll first: a pipe that polls writable takes PIPE_BUF
// bytes.
ssize_t Output::write_some(const char* bytes, std::size_t size) noexcept {
    if (way_ == Way::whole) return ::write(STDOUT_FILENO, bytes, size);
    if (way_ == Way::after_poll) return ::write(STDOUT_FILENO, bytes, std::min<std::size_t>(size, PIPE_BUF));
    const iovec all{const_cast<char*>(bytes), size};  // NOLINT(cppcoreguidelines-pro-type-const-cast): only read
    const auto written = ::pwritev2(STDOUT_FILENO, &all, 1, -1, RWF_NOWAIT);
    if (written < 0 && errno != EAGAIN && errno != EPIPE) {
        way_ = Way::after_poll;  // after a real error, the next write fails again
        errno = EAGAIN;
    }
    return written;
}

// Sets the state from errno: the reader is gone, or the write failed. Lack of room changes nothing.
void Output::take_error(int error) {
    if (error == EPIPE) {
        state_ = State::closed_by_reader;
    } else if (error != EINTR && error != EAGAIN) {
        error_ = system_error("cannot write to standard output", error).value();
        state_ = State::failed;
    }
}

// Returns the length of the whole lines to write at once. A pipe takes up to PIPE_BUF bytes whole or not at all, so no
// line is cut in two.
static std::size_t whole_lines(std::string_view text) noexcept {
    const auto last = text.substr(0, PIPE_BUF).rfind('\n');
    return last == std::string_view::npos ? text.size() : last + 1;
}

Output::State Output::flush() {
    const char* p = buffer_.data();
    std::size_t left = buffer_.size();
    for (bool full = false; left != 0 && state_ == State::open;) {
        if ((full || way_ == Way::after_poll) && !wait_for_room()) {
            state_ = State::interrupted;
            break;
        }
        const auto written = write_some(p, way_ == Way::whole ? left : whole_lines({p, left}));
        full = written < 0;
        if (written >= 0) {
            stalled_since_.reset();
            p += written;
            left -= static_cast<std::size_t>(written);
        } else {
            take_error(errno);
        }
    }
    lost_lines_ += static_cast<std::uint64_t>(std::count(p, p + left, '\n'));
    buffer_.clear();
    return state_;
}

Output::State Output::flush_what_fits() {
    std::size_t done = 0;
    while (done != buffer_.size() && state_ == State::open) {
        const Way way = way_;
        pollfd out{STDOUT_FILENO, POLLOUT, 0};
        if (way == Way::after_poll && ::poll(&out, 1, 0) != 1) break;
        const std::string_view left(buffer_.data() + done, buffer_.size() - done);
        const auto written = write_some(left.data(), way == Way::whole ? left.size() : whole_lines(left));
        if (written >= 0) {
            stalled_since_.reset();
            done += static_cast<std::size_t>(written);
            continue;
        }
        take_error(errno);
        if (way == way_) break;
    }
    std::copy(buffer_.data() + done, buffer_.data() + buffer_.size(), buffer_.data());
    buffer_.resize(buffer_.size() - done);
    return state_;
}

int width_of_output(int otherwise) {
    constexpr int least = 40, most = 400;
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col != 0) return size.ws_col;
    const char* const columns = std::getenv("COLUMNS");
    const int width = columns == nullptr ? 0 : std::atoi(columns);
    return width == 0 ? otherwise : std::clamp(width, least, most);
}

bool wants_color() {
    const char* const value = std::getenv("NO_COLOR");
    return value == nullptr || *value == '\0';
}

Exit print_at_end(std::string_view text, Exit otherwise) {
    Output output;
    output.buffer().append(text);
    return output.flush() == Output::State::failed ? fail(output.error()) : otherwise;
}

}  // namespace mavloom::app
