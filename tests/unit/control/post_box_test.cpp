// SPDX-License-Identifier: MIT
#include "mavloom/control/post_box.hpp"

#include <gmock/gmock.h>

#include <memory>
#include <thread>
#include <vector>

namespace mavloom::control {
namespace {

using testing::ElementsAre;

TEST(PostBox, RunsOneItemAtATimeInOrder) {
    PostBox sut;
    std::vector<int> ran;
    EXPECT_TRUE(sut.empty());
    sut.post([&] { ran.push_back(1); });
    sut.post([&] { ran.push_back(2); });

    sut.run_one();
    EXPECT_THAT(ran, ElementsAre(1));
    EXPECT_FALSE(sut.empty());
    sut.run_one();
    EXPECT_THAT(ran, ElementsAre(1, 2));
    EXPECT_TRUE(sut.empty());
    sut.run_one();
    EXPECT_EQ(ran.size(), 2u);
}

TEST(PostBox, WorkMayPostMoreWork) {
    PostBox sut;
    bool ran = false;
    sut.post([&] { sut.post([&] { ran = true; }); });

    sut.run_one();
    EXPECT_FALSE(sut.empty());
    sut.run_one();
    EXPECT_TRUE(ran);
}

TEST(PostBox, DroppedWorkIsDestroyedAndNeverRuns) {
    PostBox sut;
    auto held = std::make_shared<int>(0);
    sut.post([held] { ++*held; });

    sut.drop();

    EXPECT_EQ(held.use_count(), 1);
    sut.run_one();
    EXPECT_EQ(*held, 0);
}

TEST(PostBox, LosesNothingThatSeveralThreadsPost) {
    constexpr int threads = 4, each = 1000;
    PostBox sut;
    int ran = 0;  // by this thread only
    std::vector<std::jthread> posters;
    for (int t = 0; t < threads; ++t)
        posters.emplace_back([&] {
            for (int i = 0; i < each; ++i) sut.post([&] { ++ran; });
        });
    while (ran < threads * each)
        if (!sut.empty()) sut.run_one();

    EXPECT_TRUE(sut.empty());
}

}  // namespace
}  // namespace mavloom::control
