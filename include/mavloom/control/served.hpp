// SPDX-License-Identifier: MIT
// What a control socket and a metrics address serve: the router, and whatever else runs for long and can be asked (a simulator, a gateway).
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace mavloom::control {

using Lines = std::vector<std::string>;

// Makes the text of an answer, which takes a hundred times as long as the copy that it is made from.
template <class Text>
using Later = std::function<Text()>;

class Served {
public:
    Served() = default;
    Served(const Served&) = delete;
    Served& operator=(const Served&) = delete;
    virtual ~Served() = default;

    // Any thread: `work` is run on the owner's thread, between two of its turns. What is still waiting when the owner goes is destroyed unrun.
    virtual void post(std::function<void()> work) = 0;
    // Destroys what was posted and not yet run; for a poster that is about to go.
    virtual void drop_posted() = 0;

    // On the owner's thread, where they copy and do nothing more. What they return may be called on another.
    // One request line's answer, the last line of which is {"ok":true} or {"ok":false,"error":"..."}.
    [[nodiscard]] virtual Later<Lines> answer(std::string_view request) = 0;
    // Prometheus' text exposition format, version 0.0.4.
    [[nodiscard]] virtual Later<std::string> metrics() = 0;
};

}  // namespace mavloom::control
