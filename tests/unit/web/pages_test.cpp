// SPDX-License-Identifier: MIT
#include "web/report/pages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/format.h>

namespace mavloom::web {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct PagesTest : ::testing::Test {
    std::vector<std::string> read(PageReader& reader, int most = 100) {
        std::vector<std::string> all;
        while (most-- > 0) {
            const auto text = reader.next(pages);
            if (text == nullptr) break;
            all.push_back(*text);
        }
        return all;
    }
    void begin_turn(std::vector<PageReader*> readers) {
        pages.begin_turn(3);
        for (auto* const reader : readers) reader->begin_turn();
    }

    int made = 0;
    // Page 1 has not changed.
    Pages pages{[this](std::size_t page, bool all) {
        ++made;
        return all ? fmt::format("all {}", page) : page == 1 ? "" : fmt::format("changed {}", page);
    }};
    PageReader one, two;
};

TEST_F(PagesTest, ANewReaderGetsAllAndThenChanges) {
    EXPECT_THAT(read(one), IsEmpty());
    begin_turn({&one});
    EXPECT_THAT(read(one), ElementsAre("all 0", "all 1", "all 2"));
    EXPECT_THAT(read(one), IsEmpty());
    begin_turn({&one});
    EXPECT_THAT(read(one), ElementsAre("changed 0", "changed 2"));
}

TEST_F(PagesTest, ReadersShareTexts) {
    begin_turn({&one, &two});
    EXPECT_EQ(read(one), read(two));
    EXPECT_EQ(made, 3);
}

TEST_F(PagesTest, AReaderThatMissedATurnGetsAllAgain) {
    begin_turn({&one});
    EXPECT_THAT(read(one, 1), ElementsAre("all 0"));
    begin_turn({&one});
    EXPECT_THAT(read(one), ElementsAre("all 1", "all 2")) << "it ends what it has begun";
    begin_turn({&one});
    EXPECT_THAT(read(one), ElementsAre("all 0", "all 1", "all 2"));
    begin_turn({&one});
    EXPECT_THAT(read(one), ElementsAre("changed 0", "changed 2"));
}

}  // namespace
}  // namespace mavloom::web
