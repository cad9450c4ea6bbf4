// SPDX-License-Identifier: MIT
// A process that this one starts and ends. Its output is collected, so that it never waits for a reader.
//
// The child ends when this process ends, however it ends: the kernel then sends it SIGTERM. It has a process group of
// its own, so Ctrl-C in the terminal reaches only this process. One owner, the thread that started it.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mavloom/base/clock.hpp"
#include "mavloom/base/result.hpp"
#include "mavloom/net/fd.hpp"

namespace mavloom::app::demo_parts {

class Child {
public:
    // `words`: the program's path and its arguments. `environment`: all its variables, as NAME=VALUE.
    [[nodiscard]] static SetupResult<Child> start(const std::vector<std::string>& words,
                                                  const std::vector<std::string>& environment);
    Child(Child&& other) noexcept;
    Child& operator=(Child&&) = delete;
    ~Child();  // kills it if it still runs

    // Reads what the child printed, and notes its end. Never waits.
    void look();
    [[nodiscard]] bool is_running() const noexcept { return pid_ > 0; }
    [[nodiscard]] pid_t pid() const noexcept { return pid_; }
    // For poll(): readable when the child prints or ends.
    [[nodiscard]] int output() const noexcept { return out_.get(); }
    [[nodiscard]] int errors() const noexcept { return err_.get(); }

    // The child's output on stdout and stderr: the last part, if it is long.
    [[nodiscard]] std::string_view printed() const noexcept { return printed_; }
    [[nodiscard]] std::string_view said() const noexcept { return said_; }
    // After its end: "status 1", or "signal 9".
    [[nodiscard]] std::string ending() const;
    // Whether a signal ended it, so that it could not clean up.
    [[nodiscard]] bool was_killed() const noexcept;

    // Asks the child to end.
    void terminate() noexcept;
    // Waits for the child's end, and kills it at `end`.
    void join(MonoTime end);

private:
    Child(pid_t pid, net::Fd out, net::Fd err) noexcept : pid_(pid), out_(std::move(out)), err_(std::move(err)) {}

    pid_t pid_;  // 0 after its end
    net::Fd out_, err_;
    std::string printed_, said_;
    int status_ = 0;
};

// The last line of a text that is not empty.
[[nodiscard]] std::string_view last_line(std::string_view text);

}  // namespace mavloom::app::demo_parts
