// SPDX-License-Identifier: MIT
#include "mavloom/net/resolver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace mavloom::net {
namespace {

using std::chrono::seconds;

TEST(Resolver, FindsLocalhostIpv4First) {
    const auto addresses = look_up("localhost", 14550);
    ASSERT_TRUE(addresses);
    EXPECT_EQ(addresses->front().text(), "127.0.0.1:14550");
}

TEST(Resolver, AHostThatDoesNotExistIsNamed) {
    const auto addresses = look_up("no-such-host.invalid", 1);
    ASSERT_FALSE(addresses);
    EXPECT_THAT(addresses.error().text, ::testing::HasSubstr("no-such-host.invalid"));
}

TEST(Resolver, AnswersOnAnotherThreadAndNotifies) {
    std::atomic<int> notified{0};
    Resolver resolver([&] { ++notified; });
    const auto first = resolver.ask("localhost", 1), second = resolver.ask("127.0.0.1", 2);
    const auto waited = resolver.wait(second, seconds(10));
    ASSERT_TRUE(waited);
    ASSERT_TRUE(*waited);
    EXPECT_EQ((*waited)->front().text(), "127.0.0.1:2");
    const auto taken = resolver.take();
    ASSERT_TRUE(taken);
    EXPECT_EQ(taken->ticket, first);
    EXPECT_FALSE(resolver.take());
    while (notified != 2) std::this_thread::yield();
}

TEST(Resolver, NotifyMayCollectTheAnswer) {
    std::atomic<Resolver*> self{nullptr};
    std::atomic<int> collected{0};
    Resolver resolver([&] { collected += self.load()->take() ? 1 : 0; });
    self = &resolver;
    (void)resolver.ask("127.0.0.1", 1);
    while (collected != 1) std::this_thread::yield();
}

TEST(Resolver, GivesUpWaitingAtTheLimit) {
    Resolver resolver([] {});
    EXPECT_FALSE(resolver.wait(77, std::chrono::milliseconds(1)));
}

TEST(Resolver, MayGoAtAnyMoment) {
    for (int i = 0; i < 50; ++i) {
        auto notified = std::make_shared<std::atomic<int>>(0);
        Resolver resolver([notified] { ++*notified; });
        (void)resolver.ask("localhost", 1);
    }
}

}  // namespace
}  // namespace mavloom::net
