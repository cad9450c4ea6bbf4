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

TEST(Suggest, CountsOneEditIfAWordExtendsTheOther) {
    constexpr std::array<std::string_view, 4> words{"max_rate", "baud", "relay", "replay"};
    EXPECT_EQ(nearest("baudrate", words), "baud") << "max_rate differs in three letters";
    EXPECT_EQ(nearest("play", words), "replay") << "relay differs in two letters";
    EXPECT_EQ(nearest("relays", words), "relay");
    EXPECT_EQ(nearest("baudratebaudrate", words), "");
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
