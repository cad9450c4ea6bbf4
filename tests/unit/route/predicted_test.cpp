// SPDX-License-Identifier: MIT
// Frames that somebody else sent first, because they can be predicted. The vehicle's own ones then look like echoes.
// Link 1 has the attacker, link 2 the vehicle, link 3 a ground station.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/route/route_frames.hpp"

namespace mavloom::route {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::gcs;
using test::Id;
using test::make_frame;
using test::Network;
using test::vehicle;
using testing::Contains;
using testing::ElementsAre;
using testing::Not;

class Predicted : public testing::Test {
protected:
    void one_second(std::uint8_t second) {
        sut.hears(3, gcs);
        for (std::uint32_t sequence = 0; sequence < 256; ++sequence)
            sut.pass(1, beat(static_cast<std::uint8_t>(sequence)));
        sut.wait(500ms);
        sut.pass(2, beat(second));
        sut.wait(500ms);
    }
    static Bytes beat(std::uint8_t sequence) { return make_frame("HEARTBEAT", vehicle, {}, sequence); }
    [[nodiscard]] test::Ids command() { return sut.command(3, gcs, vehicle); }

    Network sut;
};

TEST_F(Predicted, AVehicleOfWhichAllHeartbeatsCameFirstFromElsewhereGetsItsCommands) {
    sut.links(3);
    for (std::uint8_t second = 0; second < 8; ++second) one_second(second);
    ASSERT_EQ(sut.counters(2).echo.value(), 8u) << "the case of this test";

    EXPECT_THAT(command(), Contains(2));
}

TEST_F(Predicted, AKnownVehicleKeepsItsRouteAlsoWithLearnFirst) {
    sut.link({.learns_first = true});
    sut.link({.learns_first = true});
    sut.link();
    sut.settles(2, vehicle);
    sut.wait(3s);  // its radio loses three heartbeats

    for (std::uint8_t second = 0; second < 90; ++second) one_second(second);

    ASSERT_GT(sut.counters(2).echo.value(), 0u) << "the case of this test";
    EXPECT_THAT(command(), Contains(2));
}

TEST_F(Predicted, AVehicleThatBeganItselfIsAlive) {
    sut.link({.learns_first = true});
    sut.links(2);
    sut.pass(2, beat(0));
    for (std::uint8_t second = 1; second < 60; ++second) {
        sut.pass(1, beat(second));
        sut.wait(1s);
        sut.pass(2, beat(second));
    }
    ASSERT_EQ(sut.counters(2).echo.value(), 59u) << "the case of this test";

    EXPECT_THAT(command(), ElementsAre(2));
}

TEST_F(Predicted, FramesOfAnEchoedSenderStillGoToTheLink) {
    sut.links(3);
    for (std::uint8_t second = 0; second < 8; ++second) one_second(second);

    EXPECT_THAT(sut.hears(1, vehicle), Contains(2)) << "an echo does not make the sender present";
}

// The link sends back what it gets, as some radios do.
class Mirror : public testing::Test {
protected:
    Mirror() { sut.links(3); }
    void mirrored(std::uint32_t from, Id source) {
        const Bytes frame = make_frame("HEARTBEAT", source, {{"custom_mode", ++count}});
        const auto sent = sut.pass(from, frame);
        sut.wait(100ms);
        if (std::ranges::find(sent, 2u) != sent.end()) sut.pass(2, frame);
        sut.wait(400ms);
    }

    Network sut;
    std::uint32_t count = 0;
};

TEST_F(Mirror, TeachesNoRoutes) {
    for (int i = 0; i < 60; ++i) {
        mirrored(1, vehicle);
        mirrored(3, gcs);
    }

    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(1));
    EXPECT_THAT(sut.command(1, vehicle, gcs), ElementsAre(3));
    EXPECT_EQ(sut.engine.counters().route_conflicts.value(), 0u);
}

TEST_F(Mirror, ThatLosesSomeFramesTeachesNoRoutes) {
    for (int i = 0; i < 60; ++i) {
        mirrored(1, vehicle);
        mirrored(3, gcs);
        for (int lost = 0; lost < 3; ++lost) sut.hears(3, gcs);
    }

    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(1));
}

TEST_F(Mirror, OfTheProgramsOwnFramesTeachesNoRoutes) {
    for (std::uint32_t i = 0; i < 20; ++i) {
        mirrored(1, vehicle);
        const Bytes own = make_frame("HEARTBEAT", {1, 191}, {{"custom_mode", i}});
        sut.engine.note_sent(wire::FrameView::unchecked(own), LinkId{2}, sut.now);
        sut.pass(2, own);
    }

    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(1));
}

TEST_F(Mirror, DoesNotKeepAVehicleThatLeftIt) {
    sut.link();
    sut.settles(2, vehicle);
    for (const std::uint32_t link : {1u, 4u})
        for (int i = 0; i < 4; ++i) {
            mirrored(3, gcs);
            mirrored(link, vehicle);
        }

    EXPECT_THAT(sut.command(3, gcs, vehicle), Contains(4)) << "learned after 2 s of silence elsewhere";
}

// The frames of this program go out on a link and do not come back, those of others do.
TEST_F(Predicted, TheProgramsOwnFramesShowThatALinkSendsNothingBack) {
    sut.links(3);
    for (std::uint8_t second = 0; second < 8; ++second) {
        const Bytes own = make_frame("HEARTBEAT", {77, 191}, {{"custom_mode", second}});
        sut.engine.note_sent(wire::FrameView::unchecked(own), LinkId{2}, sut.now);
        sut.pass(1, beat(second));
        sut.wait(500ms);
        sut.pass(2, beat(second));
        sut.wait(500ms);
    }

    EXPECT_THAT(command(), Contains(2));
}

TEST(Loop, OfTwoRoutersIsDampedWhenAFrameComesBackOnBothPaths) {
    Network sut;
    sut.links(4);  // the vehicle, two paths to the other router, a ground station
    for (int i = 0; i < 60; ++i) {
        sut.hears(4, gcs);
        const Bytes frame = make_frame("HEARTBEAT", vehicle, {{"custom_mode", static_cast<std::uint32_t>(i)}});
        const auto first = sut.pass(1, frame);
        ASSERT_THAT(first, Contains(4));
        // The other router sends what it got on one path into the other one.
        for (const std::uint32_t path : {2u, 3u})
            if (std::ranges::find(first, path) != first.end()) {
                ASSERT_THAT(sut.pass(5 - path, frame), Not(Contains(4))) << "it arrived already";
                ASSERT_THAT(sut.pass(5 - path, frame), testing::IsEmpty()) << "on path " << path;
            }
        sut.wait(1s);
    }
    const auto to = sut.command(4, gcs, vehicle);

    EXPECT_THAT(to, Contains(1));
}

}  // namespace
}  // namespace mavloom::route
