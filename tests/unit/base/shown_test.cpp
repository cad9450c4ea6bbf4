// SPDX-License-Identifier: MIT
#include "mavloom/base/shown.hpp"

#include <gtest/gtest.h>

namespace mavloom {
namespace {

TEST(Shown, KeepsWhatATerminalMayShow) { EXPECT_EQ(in_quotes("ATTITUDE:10"), "'ATTITUDE:10'"); }

TEST(Shown, ReplacesControlCharacters) {
    EXPECT_EQ(in_quotes("a\x1b[31m\n\x7f"),
              "'a?[31m?"
              "?'");
}

TEST(Shown, CutsWhatIsLong) { EXPECT_EQ(shown(std::string(121, 'x')), std::string(120, 'x') + "..."); }

}  // namespace
}  // namespace mavloom
