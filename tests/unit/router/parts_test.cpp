// SPDX-License-Identifier: MIT
// The small parts of a router: groups, the budget of log lines, and posted work.
#include <gmock/gmock.h>

#include <thread>

#include "router/groups.hpp"
#include "router/notice.hpp"
#include "router/post_box.hpp"

namespace mavloom::router {
namespace {

using endpoint::GroupMode;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Groups, HaveOneModeEach) {
    const std::vector endpoints{*endpoint::parse_endpoint("udpin://127.0.0.1:1?group=air&group_mode=best"),
                                *endpoint::parse_endpoint("udpin://127.0.0.1:2?group=air"),
                                *endpoint::parse_endpoint("udpin://127.0.0.1:3?group=ground&group_mode=primary")};
    const auto modes = Groups::modes_of(endpoints);
    ASSERT_TRUE(modes);
    Groups sut;
    sut.set_modes(*modes);

    EXPECT_EQ(sut.mode_of(endpoints[1].options), GroupMode::best);
    EXPECT_EQ(sut.mode_of(endpoints[2].options), GroupMode::primary);
    EXPECT_EQ(sut.mode_of(endpoint::parse_endpoint("udpin://127.0.0.1:4?group=other")->options), GroupMode::all);
}

TEST(Groups, WithTwoModesAreRefusedByTheSecondName) {
    const std::vector endpoints{*endpoint::parse_endpoint("udpin://127.0.0.1:1?group=air&group_mode=best"),
                                *endpoint::parse_endpoint("udpin://127.0.0.1:2?group=air&group_mode=all&name=spare")};

    const auto modes = Groups::modes_of(endpoints);

    ASSERT_FALSE(modes);
    EXPECT_EQ(modes.error().code, SetupCode::usage);
    EXPECT_THAT(modes.error().text, HasSubstr("spare: group 'air' already has group_mode=best"));
}

TEST(Groups, AnEmptiedGroupMayTakeAnotherMode) {
    Groups sut;
    sut.note_mode(endpoint::parse_endpoint("udpin://127.0.0.1:1?group=air&group_mode=best")->options);
    const auto member = endpoint::parse_endpoint("udpin://127.0.0.1:2?group=air")->options;
    EXPECT_EQ(sut.mode_of(member), GroupMode::best);

    sut.forget_mode("air");

    EXPECT_EQ(sut.mode_of(member), GroupMode::all);
}

TEST(Groups, KeepTheirIdsAndNoNameIsNoGroup) {
    Groups sut;
    const auto air = sut.id_of("air");

    EXPECT_EQ(sut.id_of(""), route::GroupId{});
    EXPECT_NE(air, route::GroupId{});
    EXPECT_NE(sut.id_of("ground"), air);
    EXPECT_EQ(sut.id_of("air"), air);
}

TEST(LineBudget, AllowsABurstThenAFewAndCountsTheRest) {
    LineBudget sut;
    std::size_t told = 0;
    for (std::size_t i = 0; i < LineBudget::burst + 30; ++i) told += sut.spend() ? 1 : 0;

    EXPECT_EQ(told, LineBudget::burst);
    EXPECT_EQ(sut.refill(), 30u);
    EXPECT_EQ(sut.refill(), 0u);
    told = 0;
    for (int i = 0; i < 10; ++i) told += sut.spend() ? 1 : 0;
    EXPECT_EQ(told, 2 * LineBudget::each_refill);
}

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
}  // namespace mavloom::router
