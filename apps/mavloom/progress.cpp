// SPDX-License-Identifier: MIT
#include "progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <atomic>

#include "mavloom/base/durations.hpp"

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr auto quick = 300ms, between = 100ms;  // what is done sooner needs no progress
std::atomic<std::size_t> progress_width{0};     // of the line on the screen

int width_of_errors() {
    constexpr int usual = 80;
    winsize size{};
    return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col != 0 ? size.ws_col : usual;
}

// A job in the background would write into what the user types.
bool is_in_background() {
    const auto group = ::tcgetpgrp(STDERR_FILENO);
    return group > 0 && group != ::getpgrp();
}

}  // namespace

Progress::Progress(const Common& common)
    : is_shown_(!common.quiet && ::isatty(STDERR_FILENO) != 0), next_(mono_now() + quick), meter_(mono_now()) {}

bool Progress::is_due() {
    if (!is_shown_) return false;
    const auto now = mono_now();
    if (now < next_) return false;
    next_ = now + between;
    return !is_in_background();
}

void Progress::show(std::string_view text) {
    const auto before = progress_width.exchange(text.size());
    write_stderr(fmt::format("\r{:<{}}", text, before));
}

void Progress::show(const ProgressMade& made) { show(meter_.line(made, mono_now(), width_of_errors())); }

void Progress::clear() { write_stderr(erase_progress()); }

void Progress::restart() {
    meter_ = ProgressMeter(mono_now());
    next_ = mono_now() + quick;
}

std::optional<double> part_of_time(MonoTime begin, MonoTime end) {
    if (end == MonoTime::max()) return std::nullopt;
    return seconds(mono_now() - begin) / seconds(end - begin);
}

// Without escape sequences, which not every terminal has.
std::string erase_progress() {
    const auto width = progress_width.exchange(0);
    return width == 0 ? std::string() : fmt::format("\r{:{}}\r", "", width);
}

}  // namespace mavloom::app
