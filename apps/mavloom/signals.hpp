// SPDX-License-Identifier: MIT
// Ctrl-C and SIGTERM ask a command to end cleanly: the handler runs `on_stop` (which must be async-signal-safe) and remembers the signal. A
// second one ends the program at once. One Signals object at a time.
#pragma once

#include "command.hpp"

namespace mavloom::app {

class Signals {
public:
    using OnStop = void (*)(void* context) noexcept;
    Signals(OnStop on_stop, void* context);
    ~Signals();
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    [[nodiscard]] static bool received() noexcept;
    // 130 or 143 after a signal, else `otherwise`.
    [[nodiscard]] static Exit status(Exit otherwise) noexcept;
};

}  // namespace mavloom::app
