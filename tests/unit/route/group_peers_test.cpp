// SPDX-License-Identifier: MIT
// Peers of one endpoint in a group. Anybody may become a peer, so they do not believe each other as links of different
// endpoints do. Links 1 and 2 are peers of one udpin, of which 1 is the vehicle and 2 an attacker; link 3 is a station.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/route/route_frames.hpp"

namespace mavloom::route {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::gcs;
using test::make_frame;
using test::Network;
using test::vehicle;
using testing::Contains;
using testing::ElementsAre;

LinkPolicy peer(GroupMode mode, std::uint32_t endpoint = 7) {
    return {.group = GroupId{1}, .group_mode = mode, .endpoint = endpoint, .rank = Rank::stranger};
}

class GroupPeers : public testing::TestWithParam<GroupMode> {
protected:
    void both_send(Nanoseconds time) {
        for (Nanoseconds passed{}; passed < time; passed += 100ms) {
            sut.wait(100ms);
            sut.hears(1, vehicle);
            for (int i = 0; i < 10; ++i) sut.hears(2, vehicle);
        }
    }
    [[nodiscard]] test::Ids command() { return sut.command(3, gcs, vehicle); }

    Network sut;
};
INSTANTIATE_TEST_SUITE_P(Modes, GroupPeers, testing::Values(GroupMode::all, GroupMode::best, GroupMode::primary));

TEST_P(GroupPeers, APeerIsNotBelievedAtOnce) {
    sut.links(2, peer(GetParam()));
    sut.link();
    sut.hears(1, vehicle);

    both_send(5s);

    EXPECT_THAT(command(), ElementsAre(1));
}

TEST_P(GroupPeers, APeerThatIsBelievedDoesNotTakeTheVehiclesPlace) {
    sut.links(2, peer(GetParam()));
    sut.link();
    sut.hears(1, vehicle);
    both_send(60s);

    EXPECT_THAT(command(), Contains(1));
}

TEST_P(GroupPeers, APeerThatCameFirstDoesNotKeepTheVehicleOut) {
    sut.links(2, peer(GetParam()));
    sut.link();
    for (int i = 0; i < 50; ++i) {
        sut.hears(2, vehicle);
        sut.wait(100ms);
    }
    both_send(6s);

    EXPECT_THAT(command(), Contains(1));
}

TEST_P(GroupPeers, LinksOfTwoEndpointsAreBelievedAtOnce) {
    sut.link(peer(GetParam(), 7));
    sut.link(peer(GetParam(), 8));
    sut.link();
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);

    EXPECT_THAT(sut.engine.routes(sut.now), testing::SizeIs(2));
}

TEST_P(GroupPeers, VerifiedPeersOfOneEndpointAreBelievedAtOnce) {
    auto policy = peer(GetParam());
    policy.rank = Rank::verified;
    sut.links(2, policy);
    sut.link();
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);

    EXPECT_THAT(sut.engine.routes(sut.now), testing::SizeIs(2));
}

// Link 1 is unverified and the better one by all other rules, link 2 verified.
class VerifiedMember : public GroupPeers {
protected:
    VerifiedMember() {
        sut.link(peer(GetParam(), 7));
        auto verified = peer(GetParam(), 8);
        verified.rank = Rank::verified;
        sut.link(verified);
        sut.link();
    }
};
INSTANTIATE_TEST_SUITE_P(Modes, VerifiedMember, testing::Values(GroupMode::best, GroupMode::primary));

TEST_P(VerifiedMember, IsPreferred) {
    sut.hears(1, gcs);
    sut.command(3, vehicle, gcs);
    sut.hears(2, gcs);
    for (int i = 0; i < 100; ++i) {
        sut.wait(100ms);
        for (int n = 0; n < 5; ++n) sut.hears(1, gcs);
        sut.hears(2, gcs);
    }

    EXPECT_THAT(sut.send(3, "ATTITUDE", vehicle), ElementsAre(2));
}

TEST_P(VerifiedMember, GivesItsPlaceWhileItIsSilent) {
    sut.hears(2, gcs);
    sut.wait(3s);
    sut.hears(1, {1, 191});

    EXPECT_THAT(sut.send(3, "ATTITUDE", vehicle), ElementsAre(1));
}

// Links 1 and 2 are two verified endpoints of a group, link 3 is a station. The frames of the vehicle come on link 2
// first, and on link 1 somebody sends the same bytes again.
class VerifiedCopies : public testing::TestWithParam<GroupMode> {
protected:
    VerifiedCopies() {
        for (const std::uint32_t endpoint : {7u, 8u}) {
            auto policy = peer(GetParam(), endpoint);
            policy.rank = Rank::verified;
            sut.link(policy);
        }
        sut.link();
    }
    void both_bring_a_frame() {
        const Bytes bytes = make_frame("HEARTBEAT", vehicle, {{"custom_mode", ++sut.count}});
        sut.wait(100ms);
        sut.pass(2, bytes);
        sut.pass(1, bytes, true);
    }

    Network sut;
};
INSTANTIATE_TEST_SUITE_P(Modes, VerifiedCopies, testing::Values(GroupMode::all, GroupMode::best, GroupMode::primary));

TEST_P(VerifiedCopies, TeachNoRoute) {
    for (int i = 0; i < 100; ++i) both_bring_a_frame();

    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(2));
}

TEST_P(VerifiedCopies, DoNotMakeALinkTheOneForBroadcasts) {
    for (int i = 0; i < 100; ++i) both_bring_a_frame();

    const bool is_for_all = GetParam() == GroupMode::all;
    EXPECT_EQ(sut.send(3, "GPS_RTCM_DATA", gcs), is_for_all ? test::Ids({1, 2}) : test::Ids({2}));
}

TEST_P(VerifiedCopies, KeepARouteThatAFirstFrameTaught) {
    sut.hears(1, vehicle);
    for (int i = 0; i < 700; ++i) both_bring_a_frame();

    EXPECT_THAT(sut.engine.routes(sut.now), testing::SizeIs(2));
}

}  // namespace
}  // namespace mavloom::route
