// SPDX-License-Identifier: MIT
// A progress line on stderr, for work that takes a while. It appears only on a terminal, without --quiet, while the
// program is in the foreground, and leaves no trace when it is destroyed. One owner thread.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "command.hpp"
#include "mavloom/base/clock.hpp"
#include "mavloom/base/progress_meter.hpp"

namespace mavloom::app {

class Progress {
public:
    explicit Progress(const Common& common);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // True ten times a second at most, and only if the line is shown. Cheap. `show` is for a caller that got true.
    [[nodiscard]] bool is_due();
    void show(const ProgressMade& made);
    void show(std::string_view text);
    void clear();
    // Counts time and rates from now.
    void restart();

private:
    const bool is_shown_;
    MonoTime next_;
    ProgressMeter meter_;
};

// How much of a time has passed, 0 to 1. Empty: the time has no end.
[[nodiscard]] std::optional<double> part_of_time(MonoTime begin, MonoTime end);

// Returns the characters that erase the progress line, if there is one, and notes that it is gone. A line of the log
// thus takes its place. Any thread.
[[nodiscard]] std::string erase_progress();

}  // namespace mavloom::app
