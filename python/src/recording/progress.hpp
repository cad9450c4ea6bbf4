// SPDX-License-Identifier: MIT
// Progress: a line on stderr that shows how much of a recording was read, for `Recording(..., progress=True)`. It
// appears only if Python's sys.stderr is a terminal, and is erased at the end. One thread at a time.
#pragma once

#include <string>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/progress_meter.hpp"

namespace mavloom::python {

class Progress {
public:
    Progress() = default;  // shows nothing
    // Call it with the GIL.
    [[nodiscard]] static Progress on_stderr();
    Progress(Progress&& other) noexcept;
    Progress& operator=(Progress&& other) noexcept;
    ~Progress() { clear(); }

    // True ten times a second at most, if the line is shown. Cheap. Needs no GIL, nor do the following.
    [[nodiscard]] bool is_due() noexcept;
    void show(const ProgressMade& made);
    void clear() noexcept;
    // Counts time and rate from now.
    void restart();

private:
    int terminal_ = -1;  // a descriptor that Python owns; -1: nothing is shown
    MonoTime next_{};
    ProgressMeter meter_{MonoTime{}};
    std::size_t width_ = 0;  // of the line on the screen
};

}  // namespace mavloom::python
