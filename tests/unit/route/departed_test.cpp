// SPDX-License-Identifier: MIT
// Who is believed when a vehicle's link goes away. The rules: docs/design/security.md, "Who is believed". Link 1 has
// the vehicle, link 2 somebody who claims to be it, link 3 a ground station.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "unit/route/route_frames.hpp"

namespace mavloom::route {
namespace {

using namespace std::chrono_literals;
using test::gcs;
using test::Network;
using test::vehicle;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

class DepartedVehicle : public testing::Test {
protected:
    static constexpr std::uint64_t home = 7, elsewhere = 8;
    void connect(std::uint32_t link, const LinkPolicy& policy = {}, std::uint64_t address = 0) {
        ASSERT_TRUE(sut.engine.add_link(LinkId{link}, policy, address));
    }
    void connect_all(const LinkPolicy& policy_of_vehicle = {}) {
        connect(1, policy_of_vehicle, home);
        connect(2, {}, elsewhere);
        connect(3);
    }
    // The vehicle has link 1 and loses it.
    void lose(const LinkPolicy& policy = {}) {
        connect_all(policy);
        for (int i = 0; i <= 50; ++i) {
            sut.wait(100ms);
            sut.hears(1, vehicle);
        }
        sut.engine.remove_link(LinkId{1});
    }
    void impostor_sends(Nanoseconds time) {
        for (Nanoseconds passed{}; passed < time; passed += 100ms) {
            sut.wait(100ms);
            sut.hears(2, vehicle);
        }
    }
    [[nodiscard]] test::Ids command() { return sut.command(3, gcs, vehicle); }

    Network sut;
};

TEST_F(DepartedVehicle, IsLearnedAtOnceWhenItConnectsAgain) {
    lose();
    impostor_sends(1s);
    EXPECT_THAT(command(), IsEmpty());

    connect(4, {}, home);
    sut.hears(4, vehicle);
    impostor_sends(1s);
    EXPECT_THAT(command(), ElementsAre(4));
}

// Somebody connects, claims to be the vehicle and leaves, again and again.
TEST_F(DepartedVehicle, WasHeardForFiveSecondsElseItKeepsNoPlace) {
    connect(1, {}, home);
    connect(3);
    for (std::uint32_t link = 10; link < 20; ++link) {
        connect(link, {}, link);
        sut.hears(link, vehicle);
        sut.engine.remove_link(LinkId{link});
        sut.hears(1, vehicle);
        sut.wait(100ms);
    }

    EXPECT_THAT(command(), ElementsAre(1));
}

// An impostor with many links leaves one whenever the place of the last one ends.
TEST_F(DepartedVehicle, YieldsToAVehicleThatIsHeardForFiveSeconds) {
    connect(1, {}, home);
    connect(3);
    for (std::uint32_t link = 10; link < 20; ++link) connect(link, {}, link);
    for (std::uint32_t i = 0; i < 158; ++i) {
        sut.wait(100ms);
        if (i >= 100 && i % 20 == 0) sut.engine.remove_link(LinkId{10 + i / 20});
        if (i >= 100 && i % 20 != 19) sut.hears(1, vehicle);
        for (std::uint32_t link = 10; link < 20; ++link) sut.hears(link, vehicle);
    }
    sut.wait(100ms).hears(1, vehicle);

    EXPECT_THAT(command(), Contains(1));
}

TEST_F(DepartedVehicle, KeepsItsPlaceForTwoSeconds) {
    lose();
    impostor_sends(1900ms);
    EXPECT_THAT(command(), IsEmpty());

    impostor_sends(100ms);
    EXPECT_THAT(command(), ElementsAre(2));
}

TEST_F(DepartedVehicle, OfAVerifiedLinkKeepsItsPlaceUntilItsRouteTimesOut) {
    lose({.is_verified = true});
    impostor_sends(59s);
    EXPECT_THAT(command(), IsEmpty());

    impostor_sends(1100ms);
    EXPECT_THAT(command(), ElementsAre(2));
}

TEST_F(DepartedVehicle, OfALinkThatWasClosedOnPurposeKeepsNoPlace) {
    connect_all({.is_verified = true});
    sut.hears(1, vehicle);
    sut.engine.close_link(LinkId{1});
    sut.hears(2, vehicle);

    EXPECT_THAT(command(), ElementsAre(2));
}

TEST_F(DepartedVehicle, KeepsItsPlaceAfterItsLastFrameWhicheverComponentSentIt) {
    connect_all({.is_verified = true});
    sut.hears(1, {1, 154});
    sut.wait(30s);
    sut.hears(1, vehicle);
    sut.wait(1s);
    sut.hears(3, gcs);
    sut.engine.remove_link(LinkId{1});
    impostor_sends(50s);

    EXPECT_THAT(command(), IsEmpty());
}

TEST_F(DepartedVehicle, OfAGroupKeepsItsPlaceAfterTheLastFrameOnAnyLink) {
    connect_all({.group = GroupId{1}});
    connect(4, {.group = GroupId{1}}, 9);
    for (int i = 0; i < 5; ++i) {
        sut.hears(4, vehicle);
        sut.wait(1500ms);
        sut.hears(1, vehicle);
    }
    sut.engine.remove_link(LinkId{1});
    sut.engine.remove_link(LinkId{4});
    impostor_sends(1s);

    EXPECT_THAT(command(), IsEmpty());
}

TEST_F(DepartedVehicle, DoesNotBlockALinkThatHadARouteBefore) {
    connect_all();
    sut.hears(2, {1, 191});
    for (int i = 0; i <= 5; ++i) sut.wait(1s).hears(1, vehicle);
    sut.engine.remove_link(LinkId{1});
    sut.wait(1s).hears(2, {1, 191});

    EXPECT_EQ(sut.engine.routes(sut.now)[0].age, 0s);
}

TEST_F(DepartedVehicle, IsNoGroundStation) {
    connect_all({.is_verified = true});
    sut.hears(1, gcs);
    sut.engine.remove_link(LinkId{1});
    sut.hears(2, gcs);

    EXPECT_THAT(sut.command(3, vehicle, gcs), ElementsAre(2));
}

TEST_F(DepartedVehicle, MayReturnOnAnyVerifiedLink) {
    lose({.is_verified = true});
    connect(4, {.is_verified = true}, elsewhere);
    sut.hears(4, vehicle);

    EXPECT_THAT(command(), ElementsAre(4));
}

TEST_F(DepartedVehicle, MayReturnOnALinkOfItsGroup) {
    lose({.group = GroupId{1}});
    connect(4, {.group = GroupId{1}});
    sut.hears(4, vehicle);

    EXPECT_THAT(command(), ElementsAre(4));
}

TEST_F(DepartedVehicle, MayNotReturnOnAnotherPeerOfItsEndpoint) {
    lose({.group = GroupId{1}, .endpoint = 1});
    connect(4, {.group = GroupId{1}, .endpoint = 1}, elsewhere);
    sut.hears(4, vehicle);

    EXPECT_THAT(command(), IsEmpty());
}

TEST_F(DepartedVehicle, IsNotReplacedByAnImpostorWhoseLinkGoesToo) {
    connect(2, {}, elsewhere);
    connect(3);
    for (int i = 0; i < 60; ++i) {
        sut.wait(100ms);
        if (i == 0) connect(1, {}, home);
        sut.hears(1, vehicle);
        sut.hears(2, vehicle);
    }
    ASSERT_THAT(command(), ElementsAre(1, 2)) << "the impostor has earned a route";
    sut.engine.remove_link(LinkId{1});
    sut.engine.remove_link(LinkId{2});
    connect(4, {}, home);
    sut.hears(4, vehicle);

    EXPECT_THAT(command(), ElementsAre(4));
}

}  // namespace
}  // namespace mavloom::route
