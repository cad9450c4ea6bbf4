// SPDX-License-Identifier: MIT
// Expected values: docs/guide/queues.md, "Peers of a UDP port", by hand.
#include "link/eviction.hpp"

#include <gtest/gtest.h>

namespace mavloom::link::detail {
namespace {

using namespace std::chrono_literals;

constexpr MonoTime evicted_at{std::chrono::hours{1000}};

struct SilentPeer {
    LinkId id;
    MonoTime heard{};
    bool talked = true;

    [[nodiscard]] bool has_talked() const { return talked; }
    [[nodiscard]] MonoTime silent_since() const { return heard; }
};

// Peers that were heard a second ago, in the order in which they came.
class Silent {
public:
    explicit Silent(std::size_t count) : peers_(count) {
        for (std::size_t i = 0; i < count; ++i)
            peers_[i] = {LinkId{static_cast<std::uint32_t>(i + 1)}, evicted_at - 1s};
    }
    SilentPeer& operator[](std::size_t i) { return peers_[i]; }
    [[nodiscard]] SilentPeer* evicted() {
        std::vector<SilentPeer*> all;
        for (SilentPeer& peer : peers_) all.push_back(&peer);
        return to_evict(all, evicted_at);
    }

private:
    std::vector<SilentPeer> peers_;
};

TEST(Eviction, NobodyThatTalksWithinTwoSecondsLeaves) {
    Silent peers(15);
    peers[3].heard = evicted_at - 1999ms;
    EXPECT_EQ(peers.evicted(), nullptr);

    peers[3].heard = evicted_at - 2s;
    EXPECT_EQ(peers.evicted(), &peers[3]);
}

TEST(Eviction, APeerThatHasNotTalkedLeavesFirst) {
    Silent peers(15);
    peers[2].heard = evicted_at - 5s;
    peers[7].talked = peers[8].talked = false;
    peers[8].heard = evicted_at - 1001ms;

    EXPECT_EQ(peers.evicted(), &peers[8]);
}

TEST(Eviction, OfManyPeersTheOlderHalfMayBeSilentForTenSeconds) {
    Silent peers(16);
    peers[7].heard = evicted_at - 9999ms;
    EXPECT_EQ(peers.evicted(), nullptr);

    peers[8].heard = evicted_at - 2s;
    EXPECT_EQ(peers.evicted(), &peers[8]);

    peers[7].heard = evicted_at - 10s;
    EXPECT_EQ(peers.evicted(), &peers[7]);
}

}  // namespace
}  // namespace mavloom::link::detail
