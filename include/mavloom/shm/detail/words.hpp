// SPDX-License-Identifier: MIT
// Atomic words in shared memory, and futex sleep and wake on one of them. The ring's algorithms are templates over this
// type, so that tests can step them through chosen schedules.
#pragma once

#include <atomic>
#include <cstdint>

#include "mavloom/base/clock.hpp"

namespace mavloom::shm {

struct SharedWords {
    using Word32 = std::atomic<std::uint32_t>;
    using Word64 = std::atomic<std::uint64_t>;
    static_assert(Word32::is_always_lock_free && Word64::is_always_lock_free, "a lock would not be shared");
    static_assert(sizeof(Word32) == 4 && sizeof(Word64) == 8);

    // Sleeps while `word` equals `expected`, for at most `longest`; may return early. Returns true if the time is over.
    static bool sleep(const Word32& word, std::uint32_t expected, Nanoseconds longest) noexcept;
    // Wakes all threads that sleep on `word`.
    static void wake(Word32& word) noexcept;
    [[nodiscard]] static MonoTime now() noexcept { return mono_now(); }
};

}  // namespace mavloom::shm
