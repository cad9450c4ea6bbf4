// SPDX-License-Identifier: MIT
#include "mavloom/base/text.hpp"

#include <gtest/gtest.h>

namespace mavloom {
namespace {

TEST(Text, IsTrimmedAtItsEndsOnly) {
    EXPECT_EQ(trimmed("  a b\t\r\n"), "a b");
    EXPECT_EQ(trimmed("\v\fa"), "a");
    EXPECT_EQ(trimmed("a"), "a");
    EXPECT_EQ(trimmed(" \t"), "");
    EXPECT_EQ(trimmed(""), "");
    EXPECT_EQ(trimmed("\xc2\xa0"
                      "a"),
              "\xc2\xa0"
              "a")
        << "a blank beyond ASCII";
}

TEST(Text, HasTheSameLettersInAnyCase) {
    EXPECT_TRUE(same_letters("Auto.Land_1", "aUTO.lAND_1"));
    EXPECT_TRUE(same_letters("", ""));
    EXPECT_FALSE(same_letters("a", "ab"));
    EXPECT_FALSE(same_letters("ab", "a"));
    EXPECT_FALSE(same_letters("@[", "`{")) << "the neighbours of the letters";
    EXPECT_FALSE(same_letters("\xc4", "\xe4")) << "letters beyond ASCII";
}

}  // namespace
}  // namespace mavloom
