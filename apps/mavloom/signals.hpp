// SPDX-License-Identifier: MIT
// Ends a command cleanly on SIGINT (Ctrl-C), SIGTERM or SIGHUP.
// The handler records the signal and runs `on_stop`, which must be async-signal-safe. A second signal, at least 0.2 s
// after the first, ends the program at once. Only one Signals object may exist at a time.
#pragma once

#include "command.hpp"

namespace mavloom::app {

class Signals {
public:
    using OnStop = void (*)(void* context) noexcept;
    // `stop`: SIGHUP ends the command like the other signals. `remember`: `take_hangup` reports it, so that a router
    // can reread its configuration file.
    enum class OnHangup : std::uint8_t { stop, remember };
    // `hurry`: a second signal only makes `repeated` true, and a third one ends the program at once.
    enum class OnRepeat : std::uint8_t { exit, hurry };
    Signals(OnStop on_stop, void* context, OnHangup on_hangup = OnHangup::stop, OnRepeat on_repeat = OnRepeat::exit);
    ~Signals();
    Signals(const Signals&) = delete;
    Signals& operator=(const Signals&) = delete;

    // Call at the start of the program. Until the first Signals object is constructed, there is nothing to end cleanly.
    // A signal then ends the program at once, with the exit status for that signal. Until that moment, signals that
    // were ignored at start (nohup, background jobs of scripts) stay ignored.
    static void watch() noexcept;

    // Installs a handler for SIGBUS. If another process shortens the file of a ring, that ring counts as removed, and
    // the program continues.
    static void survive_lost_rings() noexcept;

    [[nodiscard]] static bool received() noexcept;
    [[nodiscard]] static bool repeated() noexcept;
    // Returns true once for each remembered SIGHUP. Several at once count as one.
    [[nodiscard]] static bool take_hangup() noexcept;
    // Returns 129, 130 or 143 after a signal, else `otherwise`.
    [[nodiscard]] static Exit status(Exit otherwise) noexcept;
};

}  // namespace mavloom::app
