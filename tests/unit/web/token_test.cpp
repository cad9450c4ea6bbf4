// SPDX-License-Identifier: MIT
#include "mavloom/web/token.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace mavloom::web {
namespace {

using ::testing::HasSubstr;

class TokenFile : public ::testing::Test {
public:
    std::string file(const std::string& text, mode_t mode = 0600) const {
        const auto path = std::filesystem::path(::testing::TempDir()) / "mavloom_token_test";
        std::ofstream(path) << text;
        ::chmod(path.c_str(), mode);
        return path.string();
    }
};

TEST_F(TokenFile, HoldsATokenOfAUrlsLetters) {
    EXPECT_EQ(read_token(file("0123-._~ABCDefgh\n")).value(), "0123-._~ABCDefgh");
    EXPECT_EQ(read_token("").value(), "");
}

TEST_F(TokenFile, ThatIsShortOrNeedsEscapesOrIsPublicIsRefused) {
    for (const std::string wrong :
         {"", "0123456789abcde", "0123456789abcdef&", "0123456789 abcdef", "0123456789abcde\xe9"})
        EXPECT_THAT(read_token(file(wrong)).error().text, HasSubstr("openssl rand -hex 16")) << wrong;
    EXPECT_THAT(read_token(file(std::string(1024, 'a'))).error().text, HasSubstr("longer than 1023 bytes"));
    EXPECT_THAT(read_token(file("0123456789abcdef", 0640)).error().text, HasSubstr("chmod 600"));
    EXPECT_THAT(read_token("/nowhere/token").error().text, HasSubstr("cannot open token file"));
    EXPECT_THAT(read_token(::testing::TempDir()).error().text, HasSubstr("not a regular file"));
}

}  // namespace
}  // namespace mavloom::web
