// SPDX-License-Identifier: MIT
// The one file of this program that counts allocations, for the tests beside it.
#include "unit/ring/allocations.hpp"

#include "support/count_allocations.hpp"

std::size_t mavloom::test::allocations_so_far() noexcept { return allocations; }
