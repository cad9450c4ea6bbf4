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

TEST(StreamRequests, ALinkThatWentIsAskedAnew) {
    StreamRequests requests;
    (void)requests.heard(radio, copter, requests_start);
    (void)requests.heard(cable, copter, requests_start);
    requests.forget(radio);

    EXPECT_TRUE(requests.heard(radio, copter, requests_start + 1s));
    EXPECT_FALSE(requests.heard(cable, copter, requests_start + 1s));
}

TEST(StreamRequests, ACrowdKeepsNobodyOut) {
    StreamRequests requests;
    const auto crowd = [&](std::uint32_t first, MonoTime now) {
        for (std::uint32_t link = first; link < first + StreamRequests::most_sources - 1; ++link)
            EXPECT_TRUE(requests.heard(LinkId{link}, plane, now));
    };
    EXPECT_TRUE(requests.heard(radio, copter, requests_start));
    crowd(1000, requests_start + 500ms);
    EXPECT_FALSE(requests.heard(radio, copter, requests_start + 1s));
    crowd(5000, requests_start + 1500ms);

    EXPECT_FALSE(requests.heard(radio, copter, requests_start + 2s));  // what was heard once made room
    EXPECT_TRUE(requests.heard(cable, copter, requests_start + 2s));
    EXPECT_TRUE(requests.heard(radio, copter, requests_start + 31s));
}

}  // namespace
}  // namespace mavloom::router
