// SPDX-License-Identifier: MIT
#include "mavloom/route/engine.hpp"

#include <gtest/gtest.h>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/route/essential.hpp"

namespace mavloom::route {
namespace {

TEST(Essential, KnowsWhatSomebodyWaitsFor) {
    EXPECT_TRUE(is_essential(MessageId{0}));
    EXPECT_TRUE(is_essential(MessageId{77}));
    EXPECT_FALSE(is_essential(MessageId{30}));
}

TEST(Engine, TakesEachLinkOnce) {
    Engine sut(dialect::default_dialect().wire_table(), {});

    EXPECT_TRUE(sut.add_link(LinkId{1}, {}));
    EXPECT_FALSE(sut.add_link(LinkId{1}, {}));
    EXPECT_FALSE(sut.add_link(LinkId{0}, {}));
    EXPECT_EQ(sut.links(), 1u);
}

}  // namespace
}  // namespace mavloom::route
