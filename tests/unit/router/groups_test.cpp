// SPDX-License-Identifier: MIT
#include "router/groups.hpp"

#include <gmock/gmock.h>

namespace mavloom::router {
namespace {

using endpoint::GroupMode;
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

}  // namespace
}  // namespace mavloom::router
