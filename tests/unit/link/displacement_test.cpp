// SPDX-License-Identifier: MIT
#include "link/displacement.hpp"

#include <gtest/gtest.h>

#include <memory>

namespace mavloom::link::detail {
namespace {

using namespace std::chrono_literals;

struct Talker {
    LinkId id{};
};

constexpr MonoTime long_ago{std::chrono::hours{1000}};

// Peers in the order in which they came. `all` lists them from the last to the first.
class Crowd {
public:
    explicit Crowd(std::size_t size) : peers_(size) {
        for (std::size_t i = 0; i < size; ++i) peers_[i].id = LinkId{static_cast<std::uint32_t>(i + 1)};
    }
    [[nodiscard]] std::vector<Talker*> all() {
        std::vector<Talker*> list;
        for (Talker& peer : peers_) list.insert(list.begin(), &peer);
        return list;
    }
    [[nodiscard]] std::size_t place_of(const Talker* peer) const {
        return static_cast<std::size_t>(peer - peers_.data());
    }

private:
    std::vector<Talker> peers_;
};

TEST(Displacement, EachOfTheYoungerHalfLeavesSometimesAndNoOther) {
    Crowd crowd(16);
    Displacement sut(1);
    std::vector<int> left(16);
    MonoTime now = long_ago + 1h;
    for (int i = 0; i < 800; ++i) {
        Talker* const peer = sut.choose(crowd.all(), now);
        ASSERT_NE(peer, nullptr);
        ++left[crowd.place_of(peer)];
        now += 2s;
    }

    for (std::size_t i = 0; i < 16; ++i) {
        EXPECT_EQ(left[i] == 0, i < 8) << i;
        EXPECT_LT(left[i], 200) << i;
    }
}

TEST(Displacement, AmongFewPeersNobodyLeaves) {
    Crowd crowd(15);
    Displacement sut(1);

    EXPECT_EQ(sut.choose(crowd.all(), long_ago + 1h), nullptr);
}

TEST(Displacement, FourLeaveAtOnceThenOneEachTwoSeconds) {
    Crowd crowd(256);
    Displacement sut(1);
    int left = 0;
    const auto until = [&](Nanoseconds from, Nanoseconds to) {
        left = 0;
        for (auto passed = from; passed < to; passed += 10ms)
            left += sut.choose(crowd.all(), long_ago + 1h + passed) != nullptr ? 1 : 0;
        return left;
    };

    EXPECT_EQ(until(0s, 1s), 4);
    EXPECT_EQ(until(1s, 21s), 10);
    EXPECT_EQ(until(61s, 62s), 4);
}

// 256 talkers came before the vehicle. A peer that had to leave tries again.
TEST(Displacement, ALateVehicleHasAPlaceMostOfTheTime) {
    std::vector<std::unique_ptr<Talker>> inside;
    for (int i = 0; i < 256; ++i)
        inside.push_back(std::make_unique<Talker>(Talker{LinkId{static_cast<std::uint32_t>(i + 1)}}));
    auto outside = std::make_unique<Talker>();
    const Talker* const vehicle = outside.get();
    Displacement sut(1);
    int seconds_inside = 0;
    for (int second = 0; second < 3600; ++second) {
        const MonoTime now = long_ago + 10s + second * 1s;
        std::vector<Talker*> all;
        for (const auto& peer : inside) all.push_back(peer.get());
        if (Talker* const leaves = sut.choose(all, now); leaves != nullptr) {
            auto& place = *std::ranges::find(inside, leaves, &std::unique_ptr<Talker>::get);
            std::swap(place, outside);
            place->id = LinkId{static_cast<std::uint32_t>(258 + second)};
        }
        seconds_inside += outside.get() != vehicle ? 1 : 0;
    }

    EXPECT_GT(seconds_inside, 3400);
}

}  // namespace
}  // namespace mavloom::link::detail
