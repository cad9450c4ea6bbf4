// SPDX-License-Identifier: MIT
#include "router/stream_requests.hpp"

#include <gtest/gtest.h>

namespace mavloom::router {
namespace {

using namespace std::chrono_literals;

constexpr Source copter{SystemId{1}, ComponentId{1}}, plane{SystemId{2}, ComponentId{1}};
constexpr LinkId radio{1}, cable{2};
constexpr MonoTime requests_start{1000s};

TEST(StreamRequests, AsksEachSourceOnEachLinkOnceAndAgainAfter30Seconds) {
    StreamRequests requests;

    EXPECT_TRUE(requests.heard(radio, copter, requests_start));
    EXPECT_FALSE(requests.heard(radio, copter, requests_start + 1s));
    EXPECT_TRUE(requests.heard(radio, plane, requests_start + 1s));
    EXPECT_TRUE(requests.heard(cable, copter, requests_start + 1s));
    EXPECT_FALSE(requests.heard(radio, copter, requests_start + 29'999ms));
    EXPECT_TRUE(requests.heard(radio, copter, requests_start + 30s));
    EXPECT_FALSE(requests.heard(radio, plane, requests_start + 30s));
    EXPECT_FALSE(requests.heard(radio, copter, requests_start + 59s));
}

TEST(StreamRequests, ALinkThatWentIsAskedAgain) {
    StreamRequests requests;
    (void)requests.heard(radio, copter, requests_start);
    (void)requests.heard(cable, copter, requests_start);
    requests.forget(radio);

    EXPECT_TRUE(requests.heard(radio, copter, requests_start + 1s));
    EXPECT_FALSE(requests.heard(cable, copter, requests_start + 1s));
}

// 2,000 a second for 60 s: more than it remembers.
TEST(StreamRequests, ACrowdKeepsNobodyOutAndIsAskedAtALimitedRate) {
    StreamRequests requests;
    EXPECT_TRUE(requests.heard(radio, copter, requests_start));
    int asked = 0, asked_copter = 0;
    for (int i = 0; i < 120'000; ++i) {
        const MonoTime now = requests_start + i * 500us;
        asked += requests.heard(LinkId{1000 + static_cast<std::uint32_t>(i)}, plane, now) ? 1 : 0;
        if (i % 2000 == 1999) asked_copter += requests.heard(radio, copter, now) ? 1 : 0;
    }

    EXPECT_EQ(asked_copter, 1) << "30 s after the first time; its heartbeats keep its place";
    EXPECT_NEAR(asked, 256 + 60 * 20, 2) << "docs/guide/route.md";
}

}  // namespace
}  // namespace mavloom::router
