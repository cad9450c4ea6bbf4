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
using testing::ElementsAre;
using testing::IsEmpty;

class DepartedVehicle : public testing::Test {
protected:
    static constexpr std::uint64_t home = 7, elsewhere = 8;
    void connect(std::uint32_t link, const LinkPolicy& policy = {}, std::uint64_t address = 0) {
        ASSERT_TRUE(sut.engine.add_link(LinkId{link}, policy, address));
    }
    // The vehicle has link 1 and loses it.
    void lose(const LinkPolicy& policy = {}) {
        connect(1, policy, home);
        connect(2, {}, elsewhere);
        connect(3);
        for (int i = 0; i < 10; ++i) {
            sut.wait(100ms);
            sut.hears(1, vehicle);
            sut.hears(2, vehicle);
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
    lose();
    connect(5, {}, elsewhere);
    sut.hears(5, {1, 77});
    sut.engine.remove_link(LinkId{2});
    sut.engine.remove_link(LinkId{5});
    connect(4, {}, home);
    sut.hears(4, vehicle);

    EXPECT_THAT(command(), ElementsAre(4));
}

}  // namespace
}  // namespace mavloom::route
