// SPDX-License-Identifier: MIT
// Expected values: docs/guide/queues.md, "Peers of a UDP port", by hand.
#include "link/peer_policy.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace mavloom::link::detail {
namespace {

using namespace std::chrono_literals;

net::Address sender(std::uint32_t number) {
    const std::string host = "10.0.0." + std::to_string(1 + number / 65000);
    return *net::Address::parse(host, static_cast<std::uint16_t>(1 + number % 65000));
}

constexpr MonoTime start{std::chrono::hours{1000}};

bool admits(PeerPolicy& policy, const net::Address& who, MonoTime now) {
    return policy.ask(who, now) == PeerPolicy::Answer::admitted;
}

PeerPolicy used_up(std::size_t max_peers) {
    PeerPolicy policy(max_peers);
    for (std::uint32_t i = 0; i < 2 * max_peers; ++i) {
        EXPECT_TRUE(admits(policy, sender(1000 + i), start));
        policy.note_entry(start);
    }
    return policy;
}

TEST(PeerPolicyEntry, LetsABurstInThenFiftyASecond) {
    PeerPolicy sut = used_up(32);
    EXPECT_FALSE(admits(sut, sender(1), start));

    int entered = 0;
    for (int ms = 1; ms <= 1000; ++ms) {
        if (!admits(sut, sender(static_cast<std::uint32_t>(2000 + ms)), start + ms * 1ms)) continue;
        sut.note_entry(start + ms * 1ms);
        ++entered;
    }

    EXPECT_EQ(entered, 50);
}

TEST(PeerPolicyEntry, LetsASenderInThatRepeatsWithinTenSeconds) {
    for (const auto& [wait, enters] : {std::pair{499ms, false}, std::pair{500ms, true}, std::pair{10'000ms, true}}) {
        PeerPolicy sut = used_up(32);
        ASSERT_FALSE(admits(sut, sender(1), start));
        // A flood keeps the steady rate used up.
        for (int i = 0; i < 600; ++i) {
            const MonoTime now = start + wait * i / 600;
            if (admits(sut, sender(static_cast<std::uint32_t>(2000 + i)), now)) sut.note_entry(now);
        }
        while (admits(sut, sender(70000), start + wait)) sut.note_entry(start + wait);

        EXPECT_EQ(admits(sut, sender(1), start + wait), enters) << wait.count();
    }
}

// Three times as many addresses as fit into the table.
TEST(PeerPolicyEntry, AFloodDoesNotMakeItForgetASenderBeforeItsNextHeartbeat) {
    PeerPolicy sut = used_up(32);
    ASSERT_FALSE(admits(sut, sender(1), start));
    for (std::uint32_t i = 0; i < 200'000; ++i) {
        const MonoTime now = start + i * 5us;
        if (admits(sut, sender(2000 + i), now)) sut.note_entry(now);
    }
    while (admits(sut, sender(250'000), start + 1s)) sut.note_entry(start + 1s);

    EXPECT_TRUE(admits(sut, sender(1), start + 1s));
}

TEST(PeerPolicyEntry, ASenderThatComesBackAfterALongTimeIsNew) {
    PeerPolicy sut = used_up(32);
    ASSERT_FALSE(admits(sut, sender(1), start));
    const MonoTime later = start + 10'001ms;
    while (admits(sut, sender(70000), later)) sut.note_entry(later);

    EXPECT_FALSE(admits(sut, sender(1), later));
    EXPECT_TRUE(admits(sut, sender(1), later + 500ms));
}

// 12,000 addresses, each of which sends every 0.6 s.
TEST(PeerPolicyEntry, LetsAHundredRepeatersInASecond) {
    PeerPolicy sut = used_up(32);
    int entered = 0, limited = 0;
    for (std::uint32_t i = 0; i < 120'000; ++i) {
        const MonoTime now = start + i * 50us;
        const auto answer = sut.ask(sender(i % 12'000), now);
        if (answer == PeerPolicy::Answer::admitted) {
            sut.note_entry(now);
            ++entered;
        }
        limited += answer == PeerPolicy::Answer::limited ? 1 : 0;
    }

    EXPECT_GE(entered, 6 * (50 + 100) - 100);
    EXPECT_LE(entered, 6 * (50 + 100) + 100);
    EXPECT_GT(limited, 100'000);
}

// 200,000 addresses in a second: three times as many as the table has room for.
TEST(PeerPolicyEntry, LetsARepeaterInAtOnceAmongInventedAddresses) {
    constexpr std::uint32_t invented = 200'000;
    const net::Address repeater = sender(invented);
    PeerPolicy sut = used_up(32);
    for (std::uint32_t i = 0; i < invented; ++i) {
        const MonoTime now = start + i * 5us;
        if (admits(sut, sender(i), now)) sut.note_entry(now);
        if (i == 100) {
            ASSERT_FALSE(admits(sut, repeater, now));
        }
    }

    EXPECT_TRUE(admits(sut, repeater, start + invented * 5us));
}

TEST(PeerPolicyEntry, AtLeast64EnterAtOnce) {
    PeerPolicy sut(1);
    for (std::uint32_t i = 0; i < 64; ++i) {
        EXPECT_TRUE(admits(sut, sender(i), start));
        sut.note_entry(start);
    }
    EXPECT_FALSE(admits(sut, sender(64), start));
}

// Peers that talk and were heard a second ago, in the order in which they came. The policy gets them in reverse.
struct FullTable : ::testing::Test {
    using Candidate = PeerPolicy::Candidate;

    void fill(std::size_t count) {
        while (peers.size() < count) add(true, start - 1s);
    }
    LinkId add(bool talks, MonoTime silent_since, std::uint16_t crowd = 0) {
        const LinkId id{static_cast<std::uint32_t>(peers.size() + 1)};
        peers.insert(peers.begin(), {id, talks, silent_since, crowd});
        return id;
    }
    // A client that has sent nothing yet, and came after all others.
    LinkId add_silent(std::uint16_t crowd) { return add(false, start - 1h + (silent++) * 1s, crowd); }
    Candidate& operator[](std::uint32_t id) { return *std::ranges::find(peers, LinkId{id}, &Candidate::id); }
    [[nodiscard]] std::optional<LinkId> evicted() const { return PeerPolicy::to_evict(peers, start); }
    [[nodiscard]] bool is_small(std::uint16_t crowd) const { return PeerPolicy::is_small(crowd, peers); }

    std::vector<Candidate> peers;
    std::optional<LinkId> inside;  // the vehicle's id while it is a peer
    int silent = 0;
};

TEST_F(FullTable, NoPeerThatTalksWithinFiveSecondsIsEvicted) {
    fill(15);
    (*this)[3].silent_since = start - 4999ms;
    EXPECT_EQ(evicted(), std::nullopt);

    (*this)[3].silent_since = start - 5s;
    EXPECT_EQ(evicted(), LinkId{3});
}

TEST_F(FullTable, APeerThatHasNotTalkedIsEvictedFirst) {
    fill(15);
    (*this)[2].silent_since = start - 50s;
    (*this)[7].has_talked = (*this)[8].has_talked = false;
    (*this)[8].silent_since = start - 1001ms;

    EXPECT_EQ(evicted(), LinkId{8});
}

TEST_F(FullTable, AnEmptyOneEvictsNobody) { EXPECT_EQ(evicted(), std::nullopt); }

TEST_F(FullTable, OfTheLargestCrowdTheLongestSilentIsEvicted) {
    add_silent(2);
    const LinkId first_of_many = add_silent(9);
    add_silent(9);

    EXPECT_EQ(evicted(), first_of_many);
}

TEST_F(FullTable, OfEqualCrowdsThatWithTheLongestSilentLosesIt) {
    const LinkId first = add_silent(2);
    for (const std::uint16_t crowd : std::to_array<std::uint16_t>({9, 9, 2, 6, 6})) add_silent(crowd);

    EXPECT_EQ(evicted(), first);
}

TEST_F(FullTable, PeersThatTalkAreNoCrowd) {
    for (int i = 0; i < 3; ++i) add(true, start, 9);
    EXPECT_EQ(evicted(), std::nullopt);
    EXPECT_FALSE(is_small(2));

    const LinkId silent_one = add_silent(2);

    EXPECT_EQ(evicted(), silent_one);
}

TEST_F(FullTable, ACrowdIsSmallIfOneMoreStillLeavesItBehindTheLargest) {
    for (int i = 0; i < 3; ++i) add_silent(9);
    add_silent(2);

    EXPECT_TRUE(is_small(3));
    EXPECT_TRUE(is_small(2));
    EXPECT_FALSE(is_small(9));
    add_silent(2);
    EXPECT_FALSE(is_small(2)) << "they would be equal";
}

TEST(PeerPolicyCrowd, IsAHostWhateverItsPort) {
    const auto crowd = [](const char* host, std::uint16_t port) {
        return PeerPolicy::crowd_of(*net::Address::parse(host, port));
    };
    EXPECT_EQ(crowd("10.0.0.2", 1000), crowd("10.0.0.2", 2000));
    EXPECT_EQ(crowd("10.0.0.2", 1000), crowd("::ffff:10.0.0.2", 1000));
    EXPECT_EQ(crowd("fd00::1", 1000), crowd("fd00::2", 1000)) << "an IPv6 host has a /64";
    int different = 0;  // two of them in one crowd by chance: 1 of 1,024
    for (int host = 3; host < 20; ++host)
        different += crowd("10.0.0.2", 0) != crowd(fmt::format("10.0.0.{}", host).c_str(), 0) ? 1 : 0;
    EXPECT_GT(different, 10);
}

TEST_F(FullTable, EachOfTheYoungerHalfIsDisplacedSometimesAndNoOther) {
    fill(16);
    PeerPolicy sut(16, 1);
    std::vector<int> left(17);
    for (int i = 0; i < 800; ++i) ++left[sut.to_displace(peers, start + i * 2s).value().value];

    for (std::size_t id = 1; id <= 16; ++id) {
        EXPECT_EQ(left[id] == 0, id <= 8) << id;
        EXPECT_LT(left[id], 200) << id;
    }
}

TEST_F(FullTable, OfFewPeersNoneIsDisplaced) {
    fill(15);
    EXPECT_EQ(PeerPolicy(15).to_displace(peers, start), std::nullopt);
}

TEST_F(FullTable, FourAreDisplacedAtOnceThenOneEachTwoSeconds) {
    fill(256);
    PeerPolicy sut(256);
    const auto displaced = [&](Nanoseconds from, Nanoseconds to) {
        int count = 0;
        for (auto passed = from; passed < to; passed += 10ms)
            count += sut.to_displace(peers, start + passed).has_value() ? 1 : 0;
        return count;
    };

    EXPECT_EQ(displaced(0s, 1s), 4);
    EXPECT_EQ(displaced(1s, 21s), 10);
    EXPECT_EQ(displaced(61s, 62s), 4);
}

// 256 talkers came before the vehicle. A peer that was displaced tries again.
TEST_F(FullTable, ALateVehicleHasAPlaceMostOfTheTime) {
    fill(256);
    const LinkId vehicle{1000};
    LinkId waits = vehicle;
    PeerPolicy sut(256, 1);
    int seconds_inside = 0;
    for (std::uint32_t second = 0; second < 3600; ++second) {
        if (const auto leaves = sut.to_displace(peers, start + second * 1s)) {
            const bool vehicle_leaves = inside == leaves;
            const LinkId entered{2000 + second};
            (*this)[leaves->value].id = entered;
            if (waits == vehicle) inside = entered;
            waits = vehicle_leaves ? vehicle : *leaves;
        }
        seconds_inside += waits != vehicle ? 1 : 0;
    }

    EXPECT_GT(seconds_inside, 3400);
}

}  // namespace
}  // namespace mavloom::link::detail
