// SPDX-License-Identifier: MIT
// A progress bar on stderr, for work that takes a while. It appears only on a terminal, without --quiet, and leaves no
// trace when it is destroyed. One owner thread.
#pragma once

#include <cstdint>
#include <string_view>

#include "command.hpp"
#include "mavloom/base/clock.hpp"

namespace mavloom::app {

class Progress {
public:
    explicit Progress(const Common& common);
    ~Progress() { clear(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // Cheap, and draws ten times a second at most. `total` is 0 if it is not known.
    void show(std::uint64_t done_bytes, std::uint64_t total_bytes);
    // The same for a text of its own.
    void show(std::string_view text);
    void clear();

private:
    [[nodiscard]] bool is_due();
    void draw(std::string_view text);

    const bool is_shown_;
    MonoTime next_;
    std::size_t width_ = 0;  // of what is on the screen
};

}  // namespace mavloom::app
