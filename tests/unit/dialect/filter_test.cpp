// SPDX-License-Identifier: MIT
#include "mavloom/dialect/filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mavloom/dialect/dialect.hpp"
#include "support/filter.hpp"

namespace mavloom::dialect {
namespace {

using testing::HasSubstr;

const Dialect& definitions() { return default_dialect(); }
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
    const auto sut = test::make_filter({.messages = {"ATTITUDE", "12920"}, .systems = {42}});

    EXPECT_TRUE(sut.admits(MessageId{30}, source(42, 7)));
    EXPECT_TRUE(sut.admits(MessageId{12920}, source(42, 7)));
    EXPECT_FALSE(sut.admits(MessageId{30}, source(41, 7)));
    EXPECT_FALSE(sut.admits(MessageId{31}, source(42, 7)));
    EXPECT_FALSE(sut.admits(MessageId{12921}, source(42, 7)));
    EXPECT_FALSE(sut.admits_all());
}

TEST(Filter, WantsNoneOfTheTermsOfTheBlockList) {
    const auto sut = test::make_filter({}, {.messages = {"ATTITUDE", "12920"}, .components = {100}});

    EXPECT_TRUE(sut.admits(MessageId{31}, source(1, 1)));
    EXPECT_TRUE(sut.admits(MessageId{12921}, source(1, 1)));
    EXPECT_FALSE(sut.admits(MessageId{30}, source(1, 1)));
    EXPECT_FALSE(sut.admits(MessageId{12920}, source(1, 1)));
    EXPECT_FALSE(sut.admits(MessageId{31}, source(1, 100)));
}

TEST(Filter, EveryListNarrowsInAnyOrder) {
    const FilterTerms first{.messages = {"ATTITUDE", "HEARTBEAT", "12920", "12919"}},
        second{.messages = {"30", "0", "12920"}}, blocked{.messages = {"30", "12919"}};
    Filter sut, reversed;
    for (const auto* terms : {&first, &second}) ASSERT_TRUE(sut.allow(definitions(), *terms).has_value());
    ASSERT_TRUE(sut.block(definitions(), blocked).has_value());
    ASSERT_TRUE(reversed.block(definitions(), blocked).has_value());
    for (const auto* terms : {&second, &first}) ASSERT_TRUE(reversed.allow(definitions(), *terms).has_value());

    EXPECT_EQ(sut, reversed);
    EXPECT_TRUE(sut.admits(MessageId{0}, source(1, 1)));
    EXPECT_TRUE(sut.admits(MessageId{12920}, source(1, 1)));
    EXPECT_FALSE(sut.admits(MessageId{30}, source(1, 1)));
    EXPECT_FALSE(sut.admits(MessageId{12919}, source(1, 1)));
    EXPECT_FALSE(sut.admits(MessageId{1}, source(1, 1)));
}

TEST(Filter, NoneAdmitsNothing) {
    const Filter sut = Filter::none();

    EXPECT_FALSE(sut.admits(MessageId{0}, source(0, 0)));
    EXPECT_FALSE(sut.admits(MessageId{0}));
    EXPECT_FALSE(sut.admits(MessageId{0xffffff}));
}

TEST(Filter, NamesTheNearestMessageAndStaysAsItWas) {
    Filter sut;
    const auto done = sut.block(definitions(), {.messages = {"HEARTBEAT", "ATITUDE"}, .systems = {1}});

    ASSERT_FALSE(done.has_value());
    EXPECT_EQ(done.error().code, SetupCode::usage);
    EXPECT_THAT(done.error().text, HasSubstr("did you mean 'ATTITUDE'?"));
    EXPECT_TRUE(sut.admits_all());
}

TEST(Filter, RefusesAnIdBeyond24Bits) {
    EXPECT_FALSE(Filter().allow(definitions(), {.messages = {"16777216"}}).has_value());
}

}  // namespace
}  // namespace mavloom::dialect
