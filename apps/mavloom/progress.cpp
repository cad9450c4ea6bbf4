// SPDX-License-Identifier: MIT
#include "progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

namespace mavloom::app {

namespace {

using namespace std::chrono_literals;

constexpr auto quick = 300ms, between = 100ms;  // what is done sooner needs no bar

std::string bar(std::uint64_t done, std::uint64_t total) {
    const auto megabytes = static_cast<double>(done) / 1e6;
    if (total == 0) return fmt::format("{:.0f} MB", megabytes);
    constexpr std::size_t width = 30;
    const double part = std::min(1.0, static_cast<double>(done) / static_cast<double>(total));
    const auto full = static_cast<std::size_t>(part * width);
    return fmt::format("[{:#<{}}{:.<{}}] {:3.0f} %  {:.0f} of {:.0f} MB", "", full, "", width - full, 100 * part,
                       megabytes, static_cast<double>(total) / 1e6);
}

}  // namespace

Progress::Progress(const Common& common)
    : is_shown_(!common.quiet && ::isatty(STDERR_FILENO) != 0), next_(mono_now() + quick) {}

bool Progress::is_due() {
    if (!is_shown_) return false;
    const auto now = mono_now();
    if (now < next_) return false;
    next_ = now + between;
    return true;
}

void Progress::draw(std::string_view text) {
    write_stderr(fmt::format("\r{:<{}}", text, width_));
    width_ = text.size();
}

void Progress::show(std::uint64_t done_bytes, std::uint64_t total_bytes) {
    if (is_due()) draw(bar(done_bytes, total_bytes));
}

void Progress::show(std::string_view text) {
    if (is_due()) draw(text);
}

// Without escape sequences, which not every terminal has.
void Progress::clear() {
    if (width_ != 0) write_stderr(fmt::format("\r{:{}}\r", "", width_));
    width_ = 0;
}

}  // namespace mavloom::app
