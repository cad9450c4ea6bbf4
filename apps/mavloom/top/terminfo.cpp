// SPDX-License-Identifier: MIT
// In a file of its own: <term.h> defines hundreds of macros with short names.
#include "top/screen.hpp"

#define NCURSES_NOMACROS 1  // NOLINT(readability-identifier-naming): ncurses' name
#include <ncurses.h>
#include <term.h>
#include <unistd.h>

namespace mavloom::app {

bool Screen::is_possible() {
    int error = 0;
    if (::setupterm(nullptr, STDOUT_FILENO, &error) != OK) return false;
    const char* const move = ::tigetstr("cup");
    // NOLINTNEXTLINE(performance-no-int-to-ptr): tigetstr's value for "no such capability"
    return move != nullptr && move != reinterpret_cast<const char*>(-1);
}

}  // namespace mavloom::app
