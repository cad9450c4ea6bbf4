// SPDX-License-Identifier: MIT
// CPU time of the calling thread, in seconds. Work that other threads do on the same core does not count.
#pragma once

#include <ctime>

namespace mavloom::bench {

[[nodiscard]] inline double cpu_seconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace mavloom::bench
