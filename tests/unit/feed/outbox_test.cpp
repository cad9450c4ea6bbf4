// SPDX-License-Identifier: MIT
#include "feed/outbox.hpp"

#include <gtest/gtest.h>

#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;

constexpr link::EndpointId to{7};

TEST(Outbox, KeepsFramesAndTheirDestinationInOrder) {
    Outbox outbox;
    EXPECT_TRUE(outbox.take().empty());
    EXPECT_EQ(outbox.put(to, view(numbered(1))), Outbox::Put::first);
    EXPECT_EQ(outbox.put(link::EndpointId{8}, view(frame_of(131, Bytes(255, 3)))), Outbox::Put::queued);
    const auto taken = outbox.take();
    ASSERT_EQ(taken.size(), 2u);
    EXPECT_EQ(taken[0].to(), to);
    EXPECT_EQ(number_of(taken[0].frame()), 1u);
    EXPECT_EQ(taken[1].to(), link::EndpointId{8});
    EXPECT_TRUE(std::ranges::equal(taken[1].frame().bytes(), frame_of(131, Bytes(255, 3))));
    EXPECT_EQ(outbox.put(to, view(numbered(2))), Outbox::Put::first);  // empty again: the loop sleeps
}

TEST(Outbox, AFullOneMakesSendersWaitAndLosesNothing) {
    Outbox outbox;
    constexpr std::uint32_t each = 3 * Outbox::capacity;
    std::vector<std::thread> senders;
    for (std::uint8_t system = 1; system <= 3; ++system)
        senders.emplace_back([&, system] {
            for (std::uint32_t number = 1; number <= each; ++number)
                EXPECT_NE(outbox.put(to, view(numbered(number, system))), Outbox::Put::closed);
        });
    std::map<std::uint8_t, std::uint32_t> newest;
    for (std::size_t left = 3 * each; left != 0;) {
        const auto taken = outbox.take();
        ASSERT_LE(taken.size(), Outbox::capacity);
        for (const auto& entry : taken) ASSERT_EQ(number_of(entry.frame()), ++newest[entry.frame().system().value]);
        left -= taken.size();
        std::this_thread::yield();
    }
    for (auto& sender : senders) sender.join();
}

TEST(Outbox, ClosingHandsOverTheRestAndReleasesThoseWhoWait) {
    Outbox outbox;
    std::atomic<std::size_t> accepted{0};
    std::vector<std::thread> senders;
    for (int i = 0; i < 3; ++i)
        senders.emplace_back([&] {
            while (outbox.put(to, view(numbered(1))) != Outbox::Put::closed) ++accepted;
        });
    EXPECT_TRUE(eventually([&] { return accepted >= Outbox::capacity; }));  // from now on they wait
    const auto rest = outbox.close();
    for (auto& sender : senders) sender.join();
    EXPECT_EQ(rest.size(), accepted);  // what was accepted is handed over, and nothing is accepted later
    EXPECT_TRUE(outbox.take().empty());
    EXPECT_EQ(outbox.put(to, view(numbered(1))), Outbox::Put::closed);
}

}  // namespace
}  // namespace mavloom::feed
