// SPDX-License-Identifier: MIT
// Who is believed: the rules of docs/design/routing-rules.md, "Trust". Link 1 has the vehicle, link 2 somebody else who
// sends as the vehicle, link 3 is a ground station. Their ranks differ from test to test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/route/route_frames.hpp"

namespace mavloom::route {
namespace {

using namespace std::chrono_literals;
using test::gcs;
using test::Id;
using test::Network;
using test::vehicle;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr Rank stranger = Rank::stranger, own = Rank::own, verified = Rank::verified;
constexpr Id companion{1, 240}, camera{1, 100};

class Trusting : public testing::Test {
protected:
    void connect(Rank first, Rank second, Rank third = own) {
        for (const Rank rank : {first, second, third}) sut.link({.rank = rank});
    }
    // These links hear the vehicle ten times a second.
    void hear(std::initializer_list<std::uint32_t> links, Nanoseconds time) {
        for (Nanoseconds passed{}; passed < time; passed += 100ms) {
            sut.wait(100ms);
            for (const std::uint32_t link : links) sut.hears(link, vehicle);
        }
    }
    [[nodiscard]] test::Ids command(Id target = vehicle) { return sut.command(3, gcs, target); }

    Network sut;
};

// ---- an autopilot on a second link ----------------------------------------------------------------------------------

struct Claim {
    std::string_view name;
    Rank first, second;
    test::Ids after_one_frame, after_five_seconds, after_two_of_silence, after_an_unplug;
};

// `after_...`: where the vehicle's commands go once link 2 has brought one frame; once both have sent for 5 s; once
// link 1 was silent for 2 s; once link 1 was unplugged, with 2 s passed.
class SecondLink : public Trusting, public testing::WithParamInterface<Claim> {
protected:
    SecondLink() {
        connect(GetParam().first, GetParam().second);
        hear({1}, 1s);
    }
};
INSTANTIATE_TEST_SUITE_P(Ranks, SecondLink,
                         testing::Values(Claim{"stranger_stranger", stranger, stranger, {1}, {1, 2}, {1, 2}, {2}},
                                         Claim{"stranger_own", stranger, own, {2}, {2}, {2}, {2}},
                                         Claim{"stranger_verified", stranger, verified, {2}, {2}, {2}, {2}},
                                         Claim{"own_stranger", own, stranger, {1}, {1}, {1, 2}, {2}},
                                         Claim{"own_own", own, own, {1, 2}, {1, 2}, {1, 2}, {2}},
                                         Claim{"own_verified", own, verified, {2}, {2}, {2}, {2}},
                                         Claim{"verified_stranger", verified, stranger, {1}, {1}, {1}, {}},
                                         Claim{"verified_own", verified, own, {1}, {1}, {1}, {}},
                                         Claim{"verified_verified", verified, verified, {1, 2}, {1, 2}, {1, 2}, {2}}),
                         [](const auto& claim) { return std::string(claim.param.name); });

TEST_P(SecondLink, IsLearnedByItsFirstFrameIfItsRankAllows) {
    sut.hears(2, vehicle);
    EXPECT_EQ(command(), GetParam().after_one_frame);
}

TEST_P(SecondLink, OfAStrangerIsLearnedBesideAnotherAfterFiveSeconds) {
    hear({1, 2}, 5s);
    EXPECT_EQ(command(), GetParam().after_one_frame);
    hear({1, 2}, 100ms);
    EXPECT_EQ(command(), GetParam().after_five_seconds);
}

TEST_P(SecondLink, IsLearnedAfterTwoSecondsOfSilence) {
    sut.wait(1999ms).hears(2, vehicle);
    EXPECT_EQ(command(), GetParam().after_one_frame);
    sut.wait(1ms).hears(2, vehicle);
    EXPECT_EQ(command(), GetParam().after_two_of_silence);
}

TEST_P(SecondLink, IsLearnedTwoSecondsAfterAnUnplug) {
    sut.engine.remove_link(LinkId{1});
    sut.wait(1999ms).hears(2, vehicle);
    const bool waits = GetParam().after_one_frame == test::Ids{1};
    EXPECT_EQ(command(), waits ? test::Ids{} : test::Ids{2});
    sut.wait(1ms).hears(2, vehicle);
    EXPECT_EQ(command(), GetParam().after_an_unplug);
}

TEST_P(SecondLink, IsLearnedAtOnceIfTheFirstWasClosedOnPurpose) {
    sut.engine.close_link(LinkId{1});
    sut.hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(2));
}

TEST_P(SecondLink, IsLearnedAtOnceIfTheFirstWasClosedWhileItWasDown) {
    sut.engine.remove_link(LinkId{1});
    sut.engine.close_link(LinkId{1});
    sut.hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(2));
}

TEST_F(Trusting, APeerThatIsGoneKeepsNothingIfItsEndpointIsClosed) {
    constexpr Id other{2, 1};
    for (const std::uint32_t endpoint : {7u, 8u}) sut.link({.endpoint = endpoint, .rank = verified});
    connect(own, own);
    sut.hears(1, vehicle);
    sut.hears(2, other);
    for (const LinkId link : {LinkId{1}, LinkId{2}}) sut.engine.remove_link(link);
    sut.engine.close_endpoint(7);
    sut.hears(3, vehicle);
    sut.hears(3, other);
    EXPECT_THAT(sut.command(4, gcs, vehicle), ElementsAre(3));
    EXPECT_THAT(sut.command(4, gcs, other), IsEmpty());
}

TEST_F(Trusting, AVerifiedSourceIsKeptUntilItsRouteWouldHaveTimedOut) {
    connect(verified, own);
    sut.hears(1, vehicle);
    sut.engine.remove_link(LinkId{1});
    sut.wait(59'999ms).hears(2, vehicle);
    EXPECT_THAT(command(), IsEmpty());
    sut.wait(1ms).hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(2));
}

TEST_F(Trusting, AGapOfTwoSecondsStartsTheFiveSecondsAgain) {
    connect(stranger, stranger);
    hear({1}, 1s);
    hear({1, 2}, 4s);
    hear({1}, 1900ms);
    hear({1, 2}, 4s);
    EXPECT_THAT(command(), ElementsAre(1));
    hear({1, 2}, 1100ms);
    EXPECT_THAT(command(), ElementsAre(1, 2));
}

TEST_F(Trusting, ConflictsAreCountedOnceAndListed) {
    connect(stranger, stranger);
    hear({1}, 1s);
    hear({1, 2}, 20s);
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 1u);
    ASSERT_EQ(sut.engine.route_conflicts().size(), 1u);
    EXPECT_EQ(sut.engine.route_conflicts()[0].system, SystemId{1});
    EXPECT_EQ(sut.engine.route_conflicts()[0].first, LinkId{1});
    EXPECT_EQ(sut.engine.route_conflicts()[0].second, LinkId{2});
    EXPECT_TRUE(sut.engine.route_conflicts()[0].is_believed);
}

TEST_F(Trusting, ALinkThatIsNotBelievedIsReportedOnce) {
    connect(own, stranger);
    hear({1}, 1s);
    hear({1, 2}, 4s);
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 0u);
    hear({1, 2}, 20s);
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 1u);
    ASSERT_EQ(sut.engine.route_conflicts().size(), 1u);
    EXPECT_EQ(sut.engine.route_conflicts()[0].second, LinkId{2});
    EXPECT_FALSE(sut.engine.route_conflicts()[0].is_believed);
    EXPECT_THAT(command(), ElementsAre(1));
}

// Its advice would be `trusted=true`, which helps nobody against a verified link.
TEST_F(Trusting, AConflictWithAVerifiedLinkIsNotReportedWhetherItIsThereOrGone) {
    connect(verified, own);
    hear({1, 2}, 10s);
    hear({1}, 3s);
    sut.engine.remove_link(LinkId{1});
    hear({2}, 20s);
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 0u);
}

TEST_F(Trusting, LearnFirstKeepsTheFirstUntilItIsSilent) {
    sut.link({.rank = stranger});
    sut.link({.rank = stranger, .learns_first = true});
    sut.link();
    hear({1}, 1s);
    hear({1, 2}, 60s);
    EXPECT_THAT(command(), ElementsAre(1));
    sut.wait(2s).hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(1, 2));
}

// A NAT gives the vehicle another port; the router sees another peer.
TEST_F(Trusting, AVehicleWhosePortChangesIsReachedAfterTwoSeconds) {
    connect(stranger, stranger);
    hear({1}, 10s);
    hear({2}, 1900ms);
    EXPECT_THAT(command(), ElementsAre(1));
    hear({2}, 100ms);
    EXPECT_THAT(command(), ElementsAre(1, 2));
}

TEST_F(Trusting, AHundredVehiclesOfOneStrangerGetTheirCommandsBack) {
    connect(stranger, stranger);
    const auto all_send = [&](std::uint32_t link) {
        for (std::uint8_t system = 1; system <= 100; ++system) sut.hears(link, {system, 1});
    };
    for (int i = 0; i < 60; ++i) {
        all_send(2);
        if (i > 0) all_send(1);
        sut.wait(100ms);
    }
    for (std::uint8_t system = 1; system <= 100; ++system)
        EXPECT_THAT(command({system, 1}), ElementsAre(1, 2)) << int{system};
}

TEST_F(Trusting, AForgedRestartForgetsNothingOnOtherLinks) {
    connect(own, stranger);
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);
    sut.engine.note_reboot(LinkId{2}, vehicle, sut.now);
    EXPECT_THAT(command(), ElementsAre(1));
}

// ---- everybody else -------------------------------------------------------------------------------------------------

TEST_F(Trusting, EverybodyButAnAutopilotIsBelievedEverywhereAtOnce) {
    for (const auto& [first, second] : {std::pair{own, stranger}, {stranger, own}, {stranger, stranger}})
        for (const Id source : {gcs, Id{255, 1}, companion, camera}) {
            Network network;
            network.link({.rank = first});
            network.link({.rank = second});
            network.link();
            network.hears(1, source);
            network.hears(2, source);
            EXPECT_THAT(network.command(3, {254, 190}, source), ElementsAre(1, 2)) << int{source.component};
        }
}

TEST_F(Trusting, ACompanionOnThisMachineIsReachedBesideAVehicleOnUdp) {
    connect(stranger, own);
    sut.hears(1, vehicle);
    sut.hears(2, companion);
    EXPECT_THAT(command(companion), ElementsAre(2));
    EXPECT_THAT(command(vehicle), ElementsAre(1));
}

// Somebody may have invented the camera to get its commands, so the vehicle gets them too.
TEST_F(Trusting, ACameraOfAStrangerIsReachedBesideAVehicleOnASerialLine) {
    connect(own, stranger);
    sut.hears(1, vehicle);
    sut.hears(2, camera);
    EXPECT_THAT(command(camera), ElementsAre(1, 2));
    EXPECT_THAT(command(vehicle), ElementsAre(1));
}

TEST_F(Trusting, WhateverAVerifiedLinkHasIsKeptToIt) {
    connect(verified, own);
    for (const Id source : {gcs, companion}) {
        sut.hears(2, source);
        sut.hears(1, source);
        sut.hears(2, source);
        EXPECT_THAT(command(source), ElementsAre(1)) << "the first verified frame ends what others taught";
    }
}

TEST_F(Trusting, ASystemThatOnlyStrangersKnowKeepsNoFrameFromTheOthers) {
    Network network({.unknown_target = UnknownTarget::flood});
    for (const Rank rank : {own, stranger, own}) network.link({.rank = rank});
    network.hears(2, {9, 1});
    EXPECT_THAT(network.command(3, gcs, {9, 1}), ElementsAre(1, 2));
}

// There is a station with the same id on the vehicle's side, which was heard first.
TEST_F(Trusting, AFloodedCommandReachesAStrangersVehicleToo) {
    Network network({.unknown_target = UnknownTarget::flood});
    for (const Rank rank : {stranger, own, own}) network.link({.rank = rank});
    network.hears(1, gcs);
    network.hears(1, vehicle);
    EXPECT_THAT(network.command(3, gcs, vehicle), ElementsAre(1, 2));
}

TEST_F(Trusting, WhatAStrangerRepeatedBeforeDoesNotStopAVerifiedFrame) {
    connect(verified, stranger, verified);
    const auto frame = test::make_frame("ATTITUDE", vehicle);
    ASSERT_THAT(sut.pass(2, frame), ElementsAre(1, 3));
    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2, 3));
}

// So redundant links need a group: the slower one brings only what was sent to it.
TEST_F(Trusting, AnEchoTeachesNothing) {
    connect(own, own);
    for (std::uint32_t i = 0; i < 10; ++i) {
        const auto beat = test::make_frame("HEARTBEAT", vehicle, {{"custom_mode", i}});
        sut.pass(1, beat);
        sut.pass(2, beat);
        EXPECT_EQ(sut.verdict, Verdict::echo);
        sut.wait(1s);
    }
    EXPECT_THAT(command(), ElementsAre(1));
}

// ---- a sender's own link --------------------------------------------------------------------------------------------

TEST_F(Trusting, ASourceOnTwoOwnLinksIsSentBackToNeither) {
    connect(own, own);
    for (int i = 0; i < 2; ++i) {
        sut.hears(1, gcs);
        sut.wait(250ms).hears(2, gcs);
        sut.wait(250ms);
    }
    EXPECT_THAT(sut.hears(2, gcs), ElementsAre(3)) << "link 1 was first";
    EXPECT_THAT(sut.hears(1, gcs), ElementsAre(3)) << "link 2 heard it for half a second";
    sut.wait(3s);
    EXPECT_THAT(sut.hears(2, gcs), ElementsAre(1, 3)) << "link 1 has not heard it for 3 s";
}

TEST_F(Trusting, AStrangersLinkIsASendersOwnOnlyIfItWasFirst) {
    connect(stranger, stranger);
    for (int i = 0; i < 20; ++i) {
        sut.hears(1, gcs);
        sut.wait(250ms);
        EXPECT_THAT(sut.hears(2, gcs), ElementsAre(3)) << "link 1 was first";
        sut.wait(250ms);
        EXPECT_THAT(sut.hears(1, gcs), ElementsAre(2, 3)) << "link 2 was later";
    }
}

TEST_F(Trusting, OneForgedFrameFromAStationsAddressCostsItNoTelemetry) {
    connect(own, stranger);
    sut.hears(1, vehicle);
    sut.wait(1ms);
    sut.hears(3, gcs);
    sut.hears(3, vehicle);
    EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), ElementsAre(2, 3));
}

TEST_F(Trusting, AStationForgedLaterKeepsNoTelemetryFromTheStation) {
    connect(own, stranger, stranger);
    for (int i = 0; i < 100; ++i) {
        sut.hears(1, vehicle);
        sut.hears(1, camera);
        sut.wait(1ms);
        sut.hears(3, gcs);
        sut.hears(3, vehicle);  // forged, from the station's address
        sut.hears(3, camera);
        sut.wait(500ms);
        EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), ElementsAre(2, 3)) << i;
        EXPECT_THAT(sut.send(1, "ATTITUDE", camera), ElementsAre(2, 3)) << i;
    }
}

// A second station with the same id stands beside the vehicle.
TEST_F(Trusting, ASenderElsewhereKeepsNoCommandFromItsTarget) {
    connect(own, own);
    for (int i = 0; i < 20; ++i) {
        sut.hears(1, vehicle);
        sut.hears(1, gcs);
        sut.wait(500ms);
        EXPECT_THAT(command(), ElementsAre(1)) << i;
    }
}

TEST_F(Trusting, TwoStationsWithOneIdBothGetTelemetryAndAnswers) {
    connect(own, stranger);
    sut.hears(1, gcs);
    sut.hears(2, gcs);
    EXPECT_THAT(sut.command(3, vehicle, gcs), ElementsAre(1, 2));
    EXPECT_THAT(sut.send(3, "ATTITUDE", vehicle), ElementsAre(1, 2));
}

// ---- groups ---------------------------------------------------------------------------------------------------------

TEST_F(Trusting, LinksOfAGroupDoNotCompeteWhateverTheirRanks) {
    for (const Rank rank : {verified, stranger}) sut.link({.group = GroupId{1}, .rank = rank});
    sut.link();
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);
    sut.hears(1, vehicle);
    EXPECT_THAT(command(), ElementsAre(1, 2));
}

// Only verified links come first; among the others, the order decides.
TEST_F(Trusting, AGroupTakesAStrangersLinkBeforeAnOwnOneIfItIsFirst) {
    for (const Rank rank : {stranger, own})
        sut.link({.group = GroupId{1}, .group_mode = GroupMode::primary, .rank = rank});
    sut.link();
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(1));
}

TEST_F(Trusting, AVehicleOfAGroupMayMoveWithinItAfterAnUnplug) {
    sut.links(2, {.group = GroupId{1}, .rank = stranger});
    sut.link();
    sut.hears(1, vehicle);
    sut.engine.remove_link(LinkId{1});
    sut.hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(2));
}

// Two paths lead to another router, which has the vehicle.
TEST(TwoRouters, InALoopPassEachFrameOnce) {
    Network here, there;
    here.links(3);   // 1, 2: the paths; 3: a station
    there.links(3);  // 1, 2: the paths; 3: the vehicle
    for (std::uint32_t i = 0; i < 20; ++i) {
        const auto frame = test::make_frame("ATTITUDE", vehicle, {{"time_boot_ms", i}});
        ASSERT_THAT(there.pass(3, frame), ElementsAre(1, 2));
        const auto went_to = here.pass(1, frame);
        EXPECT_THAT(went_to, testing::Contains(3));
        EXPECT_THAT(here.pass(2, frame), IsEmpty());
        if (std::ranges::find(went_to, 2u) == went_to.end()) continue;
        EXPECT_THAT(there.pass(2, frame), IsEmpty());
        EXPECT_EQ(there.verdict, Verdict::echo);
        here.wait(100ms);
        there.wait(100ms);
    }
    EXPECT_THAT(here.command(3, gcs, vehicle), testing::Contains(testing::AnyOf(1, 2)));
}

// The vehicle's answers to a station go through the other router and come back on the second path, which this router
// named: the vehicle is still on its own link.
TEST_F(Trusting, AVehiclesFramesThatComeBackThroughAnotherRouterTakeItFromNobody) {
    connect(stranger, own, stranger);  // the vehicle, the second path, the first path
    for (std::uint32_t i = 0; i < 100; ++i) {
        sut.hears(3, gcs);
        sut.hears(1, vehicle);
        const auto answer = test::make_frame("COMMAND_ACK", vehicle,
                                             {{"progress", i}, {"target_system", 255}, {"target_component", 190}});
        EXPECT_THAT(sut.pass(1, answer), ElementsAre(3));
        sut.wait(1ms).pass(2, answer);
        EXPECT_THAT(sut.command(3, gcs, vehicle), testing::Contains(1));
        sut.wait(100ms);
    }
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 0u);
    sut.hears(2, vehicle);
    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(2)) << "that was no copy: it moved";
}

TEST(TwoRouters, ASecondOfTwoPathsTakesAVehicleFromNobodyWithDedupEither) {
    Network sut({.dedup = 100ms});
    // The vehicle, two paths, a station.
    for (const Rank rank : {stranger, own, own, stranger}) sut.link({.rank = rank});
    sut.hears(4, gcs);
    const auto answer = test::make_frame("COMMAND_ACK", vehicle, {{"target_system", 255}, {"target_component", 190}});
    for (const std::uint32_t link : {1, 2, 3}) sut.wait(1ms).pass(link, answer);
    EXPECT_THAT(sut.command(4, gcs, vehicle), testing::Contains(1));
}

TEST_F(Trusting, AStrangerThatBringsTheFramesOfAnOwnLinkSoonerGetsNoCommands) {
    connect(stranger, own);
    hear({2}, 1s);
    for (std::uint32_t i = 0; i < 50; ++i) {
        const auto frame = test::make_frame("ATTITUDE", vehicle, {{"time_boot_ms", i}});
        sut.wait(99ms).pass(1, frame);
        sut.wait(1ms).pass(2, frame);
        ASSERT_THAT(command(), ElementsAre(2)) << "after " << i << " frames";
    }
}

}  // namespace
}  // namespace mavloom::route
