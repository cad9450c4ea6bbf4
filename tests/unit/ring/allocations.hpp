// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace mavloom::test {

// Of this thread.
[[nodiscard]] std::size_t allocations_so_far() noexcept;

}  // namespace mavloom::test
