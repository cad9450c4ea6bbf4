// SPDX-License-Identifier: MIT
#include "mavloom/base/version.hpp"

#include <gmock/gmock.h>

namespace mavloom {
namespace {

// The number itself stands in project() alone; its shape is what programs that read `mavloom --version` rely on.
TEST(Version, IsANumberWithAnOptionalCommit) {
    EXPECT_THAT(std::string(version()), testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+(\\+g[0-9a-f]+(-dirty)?)?"));
}

}  // namespace
}  // namespace mavloom
