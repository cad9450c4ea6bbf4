// SPDX-License-Identifier: MIT
#include "mavloom/shm/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace mavloom::shm {
namespace {

using namespace std::chrono_literals;

MonoTime soon() { return mono_now() + 60s; }

TEST(BoundedQueue, RefusesOneMoreThanItsCapacityAndLeavesItToTheCaller) {
    BoundedQueue<int> queue(3);
    for (int i = 0; i < 3; ++i) {
        auto object = std::make_unique<int>(i);
        ASSERT_TRUE(queue.try_push(object));
        EXPECT_EQ(object, nullptr);
    }
    auto fourth = std::make_unique<int>(3);
    EXPECT_FALSE(queue.try_push(fourth));
    ASSERT_NE(fourth, nullptr);
    EXPECT_EQ(*fourth, 3);
    EXPECT_EQ(queue.size(), 3u);
    EXPECT_EQ(*queue.try_pop(), 0);
    EXPECT_TRUE(queue.try_push(fourth));
    for (int i = 1; i < 4; ++i) EXPECT_EQ(*queue.try_pop(), i);
    EXPECT_EQ(queue.try_pop(), nullptr);
}

TEST(BoundedQueue, DestroysWhatIsLeft) {
    auto shared = std::make_shared<int>(1);
    {
        BoundedQueue<std::shared_ptr<int>> queue(4);
        auto object = std::make_unique<std::shared_ptr<int>>(shared);
        ASSERT_TRUE(queue.try_push(object));
        EXPECT_EQ(shared.use_count(), 2);
    }
    EXPECT_EQ(shared.use_count(), 1);
}

TEST(BoundedQueue, PopEndsAtItsDeadline) {
    BoundedQueue<int> queue(1);
    EXPECT_EQ(queue.pop(mono_now()), nullptr);
    EXPECT_EQ(queue.pop(mono_now() + 5ms), nullptr);
}

TEST(BoundedQueue, TwoThreadsHandOverEverythingInOrder) {
    constexpr int count = 100'000;
    BoundedQueue<int> queue(64);
    std::thread producer([&] {
        for (int i = 0; i < count; ++i) {
            auto object = std::make_unique<int>(i);
            while (!queue.try_push(object)) std::this_thread::yield();
        }
    });
    for (int i = 0; i < count; ++i) {
        const auto object = queue.pop(soon());
        ASSERT_NE(object, nullptr);
        ASSERT_EQ(*object, i);
    }
    producer.join();
    EXPECT_EQ(queue.try_pop(), nullptr);
}

}  // namespace
}  // namespace mavloom::shm
