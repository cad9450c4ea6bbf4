// SPDX-License-Identifier: MIT
#include "mavloom/shm/detail/words.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <ctime>
#include <limits>

namespace mavloom::shm {

// Uses shared futexes: the kernel identifies the word by its file and offset, whatever the mapped address. Works on
// read-only mappings too.
bool SharedWords::sleep(const Word32& word, std::uint32_t expected, Nanoseconds longest) noexcept {
    if (longest <= Nanoseconds{}) return true;
    const auto whole = std::chrono::floor<std::chrono::seconds>(longest);
    const timespec limit{static_cast<time_t>(whole.count()), static_cast<long>((longest - whole).count())};
    return ::syscall(SYS_futex, &word, FUTEX_WAIT, expected, &limit, nullptr, 0) != 0 && errno == ETIMEDOUT;
}

void SharedWords::wake(Word32& word) noexcept {
    ::syscall(SYS_futex, &word, FUTEX_WAKE, std::numeric_limits<int>::max(), nullptr, nullptr, 0);
}

}  // namespace mavloom::shm
