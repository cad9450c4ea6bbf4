// SPDX-License-Identifier: MIT
#include "mavloom/base/suggest.hpp"

#include <gtest/gtest.h>

#include <array>

namespace mavloom {
namespace {

constexpr std::array<std::string_view, 5> names{"ATTITUDE", "ATTITUDE_QUATERNION", "HEARTBEAT", "queue_age", "ttl"};

TEST(Suggest, FindsTheNearestSpelling) {
    EXPECT_EQ(nearest("ATITUDE", names), "ATTITUDE");
    EXPECT_EQ(nearest("heartbeat", names), "HEARTBEAT");
    EXPECT_EQ(nearest("queue-age", names), "queue_age");
    EXPECT_EQ(nearest("ATTITUDE_QUATERNOIN", names), "ATTITUDE_QUATERNION");
    EXPECT_EQ(nearest("ttl", names), "ttl");
}

TEST(Suggest, FindsAWordThatWasOnlyBegun) {
    EXPECT_EQ(nearest("que", names), "queue_age");
    EXPECT_EQ(nearest("HEART", names), "HEARTBEAT");
    EXPECT_EQ(nearest("qu", names), "");
}

TEST(Suggest, IsEmptyWhenNothingIsNear) {
    EXPECT_EQ(nearest("GPS_RAW_INT", names), "");
    EXPECT_EQ(nearest("", names), "");
    EXPECT_EQ(nearest("x", {}), "");
    EXPECT_EQ(nearest(std::string(100'000, 'A'), names), "");
}

TEST(Suggest, WritesTheQuestion) {
    EXPECT_EQ(did_you_mean("HEARTBEET", names), ", did you mean 'HEARTBEAT'?");
    EXPECT_EQ(did_you_mean("GPS_RAW_INT", names), "");
}

}  // namespace
}  // namespace mavloom
