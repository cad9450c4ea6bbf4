// SPDX-License-Identifier: MIT
// The output of `mavloom route --explain`.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "command.hpp"
#include "mavloom/link/links.hpp"
#include "mavloom/route/engine.hpp"
#include "output.hpp"

namespace mavloom::app {

// Prints "ATTITUDE 1/1 seq 7 from udpin://…#127.0.0.1:1234: forwarded" for a frame, then a line for each link. Routing
// never waits for the output: if the reader stalls, explanations that do not fit are left out and counted.
class ExplainPrinter {
public:
    // `only`: the message to explain; empty: all.
    ExplainPrinter(const Common& common, const dialect::Dialect& dialect, link::Links& links,
                   std::optional<MessageId> only)
        : common_(common), dialect_(dialect), links_(links), only_(only) {}

    void operator()(const link::RxFrame& rx, const route::Decision& decision, std::span<const route::Explanation> why);
    Output::State flush() { return output_.flush_what_fits(); }
    // When to call `flush` again if no frame arrives.
    [[nodiscard]] MonoTime due();
    // Writes the rest, as long as the reader keeps accepting data.
    void finish();
    void report_left_out() const;
    [[nodiscard]] const Output& output() const noexcept { return output_; }

private:
    void leave_out(std::size_t lines);

    const Common& common_;
    const dialect::Dialect& dialect_;
    link::Links& links_;
    std::optional<MessageId> only_;
    Output output_;
    std::uint64_t left_out_ = 0;  // lines
};

// The message that --explain names: its id, or empty for "*".
[[nodiscard]] SetupResult<std::optional<MessageId>> explained_id(const dialect::Dialect& dialect,
                                                                 const std::string& text);

}  // namespace mavloom::app
