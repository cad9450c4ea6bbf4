// SPDX-License-Identifier: MIT
// What tests must know of the thread sanitizer.
#pragma once

#if defined(__SANITIZE_THREAD__)
#define MAVLOOM_THREAD_SANITIZER
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define MAVLOOM_THREAD_SANITIZER
#endif
#endif

namespace mavloom::test {

// The sanitizer cannot follow threads that a forked child of a threaded process starts.
#ifdef MAVLOOM_THREAD_SANITIZER
inline constexpr bool child_may_start_threads = false;
#else
inline constexpr bool child_may_start_threads = true;
#endif

}  // namespace mavloom::test
