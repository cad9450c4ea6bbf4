// SPDX-License-Identifier: MIT
// Recognises objects that a forked process inherited from its parent. Threads do not survive a fork and locks may stay
// locked, so the child must neither use nor destroy an object that has threads or locks. Any thread.
#pragma once

#include <cstdint>

namespace mavloom::feed {

// The number of forks between the first process and this one.
[[nodiscard]] std::uint64_t forks() noexcept;

// Add a member of this type to each class whose objects a forked child must not touch.
class ForkGuard {
public:
    // Whether this process created the object.
    [[nodiscard]] bool is_own_process() const noexcept { return born_ == forks(); }

private:
    std::uint64_t born_ = forks();
};

}  // namespace mavloom::feed
