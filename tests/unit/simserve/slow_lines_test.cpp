// SPDX-License-Identifier: MIT
#include "simserve/slow_lines.hpp"

#include <gtest/gtest.h>

namespace mavloom::simserve {
namespace {

using namespace std::chrono_literals;

constexpr LinkId radio{1}, fast{2};
constexpr std::uint32_t bytes_s = 5'760;  // 57,600 baud

TEST(SlowLines, HasNoRoomWhileItNeedsMoreThan200Milliseconds) {
    SlowLines lines;
    lines.open(radio, bytes_s);
    const MonoTime start{1h};
    lines.note_sent(radio, 1'152, start);  // 200 ms
    EXPECT_TRUE(lines.has_room(radio, start));
    lines.note_sent(radio, 576, start);  // 100 ms more
    EXPECT_FALSE(lines.has_room(radio, start + 99ms));
    EXPECT_TRUE(lines.has_room(radio, start + 101ms));
}

TEST(SlowLines, ARestEarnsNoCredit) {
    SlowLines lines;
    lines.open(radio, bytes_s);
    lines.note_sent(radio, 100, MonoTime{1s});
    lines.note_sent(radio, 1'200, MonoTime{1h});
    EXPECT_FALSE(lines.has_room(radio, MonoTime{1h}));
}

TEST(SlowLines, OtherLinksAlwaysHaveRoom) {
    SlowLines lines;
    lines.open(radio, bytes_s);
    lines.note_sent(radio, 10'000, MonoTime{});
    lines.note_sent(fast, 10'000'000, MonoTime{});
    EXPECT_TRUE(lines.has_room(fast, MonoTime{}));
    lines.close(radio);
    EXPECT_TRUE(lines.has_room(radio, MonoTime{}));
}

// Telemetry at three times the line's rate, and parameters of 37 bytes whenever there is room.
TEST(SlowLines, TelemetryThatExceedsTheLineLeavesBulkAShareAndNoMore) {
    for (const std::uint32_t rate : {120u, bytes_s, 92'160u}) {
        SlowLines lines;
        lines.open(radio, rate);
        std::size_t bulk = 0;
        MonoTime since{1h};
        Nanoseconds longest{};
        double telemetry = 0;
        constexpr auto step = 10ms;
        for (MonoTime now{1h}; now < MonoTime{1h} + 60s; now += step) {
            for (telemetry += 3 * rate * 0.01; telemetry > 40; telemetry -= 40) lines.note_sent(radio, 40, now);
            while (lines.has_room(radio, now)) {
                lines.note_sent(radio, 37, now);
                bulk += 37;
                longest = std::max(longest, now - since);
                since = now;
            }
        }
        const double share = static_cast<double>(bulk) / (60.0 * rate);
        EXPECT_GT(share, 0.15) << rate;
        EXPECT_LT(share, 0.7) << rate;
        EXPECT_LT(longest, 1500ms) << rate;
    }
}

TEST(SlowLines, ABurstEndsBulkForHalfASecondAtMost) {
    SlowLines lines;
    lines.open(radio, bytes_s);
    const MonoTime start{1h};
    lines.note_sent(radio, 1'000'000, start);
    EXPECT_FALSE(lines.has_room(radio, start + 499ms));
    EXPECT_TRUE(lines.has_room(radio, start + 501ms));
    lines.note_sent(radio, 1'200, start + 501ms);
    EXPECT_FALSE(lines.has_room(radio, start + 502ms));
}

}  // namespace
}  // namespace mavloom::simserve
