// SPDX-License-Identifier: MIT
// Counts the calls of operator new of this thread, and their bytes. Replaces the global operators, so exactly one file
// of a test program includes it.
// With Clang's thread sanitizer, whose own operator new cannot be replaced, nothing is counted: that build checks
// threads, the others check allocations.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

#if defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define MAVLOOM_ALLOCATIONS_UNCOUNTED
#endif
#endif

namespace mavloom::test {
inline thread_local std::size_t allocations = 0, allocated_bytes = 0;
}

#ifndef MAVLOOM_ALLOCATIONS_UNCOUNTED
// Not inlined: GCC would take new and free for a mismatch. The nothrow form too: std::stable_sort takes its buffer by
// it and gives it back by the plain delete, and the address sanitizer's own nothrow form would not match ours.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++mavloom::test::allocations;
    mavloom::test::allocated_bytes += size;
    return std::malloc(size == 0 ? 1 : size);
}
[[gnu::noinline]] void* operator new(std::size_t size) {
    if (void* p = operator new(size, std::nothrow)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }
#endif
