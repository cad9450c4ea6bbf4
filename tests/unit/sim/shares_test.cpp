// SPDX-License-Identifier: MIT
#include "sim/service/shares.hpp"

#include <gmock/gmock.h>

#include "sim/radio/client.hpp"

namespace mavloom::sim {
namespace {

using testing::ElementsAre;

struct Session {
    Client client;
};

// One session for each link id given, the oldest first.
std::vector<Session> sessions_of(std::initializer_list<std::uint32_t> links) {
    std::vector<Session> sessions;
    for (const std::uint32_t link : links)
        sessions.push_back({{LinkId{link}, {SystemId{static_cast<std::uint8_t>(sessions.size())}, ComponentId{1}}}});
    return sessions;
}

std::vector<int> systems_in(const std::vector<Session>& sessions) {
    std::vector<int> systems;
    for (const Session& session : sessions) systems.push_back(session.client.id.system.value);
    return systems;
}

TEST(Shares, NobodyLeavesWhileThereAreFreePlaces) {
    auto sessions = sessions_of({1, 1, 1});

    EXPECT_TRUE(make_room(sessions, LinkId{2}, 4));
    EXPECT_TRUE(make_room(sessions, LinkId{1}, 4));

    EXPECT_EQ(sessions.size(), 3u);
}

TEST(Shares, TheLinkWithMostPlacesLosesItsOldestOne) {
    auto sessions = sessions_of({2, 1, 3, 1, 1, 3});

    EXPECT_TRUE(make_room(sessions, LinkId{2}, 6));

    EXPECT_THAT(systems_in(sessions), ElementsAre(0, 2, 3, 4, 5));
}

TEST(Shares, ALinkGetsNoMoreThanItsShare) {
    auto sessions = sessions_of({1, 1, 2, 3});

    EXPECT_FALSE(make_room(sessions, LinkId{1}, 4)) << "it has most sessions";
    EXPECT_FALSE(make_room(sessions, LinkId{3}, 4)) << "it would have as many";
    EXPECT_TRUE(make_room(sessions, LinkId{4}, 4));
}

TEST(Shares, WithoutPlacesThereIsNoRoom) {
    auto sessions = sessions_of({});

    EXPECT_FALSE(make_room(sessions, LinkId{1}, 0));
}

}  // namespace
}  // namespace mavloom::sim
