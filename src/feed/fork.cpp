// SPDX-License-Identifier: MIT
#include "mavloom/feed/fork.hpp"

#include <pthread.h>

#include <atomic>

namespace mavloom::feed {
namespace {

std::atomic<std::uint64_t> fork_count{0};

// Registered before main(), so that no fork is missed.
[[maybe_unused]] const int counts_forks = ::pthread_atfork(nullptr, nullptr,
                                                           [] { fork_count.fetch_add(1, std::memory_order_relaxed); });

}  // namespace

std::uint64_t forks() noexcept { return fork_count.load(std::memory_order_relaxed); }

}  // namespace mavloom::feed
