// SPDX-License-Identifier: MIT
#include "recording/progress.hpp"

#include <fmt/format.h>
#include <nanobind/nanobind.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <utility>

namespace mavloom::python {

namespace nb = nanobind;

namespace {

using namespace std::chrono_literals;

constexpr auto quick = 300ms, between = 100ms;  // what is done sooner needs no progress

// Nothing if sys.stderr is no file, as in a notebook or under pytest.
int descriptor_of_stderr() {
    try {
        const nb::object stream = nb::module_::import_("sys").attr("stderr");
        return stream.is_none() ? -1 : nb::cast<int>(stream.attr("fileno")());
    } catch (const std::exception&) {
        return -1;
    }
}

int width_of(int terminal) noexcept {
    constexpr int usual = 80;
    winsize size{};
    return ::ioctl(terminal, TIOCGWINSZ, &size) == 0 && size.ws_col != 0 ? size.ws_col : usual;
}

void write_to(int terminal, const std::string& text) noexcept {
    // A terminal that takes nothing shows no progress.
    static_cast<void>(::write(terminal, text.data(), text.size()) < 0);
}

}  // namespace

Progress Progress::on_stderr() {
    Progress progress;
    const int descriptor = descriptor_of_stderr();
    if (descriptor >= 0 && ::isatty(descriptor) != 0) progress.terminal_ = descriptor;
    progress.restart();
    return progress;
}

Progress::Progress(Progress&& other) noexcept
    : terminal_(std::exchange(other.terminal_, -1)),
      next_(other.next_),
      meter_(other.meter_),
      width_(std::exchange(other.width_, 0)) {}

Progress& Progress::operator=(Progress&& other) noexcept {
    clear();
    terminal_ = std::exchange(other.terminal_, -1);
    next_ = other.next_;
    meter_ = other.meter_;
    width_ = std::exchange(other.width_, 0);
    return *this;
}

bool Progress::is_due() noexcept {
    if (terminal_ < 0) return false;
    const auto now = mono_now();
    if (now < next_) return false;
    next_ = now + between;
    return true;
}

void Progress::show(const ProgressMade& made) {
    const auto line = meter_.line(made, mono_now(), width_of(terminal_));
    write_to(terminal_, fmt::format("\r{:<{}}", line, width_));
    width_ = line.size();
}

void Progress::clear() noexcept {
    if (width_ == 0) return;
    const auto width = std::exchange(width_, 0);
    try {
        write_to(terminal_, fmt::format("\r{:{}}\r", "", width));
    } catch (const std::exception&) {}  // no memory: the line stays
}

void Progress::restart() {
    clear();
    next_ = mono_now() + quick;
    meter_ = ProgressMeter(mono_now());
}

}  // namespace mavloom::python
