// SPDX-License-Identifier: MIT
// Ctrl-C and SIGTERM ask a command to end cleanly: the handler runs `on_stop` (which must be async-signal-safe) and remembers the signal. A
// second one ends the program at once. One Signals object at a time.
#pragma once

#include "command.hpp"

namespace mavloom::app {

class Signals {
public:
    using OnStop = void (*)(void* context) noexcept;
    // SIGHUP ends a command as the others do, unless it is remembered for `take_hangup` (a router reads its file again).
    enum class OnHangup : std::uint8_t { stop, remember };
    Signals(OnStop on_stop, void* context, OnHangup on_hangup = OnHangup::stop);
    ~Signals();
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    // At the start of the program: until there is a Signals object nothing is there to be ended cleanly, and a signal ends the program at once with
    // the status that belongs to it. Signals that the caller ignores (nohup, background jobs of scripts) stay ignored until then.
    static void watch() noexcept;

    [[nodiscard]] static bool received() noexcept;
    // True once for each SIGHUP that was remembered (several at once are one).
    [[nodiscard]] static bool take_hangup() noexcept;
    // 130 or 143 after a signal, else `otherwise`.
    [[nodiscard]] static Exit status(Exit otherwise) noexcept;
};

}  // namespace mavloom::app
