// SPDX-License-Identifier: MIT
// The calling thread's processor time: other threads on the core do not count.
#pragma once

#include <ctime>

namespace mavloom::bench {

[[nodiscard]] inline double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace mavloom::bench
