// SPDX-License-Identifier: MIT
#include "mavloom/feed/link_names.hpp"

#include <gtest/gtest.h>

#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;

TEST(LinkNames, ALinkThatIsGoneKeepsItsNameUntilManyOthersAreGone) {
    LinkNames names;
    EXPECT_EQ(names.find(LinkId{1}), "");
    names.add(LinkId{1}, "first");
    names.gone(LinkId{1});
    EXPECT_EQ(names.find(LinkId{1}), "first");
    for (std::uint32_t link = 2; link <= LinkNames::max_gone; ++link) {
        names.add(LinkId{link}, "later");
        names.gone(LinkId{link});
    }
    EXPECT_EQ(names.find(LinkId{1}), "first");
    names.add(LinkId{LinkNames::max_gone + 1}, "last");
    names.gone(LinkId{LinkNames::max_gone + 1});
    EXPECT_EQ(names.find(LinkId{1}), "");
    EXPECT_EQ(names.find(LinkId{LinkNames::max_gone + 1}), "last");
}

TEST(LinkNames, ALinkThatIsBackIsNotForgotten) {
    LinkNames names;
    names.add(LinkId{1}, "before");
    names.gone(LinkId{1});
    names.add(LinkId{1}, "again");
    for (std::uint32_t link = 2; link <= LinkNames::max_gone + 10; ++link) {
        names.add(LinkId{link}, "other");
        names.gone(LinkId{link});
    }
    EXPECT_EQ(names.find(LinkId{1}), "again");
}

TEST(LinkNames, ThreadsFindWholeNamesWhileLinksComeAndGo) {
    LinkNames names;
    std::atomic<bool> done{false};
    std::vector<std::thread> readers;
    for (int i = 0; i < 3; ++i)
        readers.emplace_back([&] {
            while (!done)
                for (std::uint32_t link = 1; link <= 50; ++link) {
                    const auto name = names.find(LinkId{link});
                    ASSERT_TRUE(name.empty() || name == std::string(40, 'a')) << name;
                }
        });
    for (std::uint32_t round = 0; round < 2000; ++round) {
        names.add(LinkId{1 + round % 50}, std::string(40, 'a'));
        names.gone(LinkId{1 + round % 50});
    }
    done = true;
    for (auto& reader : readers) reader.join();
}

}  // namespace
}  // namespace mavloom::feed
