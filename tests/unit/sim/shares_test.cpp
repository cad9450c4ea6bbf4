// SPDX-License-Identifier: MIT
#include "sim/service/shares.hpp"

#include <gmock/gmock.h>

#include "sim/radio/client.hpp"

namespace mavloom::sim {
namespace {

using testing::ElementsAre;

struct Place {
    Client client;
};

// One place for each link id given, the oldest first.
std::vector<Place> places_of(std::initializer_list<std::uint32_t> links) {
    std::vector<Place> places;
    for (const std::uint32_t link : links)
        places.push_back({{LinkId{link}, {SystemId{static_cast<std::uint8_t>(places.size())}, ComponentId{1}}}});
    return places;
}

std::vector<int> systems_in(const std::vector<Place>& places) {
    std::vector<int> systems;
    for (const Place& place : places) systems.push_back(place.client.id.system.value);
    return systems;
}

TEST(Shares, NobodyLeavesWhileThereAreFreePlaces) {
    auto places = places_of({1, 1, 1});

    EXPECT_TRUE(make_room(places, LinkId{2}, 4));
    EXPECT_TRUE(make_room(places, LinkId{1}, 4));

    EXPECT_EQ(places.size(), 3u);
}

TEST(Shares, TheLinkWithMostPlacesLosesItsOldestOne) {
    auto places = places_of({2, 1, 3, 1, 1, 3});

    EXPECT_TRUE(make_room(places, LinkId{2}, 6));

    EXPECT_THAT(systems_in(places), ElementsAre(0, 2, 3, 4, 5));
}

TEST(Shares, ALinkGetsNoMoreThanItsShare) {
    auto places = places_of({1, 1, 2, 3});

    EXPECT_FALSE(make_room(places, LinkId{1}, 4)) << "it has most places";
    EXPECT_FALSE(make_room(places, LinkId{3}, 4)) << "it would have as many";
    EXPECT_TRUE(make_room(places, LinkId{4}, 4));
}

TEST(Shares, WithoutPlacesThereIsNoRoom) {
    auto places = places_of({});

    EXPECT_FALSE(make_room(places, LinkId{1}, 0));
}

}  // namespace
}  // namespace mavloom::sim
