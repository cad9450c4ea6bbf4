// SPDX-License-Identifier: MIT
// The calling thread's processor time: whoever else runs on the core meanwhile does not count.
#pragma once

#include <ctime>

namespace mavloom::bench {

[[nodiscard]] inline double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace mavloom::bench
