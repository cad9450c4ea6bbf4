// SPDX-License-Identifier: MIT
// The interface of a program that can be queried through a control socket and a metrics address. The router implements
// it; any other long-running program can, such as a simulator or a gateway.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace mavloom::control {

// An answer that is copied and formatted in pieces. This keeps each turn of the owner's loop short, and limits the
// memory that a slow client occupies.
struct Report {
    // For an answer that is not known yet; the two members below are then empty. The owner's thread calls it once, and
    // later calls `then` with the answer.
    std::function<void(std::function<void(Report)> then)> answer_later{};
    // The owner's thread calls this between two turns. It copies one piece of the data, in less than a millisecond, and
    // returns true while something is left. Empty if there is nothing to copy.
    std::function<bool()> copy_more{};
    // Formats and returns the next piece of the text; empty after the last. Called after everything is copied, on the
    // one other thread that formats all reports.
    std::function<std::string()> next_text;
};
// Returns a report whose data is already copied and whose text is one piece.
[[nodiscard]] Report report_of(std::function<std::string()> text);

class Served {
public:
    Served() = default;
    Served(const Served&) = delete;
    Served& operator=(const Served&) = delete;
    virtual ~Served() = default;

    // Any thread may call it. `work` runs on the owner's thread, between two of its turns. Work that is still pending
    // when the owner ends is destroyed without being run.
    virtual void post(std::function<void()> work) = 0;
    // Destroys posted work that has not run yet, and each `then` of Report::answer_later. An object that posts work
    // must call this before it is destroyed.
    virtual void drop_posted() = 0;

    // Both run on the owner's thread.
    //
    // Answers one request line with lines that end in '\n'. The last is {"ok":true} or {"ok":false,"error":"..."}.
    [[nodiscard]] virtual Report answer(std::string_view request) = 0;
    // Prometheus text exposition format, version 0.0.4.
    [[nodiscard]] virtual Report metrics() = 0;
};

}  // namespace mavloom::control
