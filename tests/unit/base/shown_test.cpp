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

// U+009B begins a terminal's commands as ESC [ does; U+00E9 does not.
TEST(Shown, ReplacesControlCharactersBeyondAscii) {
    EXPECT_EQ(printable("a\xC2\x9B"
                        "b \xC3\xA9\xC2"),
              "a?b \xC3\xA9\xC2");
}

TEST(Shown, CutsWhatIsLong) { EXPECT_EQ(shown(std::string(121, 'x')), std::string(120, 'x') + "..."); }

}  // namespace
}  // namespace mavloom
