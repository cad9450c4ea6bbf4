// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <thread>

#include "mavloom/base/clock.hpp"

namespace mavloom::test {

inline constexpr std::chrono::seconds long_enough{60};  // only ends a hang

// Waits for a condition that other threads make true. Returns false after `long_enough`.
template <class Condition>
[[nodiscard]] bool eventually(Condition&& condition) {
    for (const auto limit = mono_now() + long_enough; !condition();) {
        if (mono_now() > limit) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds{1});
    }
    return true;
}

}  // namespace mavloom::test
