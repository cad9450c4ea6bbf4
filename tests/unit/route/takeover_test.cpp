// SPDX-License-Identifier: MIT
// Which senders are believed when two links bring the same vehicle. The rules: docs/design/security.md, "Who is
// believed". Link 1 has the vehicle, link 2 somebody who claims to be it, link 3 a ground station.
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

class Takeover : public testing::Test {
protected:
    // Both are heard ten times a second.
    void both_send(Nanoseconds time) {
        for (Nanoseconds passed{}; passed < time; passed += 100ms) {
            sut.wait(100ms);
            sut.hears(1, vehicle);
            sut.hears(2, vehicle);
        }
    }
    void only(std::uint32_t link, Nanoseconds time) {
        for (Nanoseconds passed{}; passed < time; passed += 100ms) {
            sut.wait(100ms);
            sut.hears(link, vehicle);
        }
    }
    [[nodiscard]] test::Ids command() { return sut.command(3, gcs, vehicle); }

    Network sut;
};

TEST_F(Takeover, AVehicleThatIsAliveIsLearnedElsewhereAfterFiveSeconds) {
    sut.links(3);
    only(1, 1s);

    both_send(5s);
    EXPECT_THAT(command(), ElementsAre(1));
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 0u);

    both_send(100ms);
    EXPECT_THAT(command(), ElementsAre(1, 2));
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 1u);
    ASSERT_EQ(sut.engine.route_conflicts().size(), 1u);
    EXPECT_EQ(sut.engine.route_conflicts()[0].system, SystemId{1});
    EXPECT_EQ(sut.engine.route_conflicts()[0].first, LinkId{1});
    EXPECT_EQ(sut.engine.route_conflicts()[0].second, LinkId{2});
}

TEST_F(Takeover, AnotherComponentOfALiveVehicleWaitsToo) {
    sut.links(3);
    only(1, 1s);
    for (int i = 0; i < 49; ++i) {
        sut.wait(100ms);
        sut.hears(1, vehicle);
        sut.hears(2, {1, 77});
    }

    EXPECT_THAT(sut.command(3, gcs, {1, 0}), ElementsAre(1));
    EXPECT_THAT(sut.command(3, gcs, {1, 77}), ElementsAre(1)) << "unknown, so it goes where the system is";
}

TEST_F(Takeover, AComponentThatCameFirstDoesNotStandForTheAutopilot) {
    sut.links(3);
    sut.hears(2, {1, 250});
    sut.wait(10s);
    only(1, 1s);

    sut.hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(1));
}

TEST_F(Takeover, ANewComponentOfTheVehicleIsLearnedAtOnce) {
    sut.links(3);
    only(1, 1s);
    both_send(6s);

    sut.hears(1, {1, 154});
    EXPECT_THAT(sut.command(3, gcs, {1, 154}), ElementsAre(1));
}

TEST_F(Takeover, TheComponentsOfACompanionAreLearnedTogetherAndReportedOnce) {
    sut.links(3);
    for (int i = 0; i < 52; ++i) {
        sut.wait(100ms);
        sut.hears(1, vehicle);
        sut.hears(2, {1, 191});
    }
    ASSERT_THAT(sut.command(3, gcs, {1, 191}), ElementsAre(2));

    for (const std::uint8_t component : std::array<std::uint8_t, 3>{154, 100, 171}) {
        sut.hears(2, {1, component});
        EXPECT_THAT(sut.command(3, gcs, {1, component}), ElementsAre(2));
    }
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 1u);
}

// A link claims up to 32 vehicles at once.
TEST_F(Takeover, FortyVehiclesOfOneLinkGetTheirCommandsBack) {
    sut.links(3);
    const auto all_send = [&](std::uint32_t link) {
        for (std::uint8_t system = 1; system <= 40; ++system) sut.wait(1ms).hears(link, {system, 1});
    };
    for (int i = 0; i < 120; ++i) {
        all_send(2);
        if (i > 0) all_send(1);
        sut.wait(100ms);
        if (i == 35) {
            EXPECT_THAT(sut.command(3, gcs, {40, 1}), ElementsAre(2)) << "its claim waits for a place";
        }
    }

    for (std::uint8_t system = 1; system <= 40; ++system)
        EXPECT_THAT(sut.command(3, gcs, {system, 1}), ElementsAre(1, 2)) << int{system};
}

TEST_F(Takeover, AGapOfTwoSecondsStartsTheFiveSecondsAgain) {
    sut.links(3);
    only(1, 1s);
    both_send(4s);
    only(1, 2s);

    both_send(4s);

    EXPECT_THAT(command(), ElementsAre(1));
}

TEST_F(Takeover, AVehicleThatFellSilentIsLearnedElsewhereAtOnce) {
    sut.links(3);
    only(1, 1s);
    sut.wait(1999ms);
    sut.hears(2, vehicle);
    EXPECT_THAT(command(), ElementsAre(1));

    sut.wait(1ms);
    sut.hears(2, vehicle);

    EXPECT_THAT(command(), ElementsAre(1, 2));
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 0u);
}

TEST_F(Takeover, LearnFirstKeepsTheFirstUntilItIsSilent) {
    sut.link();
    sut.link({.learns_first = true});
    sut.link();
    only(1, 1s);
    both_send(60s);
    EXPECT_THAT(command(), ElementsAre(1));

    only(2, 2s);

    EXPECT_THAT(command(), ElementsAre(1, 2));
}

TEST_F(Takeover, LearnFirstOnTheAttackersLinkDoesNotKeepTheVehicleOut) {
    sut.link();
    sut.link({.learns_first = true});
    sut.link();
    only(2, 10s);

    both_send(5100ms);

    EXPECT_THAT(command(), ElementsAre(1, 2));
}

TEST_F(Takeover, LearnFirstDoesNotKeepAVerifiedVehicleOut) {
    sut.link({.is_verified = true, .learns_first = true});
    sut.link({.learns_first = true});
    sut.link();
    only(2, 10s);

    sut.hears(1, vehicle);

    EXPECT_THAT(command(), ElementsAre(1));
}

TEST_F(Takeover, LinksOfAGroupBringTheSameVehicleAtOnce) {
    sut.links(2, {.group = GroupId{1}});
    sut.link();
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);

    EXPECT_THAT(command(), ElementsAre(1, 2));
}

TEST_F(Takeover, TwoGroundStationsWithOneIdAreBothFedAndBothAnswered) {
    sut.links(3);
    sut.hears(1, gcs);
    sut.hears(2, gcs);
    sut.hears(3, vehicle);

    EXPECT_THAT(sut.command(3, vehicle, gcs), ElementsAre(1, 2));
    EXPECT_THAT(sut.send(3, "ATTITUDE", vehicle), ElementsAre(1, 2));
}

TEST_F(Takeover, AGroundStationIsAnsweredAlsoIfSomebodyClaimsThatItIsAVehicle) {
    sut.link();
    sut.links(2, {.learns_first = true});
    sut.hears(1, vehicle);
    sut.settles(2, {255, 1});
    sut.hears(3, gcs);

    EXPECT_THAT(sut.command(1, vehicle, gcs), ElementsAre(3));
}

TEST_F(Takeover, AForgedRestartForgetsNothingOnOtherLinks) {
    sut.links(3);
    only(1, 1s);
    sut.hears(2, vehicle);

    sut.engine.note_reboot(LinkId{2}, vehicle, sut.now);

    EXPECT_THAT(command(), ElementsAre(1));
}

TEST_F(Takeover, OneForgedFrameFromAStationsAddressCostsItNoTelemetry) {
    sut.links(3);
    only(1, 1s);
    sut.hears(3, gcs);

    sut.hears(3, vehicle);
    sut.hears(3, {1, 100});

    EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), ElementsAre(2, 3));
    EXPECT_THAT(sut.send(1, "ATTITUDE", {1, 100}), ElementsAre(2, 3));
}

// Link 1 has the vehicle, link 3 the station. Somebody on link 1 sends as the station too, such as a member of a
// multicast group.
class ForgedStation : public Takeover {
protected:
    void fly(Nanoseconds time, bool forged) {
        for (Nanoseconds passed{}; passed < time; passed += 500ms) {
            sut.wait(500ms);
            sut.hears(1, vehicle);
            if (forged) sut.hears(1, gcs);
            beat_went_to = sut.hears(3, gcs);
        }
    }
    test::Ids beat_went_to;
};

TEST_F(ForgedStation, KeepsNoCommandsFromTheVehicleHoweverLong) {
    sut.links(3);
    fly(3s, false);
    for (int i = 0; i < 60; ++i) {
        fly(1s, true);
        EXPECT_THAT(command(), ElementsAre(1)) << i;
    }
}

TEST_F(ForgedStation, KeepsNoBroadcastsFromTheVehicleForFiveSeconds) {
    sut.links(3);
    fly(3s, false);
    fly(5s, true);
    EXPECT_THAT(beat_went_to, ElementsAre(1, 2));

    fly(500ms, true);
    EXPECT_THAT(beat_went_to, ElementsAre(2));
}

TEST_F(ForgedStation, KeepsNothingFromTheVehicleWithLearnFirst) {
    sut.link({.learns_first = true});
    sut.links(2);
    fly(3s, false);
    fly(60s, true);

    EXPECT_THAT(beat_went_to, ElementsAre(1, 2));
}

TEST_F(ForgedStation, OfWhichOnlyTheOtherIsPresentGetsNothingFromThere) {
    sut.links(3);
    fly(3s, false);
    sut.settles(2, {42, 1});
    const auto went_to = sut.hears(1, {42, 1});

    EXPECT_THAT(went_to, ElementsAre(3));
}

TEST_F(Takeover, AVerifiedLinkOutranksOthersAlways) {
    sut.links(1, {.is_verified = true});
    sut.links(2);
    only(2, 10s);
    ASSERT_THAT(command(), ElementsAre(2));

    sut.hears(1, vehicle);
    EXPECT_THAT(command(), ElementsAre(1)) << "what the other link taught is forgotten";

    only(2, 30s);
    EXPECT_THAT(command(), ElementsAre(1)) << "as long as the verified route has not timed out";
}

TEST_F(Takeover, WhatAnUnverifiedLinkRepeatedBeforeDoesNotStopAVerifiedFrame) {
    sut.links(1, {.is_verified = true});
    sut.link();
    sut.link({.is_verified = true});
    const auto frame = test::make_frame("ATTITUDE", vehicle);
    ASSERT_THAT(sut.pass(2, frame), ElementsAre(1, 3));

    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2, 3));
}

}  // namespace
}  // namespace mavloom::route
