// SPDX-License-Identifier: MIT
#include "runtime/stream_requests.hpp"

#include <gtest/gtest.h>

namespace mavloom::runtime {
namespace {

using namespace std::chrono_literals;

constexpr Source copter{SystemId{1}, ComponentId{1}}, plane{SystemId{2}, ComponentId{1}};
constexpr LinkId radio{1}, cable{2};
constexpr MonoTime start{1000s};

TEST(StreamRequests, AsksEachSourceOnEachLinkOnceAndAgainAfter30Seconds) {
    StreamRequests requests;

    EXPECT_TRUE(requests.heard(radio, copter, start));
    EXPECT_FALSE(requests.heard(radio, copter, start + 1s));
    EXPECT_TRUE(requests.heard(radio, plane, start + 1s));
    EXPECT_TRUE(requests.heard(cable, copter, start + 1s));
    EXPECT_FALSE(requests.heard(radio, copter, start + 29'999ms));
    EXPECT_TRUE(requests.heard(radio, copter, start + 30s));
    EXPECT_FALSE(requests.heard(radio, plane, start + 30s));
    EXPECT_FALSE(requests.heard(radio, copter, start + 59s));
}

TEST(StreamRequests, ALinkThatWentIsAskedAnew) {
    StreamRequests requests;
    (void)requests.heard(radio, copter, start);
    (void)requests.heard(cable, copter, start);
    requests.forget(radio);

    EXPECT_TRUE(requests.heard(radio, copter, start + 1s));
    EXPECT_FALSE(requests.heard(cable, copter, start + 1s));
}

TEST(StreamRequests, SendersWithoutEndAreNotAsked) {
    StreamRequests requests;
    for (std::uint32_t link = 0; link < StreamRequests::most_sources; ++link)
        EXPECT_TRUE(requests.heard(LinkId{link}, copter, start));

    EXPECT_FALSE(requests.heard(LinkId{5000}, copter, start));
}

}  // namespace
}  // namespace mavloom::runtime
