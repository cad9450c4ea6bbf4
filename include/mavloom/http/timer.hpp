// SPDX-License-Identifier: MIT
// Calls a function again and again on the thread of a `Thread`.
#pragma once

#include <chrono>
#include <functional>
#include <memory>

#include "mavloom/http/thread.hpp"

namespace mavloom::http {

class Timer {
public:
    // The first call comes after one period.
    Timer(const Thread& thread, std::chrono::milliseconds period, std::function<void()> work);
    Timer(Timer&&) noexcept = default;
    Timer& operator=(Timer&&) = delete;
    // Waits until no call runs. Not in one of its calls.
    ~Timer();

private:
    struct State;  // lives on the thread
    std::shared_ptr<Core> core_;
    std::shared_ptr<State> state_;
};

}  // namespace mavloom::http
