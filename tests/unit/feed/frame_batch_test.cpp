// SPDX-License-Identifier: MIT
#include "mavloom/feed/frame_batch.hpp"

#include <gtest/gtest.h>

#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;

TEST(FrameBatch, HandsOutInOrderAndTakesBackTheLast) {
    FrameBatch batch;
    for (std::uint32_t number = 1; number <= 300; ++number) batch.add({.link = number}, view(numbered(number)));
    for (std::uint32_t number = 1; number <= 300; ++number) {
        const auto* item = batch.next();
        ASSERT_NE(item, nullptr);
        ASSERT_EQ(number_of(batch.frame(*item)), number);
        ASSERT_EQ(item->link, number);
        ASSERT_EQ(batch.left(), 300 - number);
    }
    EXPECT_EQ(batch.next(), nullptr);

    batch.put_back();
    EXPECT_EQ(batch.left(), 1u);
    EXPECT_EQ(number_of(batch.frame(*batch.next())), 300u);

    batch.clear();
    EXPECT_EQ(batch.size(), 0u);
    EXPECT_EQ(batch.next(), nullptr);
}

}  // namespace
}  // namespace mavloom::feed
