// SPDX-License-Identifier: MIT
#include "mavloom/base/line_budget.hpp"

#include <gtest/gtest.h>

namespace mavloom {
namespace {

TEST(LineBudget, AllowsABurstThenAFewAndCountsTheRest) {
    LineBudget sut;
    std::size_t told = 0;
    for (std::size_t i = 0; i < LineBudget::burst + 30; ++i) told += sut.spend() ? 1 : 0;

    EXPECT_EQ(told, LineBudget::burst);
    EXPECT_EQ(sut.refill(), 30u);
    EXPECT_EQ(sut.refill(), 0u);
    told = 0;
    for (int i = 0; i < 10; ++i) told += sut.spend() ? 1 : 0;
    EXPECT_EQ(told, 2 * LineBudget::each_refill);
}

}  // namespace
}  // namespace mavloom
