// SPDX-License-Identifier: MIT
#include "mavloom/http/timer.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "support/eventually.hpp"

namespace mavloom::http {
namespace {

using namespace std::chrono_literals;

TEST(Timer, CallsUntilItIsDestroyed) {
    const auto thread = *Thread::start();
    std::atomic<int> calls = 0;
    {
        const Timer timer(thread, 1ms, [&] { ++calls; });
        EXPECT_TRUE(test::eventually([&] { return calls > 2; }));
    }
    const int at_end = calls;
    std::atomic<int> later = 0;
    const Timer other(thread, 1ms, [&] { ++later; });
    EXPECT_TRUE(test::eventually([&] { return later > 2; }));
    EXPECT_EQ(calls, at_end);
}

}  // namespace
}  // namespace mavloom::http
