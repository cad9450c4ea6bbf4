// SPDX-License-Identifier: MIT
// The interface of a program that can be queried through a control socket and a metrics address. The router implements
// it; any other long-running program can, such as a simulator or a gateway.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mavloom::control {

using Lines = std::vector<std::string>;

// Formats an answer later, on another thread. Formatting takes about a hundred times as long as copying the counters.
template <class Text>
using Later = std::function<Text()>;

class Served {
public:
    Served() = default;
    Served(const Served&) = delete;
    Served& operator=(const Served&) = delete;
    virtual ~Served() = default;

    // Any thread may call it. `work` runs on the owner's thread, between two of its turns. Work that is still pending
    // when the owner ends is destroyed without being run.
    virtual void post(std::function<void()> work) = 0;
    // Destroys posted work that has not run yet. An object that posts work must call this before it is destroyed.
    virtual void drop_posted() = 0;

    // `answer` and `metrics` run on the owner's thread and only copy data. Another thread may call the functions that
    // they return.
    //
    // Answers one request line. The last line is {"ok":true} or {"ok":false,"error":"..."}.
    [[nodiscard]] virtual Later<Lines> answer(std::string_view request) = 0;
    // Prometheus text exposition format, version 0.0.4.
    [[nodiscard]] virtual Later<std::string> metrics() = 0;
};

}  // namespace mavloom::control
