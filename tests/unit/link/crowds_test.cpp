// SPDX-License-Identifier: MIT
#include "link/tcp/crowds.hpp"

#include <gtest/gtest.h>

#include <list>
#include <string>

namespace mavloom::link::detail {
namespace {

struct CrowdMember {
    net::Address host;
    int connected_at;
    bool talks;
    [[nodiscard]] bool is_silent() const { return !talks; }
    [[nodiscard]] MonoTime silent_since() const { return MonoTime{std::chrono::seconds{connected_at}}; }
};

struct CrowdsTest : ::testing::Test {
    static net::Address address(const std::string& text) { return *net::Address::parse(text, 0); }
    CrowdMember* add(const std::string& from, bool talks = false) {
        clients.push_back({address(from), ++connected, talks});
        all.insert(all.begin(), &clients.back());  // the order in the list does not matter
        return &clients.back();
    }
    [[nodiscard]] Crowds<CrowdMember> sut() const { return Crowds<CrowdMember>(all); }

    std::list<CrowdMember> clients;
    std::vector<CrowdMember*> all;
    int connected = 0;
};

TEST_F(CrowdsTest, OfTheLargestCrowdTheLongestSilentLeaves) {
    add("10.0.0.2");
    CrowdMember* const first_of_many = add("10.0.0.9");
    add("10.0.0.9");

    EXPECT_EQ(sut().largest().longest_silent, first_of_many);
    EXPECT_EQ(sut().largest().size, 2u);
}

TEST_F(CrowdsTest, OfEqualCrowdsThatWithTheLongestSilentLosesIt) {
    CrowdMember* const first = add("10.0.0.2");
    for (const char* const from : {"10.0.0.9", "10.0.0.9", "10.0.0.2", "fd00::1", "fd00::1"}) add(from);

    EXPECT_EQ(sut().largest().longest_silent, first);
}

TEST_F(CrowdsTest, ActivePeersAreNoCrowd) {
    for (int i = 0; i < 3; ++i) add("10.0.0.9", true);
    EXPECT_EQ(sut().largest().size, 0u);
    EXPECT_FALSE(sut().has_room_for(address("10.0.0.2")));

    CrowdMember* const silent = add("10.0.0.2");

    EXPECT_EQ(sut().largest().longest_silent, silent);
}

TEST_F(CrowdsTest, AnAddressMayHaveFewerClientsThanTheLargestCrowd) {
    for (int i = 0; i < 3; ++i) add("10.0.0.9");
    add("10.0.0.2");

    EXPECT_TRUE(sut().has_room_for(address("10.0.0.3")));
    EXPECT_TRUE(sut().has_room_for(address("10.0.0.2")));
    EXPECT_FALSE(sut().has_room_for(address("10.0.0.9")));
    add("10.0.0.2");
    EXPECT_FALSE(sut().has_room_for(address("10.0.0.2"))) << "they would be equal";
}

}  // namespace
}  // namespace mavloom::link::detail
