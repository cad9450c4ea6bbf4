// SPDX-License-Identifier: MIT
#include "link/core/read_budget.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace mavloom::link::detail {
namespace {

using std::chrono::microseconds, std::chrono::milliseconds;

TEST(ReadBudget, FallsToWhatFitsIntoAMillisecond) {
    ReadBudget budget{1, 64};
    EXPECT_EQ(budget.limit(), 64U);
    budget.note(64, milliseconds{4});
    EXPECT_EQ(budget.limit(), 16U);
    budget.note(16, milliseconds{700});
    EXPECT_EQ(budget.limit(), 1U);
}

TEST(ReadBudget, GrowsSlowly) {
    ReadBudget budget{4096, 131072};
    budget.note(131072, milliseconds{100});
    EXPECT_EQ(budget.limit(), 4096U);
    budget.note(4096, microseconds{1});
    EXPECT_EQ(budget.limit(), 8192U);
    for (int turn = 0; turn < 40; ++turn) budget.note(100, {});
    EXPECT_EQ(budget.limit(), 131072U);
}

TEST(ReadBudget, MeasuresSmallReadsWhileTheLimitIsReduced) {
    ReadBudget budget{1, 64};
    budget.note(64, milliseconds{100});
    budget.spend(1, 21, [] { std::this_thread::sleep_for(milliseconds{3}); });
    EXPECT_EQ(budget.limit(), 1U);
}

}  // namespace
}  // namespace mavloom::link::detail
