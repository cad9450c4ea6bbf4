// SPDX-License-Identifier: MIT
#include "mavloom/route/filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "mavloom/dialect/dialect.hpp"

namespace mavloom::route {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const dialect::Dialect& definitions() { return dialect::default_dialect(); }
constexpr Source source(std::uint8_t system, std::uint8_t component) {
    return {SystemId{system}, ComponentId{component}};
}

TEST(Filter, AdmitsAllByDefault) {
    const Filter sut;

    EXPECT_TRUE(sut.admits_all());
    EXPECT_TRUE(sut.admits(MessageId{0xffffff}, source(255, 255)));
    EXPECT_TRUE(sut.admits(MessageId{0}, source(0, 0)));
}

TEST(Filter, WantsEveryKindOfTermThatTheAllowListNames) {
    const std::vector<std::string> messages{"ATTITUDE", "12920"};
    const std::vector<std::uint8_t> systems{42};
    const auto sut = Filter::compile(definitions(), {"in_allow", messages, systems, {}}, {});

    ASSERT_TRUE(sut.has_value());
    EXPECT_TRUE(sut->admits(MessageId{30}, source(42, 7)));
    EXPECT_TRUE(sut->admits(MessageId{12920}, source(42, 7)));
    EXPECT_FALSE(sut->admits(MessageId{30}, source(41, 7)));
    EXPECT_FALSE(sut->admits(MessageId{31}, source(42, 7)));
    EXPECT_FALSE(sut->admits(MessageId{12921}, source(42, 7)));
    EXPECT_FALSE(sut->admits_all());
}

TEST(Filter, WantsNoneOfTheTermsOfTheBlockList) {
    const std::vector<std::string> messages{"ATTITUDE", "12920"};
    const std::vector<std::uint8_t> components{100};
    const auto sut = Filter::compile(definitions(), {}, {"in_block", messages, {}, components});

    ASSERT_TRUE(sut.has_value());
    EXPECT_TRUE(sut->admits(MessageId{31}, source(1, 1)));
    EXPECT_TRUE(sut->admits(MessageId{12921}, source(1, 1)));
    EXPECT_FALSE(sut->admits(MessageId{30}, source(1, 1)));
    EXPECT_FALSE(sut->admits(MessageId{12920}, source(1, 1)));
    EXPECT_FALSE(sut->admits(MessageId{31}, source(1, 100)));
}

TEST(Filter, BlockWinsOverAllow) {
    const std::vector<std::string> allow{"ATTITUDE", "HEARTBEAT", "12920"}, block{"30", "12920"};
    const auto sut = Filter::compile(definitions(), {"a", allow, {}, {}}, {"b", block, {}, {}});

    ASSERT_TRUE(sut.has_value());
    EXPECT_TRUE(sut->admits(MessageId{0}, source(1, 1)));
    EXPECT_FALSE(sut->admits(MessageId{30}, source(1, 1)));
    EXPECT_FALSE(sut->admits(MessageId{12920}, source(1, 1)));
}

TEST(Filter, NamesTheNearestMessage) {
    const std::vector<std::string> messages{"ATITUDE"};
    const auto sut = Filter::compile(definitions(), {}, {"out_block", messages, {}, {}});

    ASSERT_FALSE(sut.has_value());
    EXPECT_EQ(sut.error().code, SetupCode::usage);
    EXPECT_THAT(sut.error().text, StartsWith("out_block: "));
    EXPECT_THAT(sut.error().text, HasSubstr("ATTITUDE"));
}

TEST(Filter, RefusesAnIdBeyond24Bits) {
    const std::vector<std::string> messages{"16777216"};

    EXPECT_FALSE(Filter::compile(definitions(), {"in_allow", messages, {}, {}}, {}).has_value());
}

}  // namespace
}  // namespace mavloom::route
