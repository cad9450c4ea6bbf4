// SPDX-License-Identifier: MIT
#include "mavloom/message/utf8.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace mavloom::message {
namespace {

std::string cleaned(std::string_view bytes) {
    std::string out;
    while (!bytes.empty()) {
        const auto c = decode_utf8(bytes);
        std::array<char, 4> room{};
        out.append(room.data(), write_utf8(room.data(), c.value));
        bytes.remove_prefix(c.length);
    }
    return out;
}

#define FFFD "\xef\xbf\xbd"

TEST(Utf8, KeepsWhatIsValid) {
    EXPECT_EQ(cleaned("plain"), "plain");
    EXPECT_EQ(cleaned("Höhe 10 µm €"), "Höhe 10 µm €");
    EXPECT_EQ(cleaned("\xf0\x9f\x9a\x81"), "\xf0\x9f\x9a\x81");                  // U+1F681
    EXPECT_EQ(cleaned("\xf4\x8f\xbf\xbf"), "\xf4\x8f\xbf\xbf");                  // U+10FFFF
    EXPECT_EQ(cleaned("\xed\x9f\xbf\xee\x80\x80"), "\xed\x9f\xbf\xee\x80\x80");  // around the surrogates
}

// Tables 3-8 to 3-11 of Unicode 15, section 3.9.
TEST(Utf8, ReplacesMaximalSubpartsAsUnicodeRecommends) {
    EXPECT_EQ(cleaned("\xC0\xAF\xE0\x80\xBF\xF0\x81\x82\x41"), FFFD FFFD FFFD FFFD FFFD FFFD FFFD FFFD "A");
    EXPECT_EQ(cleaned("\xED\xA0\x80\xED\xBF\xBF\xED\xAF\x41"), FFFD FFFD FFFD FFFD FFFD FFFD FFFD FFFD "A");
    EXPECT_EQ(cleaned("\xF4\x91\x92\x93\xFF\x41\x80\xBF\x42"), FFFD FFFD FFFD FFFD FFFD "A" FFFD FFFD "B");
    EXPECT_EQ(cleaned("\xE1\x80\xE2\xF0\x91\x92\xF1\xBF\x41"), FFFD FFFD FFFD FFFD "A");
}

TEST(Utf8, ReplacesWhatTheEndCutsOff) {
    EXPECT_EQ(cleaned("a\xc3"), "a" FFFD);
    EXPECT_EQ(cleaned("a\xe2\x82"), "a" FFFD);
    EXPECT_EQ(cleaned("a\xf0\x9f\x9a"), "a" FFFD);
}

TEST(Utf8, KnowsWhatTerminalsObey) {
    EXPECT_TRUE(is_control(0x00));
    EXPECT_TRUE(is_control(0x1b));
    EXPECT_TRUE(is_control(0x7f));
    EXPECT_TRUE(is_control(0x9b));
    EXPECT_TRUE(is_control(0x202e));
    EXPECT_FALSE(is_control(' '));
    EXPECT_FALSE(is_control('~'));
    EXPECT_FALSE(is_control(0xa0));
}

}  // namespace
}  // namespace mavloom::message
