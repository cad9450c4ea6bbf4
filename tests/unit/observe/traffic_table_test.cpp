// SPDX-License-Identifier: MIT
#include "mavloom/observe/traffic_table.hpp"

#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "support/golden_frames.hpp"

namespace mavloom::observe {

using namespace std::chrono_literals;

namespace {
const auto heartbeat = wire::FrameView::unchecked(test::heartbeat_v2);
const auto attitude = wire::FrameView::unchecked(test::attitude_v1);
WallTime at(Nanoseconds t) { return WallTime{t}; }
}  // namespace

TEST(TrafficTable, TakesTheRateFromMeasuredTime) {
    TrafficTable sut;
    for (const auto t : {100ms, 150ms, 300ms, 350ms, 600ms}) sut.add(LinkId{1}, heartbeat, at(t));

    const auto rows = sut.sorted();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].count, 5u);
    EXPECT_EQ(rows[0].bytes, 5 * 21u);
    EXPECT_DOUBLE_EQ(rows[0].rate_hz(), 8.0);  // 4 gaps in half a second
    EXPECT_EQ(rows[0].shortest_gap, 50ms);
    EXPECT_EQ(rows[0].longest_gap, 250ms);
    EXPECT_EQ(rows[0].mean_gap(), 125ms);
}

TEST(TrafficTable, TheRecentRateForgetsWhatIsTenSecondsOld) {
    TrafficTable sut;
    const auto rate = [&](Nanoseconds now) { return sut.sorted()[0].recent_rate_hz(at(now)); };
    const auto hear = [&](Nanoseconds from, Nanoseconds to, Nanoseconds gap) {
        for (auto t = from; t < to; t += gap) sut.add(LinkId{1}, heartbeat, at(t));
    };
    hear(0s, 1s, 100ms);
    EXPECT_DOUBLE_EQ(rate(1s), 10);
    hear(1s, 100s, 100ms);
    EXPECT_DOUBLE_EQ(rate(100s), 10);
    hear(100s, 111s, 1s);
    EXPECT_DOUBLE_EQ(rate(111s), 1);
    EXPECT_DOUBLE_EQ(rate(120s), 1);
    EXPECT_DOUBLE_EQ(rate(130s), 0.05);  // silent for 20 s
    hear(3600s, 3610s, 20ms);
    EXPECT_DOUBLE_EQ(rate(3610s), 50);
    sut.add(LinkId{1}, heartbeat, at(3670s));
    EXPECT_NEAR(rate(3670s), 1. / 60, 1e-3);
}

TEST(TrafficTable, ABurstIsNoRate) {
    TrafficTable sut;
    for (auto t = 0us; t < 200us; t += 20us) sut.add(LinkId{1}, heartbeat, at(t));
    const auto rate = [&](Nanoseconds now) { return sut.sorted()[0].recent_rate_hz(at(now)); };

    EXPECT_NEAR(rate(1s), 9, 0.01);
    EXPECT_NEAR(rate(9s), 1, 0.01);
    for (int i = 0; i < 2; ++i) sut.add(LinkId{2}, heartbeat, at(5s));  // of one datagram
    EXPECT_NEAR(sut.sorted()[1].recent_rate_hz(at(7s)), 0.5, 0.01);
}

TEST(TrafficTable, TheRecentRateOutlivesAClockThatIsSetBack) {
    TrafficTable sut;
    for (auto t = 1000s; t < 1010s; t += 1s) sut.add(LinkId{1}, heartbeat, at(t));
    for (auto t = 0s; t < 7s; t += 1s) sut.add(LinkId{1}, heartbeat, at(t));

    EXPECT_DOUBLE_EQ(sut.sorted()[0].recent_rate_hz(at(7s)), 1);
}

TEST(TrafficTable, OneFrameHasNoRate) {
    TrafficTable sut;
    sut.add(LinkId{1}, heartbeat, at(1s));

    EXPECT_EQ(sut.sorted()[0].rate_hz(), 0);
    EXPECT_EQ(sut.sorted()[0].recent_rate_hz(at(2s)), 0);
    EXPECT_EQ(sut.sorted()[0].mean_gap(), 0ns);
}

TEST(TrafficTable, SortsByLinkSourceAndId) {
    TrafficTable sut;
    sut.add(LinkId{2}, heartbeat, at(0s));
    sut.add(LinkId{1}, attitude, at(0s));
    sut.add(LinkId{1}, heartbeat, at(0s));

    const auto rows = sut.sorted();
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(rows[0].id, MessageId{0});
    EXPECT_EQ(rows[1].id, MessageId{30});
    EXPECT_EQ(rows[2].link, LinkId{2});
}

TEST(TrafficTable, RowsOfLinksThatAreGoneAreGivenBack) {
    TrafficTable sut;
    sut.add(LinkId{1}, heartbeat, at(0s));
    for (int i = 0; i < 3; ++i) sut.add(LinkId{2}, heartbeat, at(0s));
    sut.add(LinkId{2}, attitude, at(0s));

    sut.forget_links_unless([](LinkId link) { return link == LinkId{1}; });

    ASSERT_EQ(sut.sorted().size(), 1u);
    EXPECT_EQ(sut.sorted()[0].link, LinkId{1});
    sut.add(LinkId{2}, heartbeat, at(1s));
    ASSERT_EQ(sut.sorted().size(), 2u);
    EXPECT_EQ(sut.sorted()[1].count, 1u) << "nothing is left of the row that went";
}

TEST(TrafficTable, ManyRowsInTurnAreCountedEach) {
    TrafficTable sut;
    auto bytes = test::heartbeat_v2;
    for (unsigned turn = 0; turn < 3; ++turn)
        for (unsigned link = 1; link <= 8; ++link)
            for (unsigned component = 0; component < 256; ++component) {
                bytes[6] = static_cast<std::uint8_t>(component);
                sut.add(LinkId{link}, wire::FrameView::unchecked(bytes), at(turn * 1s));
            }

    ASSERT_EQ(sut.rows().size(), 8 * 256u);
    for (const auto& row : sut.rows()) EXPECT_EQ(row.count, 3u);
}

TEST(TrafficTable, RowsThatComeAgainAtOnceAreCountedEach) {
    TrafficTable sut;
    auto bytes = test::heartbeat_v2;
    for (unsigned component = 0; component < 256; ++component)
        for (unsigned again = 0; again < 4; ++again) {
            bytes[6] = static_cast<std::uint8_t>(component);
            sut.add(LinkId{1}, wire::FrameView::unchecked(bytes), at(0s));
            sut.add(LinkId{1}, attitude, at(0s));
        }

    const auto rows = sut.sorted();
    ASSERT_EQ(rows.size(), 257u);
    for (const auto& row : rows) EXPECT_EQ(row.count, row.id.value == 0 ? 4u : 1024u);
}

TEST(TrafficTable, BoundsItsRowsAndCountsTheRest) {
    TrafficTable sut;
    auto bytes = test::heartbeat_v2;
    for (unsigned link = 0; link < 2; ++link)
        for (unsigned source = 0; source < 65536; ++source) {
            bytes[5] = static_cast<std::uint8_t>(source);
            bytes[6] = static_cast<std::uint8_t>(source >> 8);
            sut.add(LinkId{link}, wire::FrameView::unchecked(bytes), at(0s));
        }

    EXPECT_EQ(sut.sorted().size(), TrafficTable::max_rows);
    EXPECT_EQ(sut.unlisted(), 2 * 65536u - TrafficTable::max_rows);
}

TEST(TrafficTable, ACopyInPiecesHasEachRowOnceWhileRowsComeAndGo) {
    TrafficTable sut;
    for (std::uint32_t link = 1; link <= 100; ++link) sut.add(LinkId{link}, heartbeat, at(1s));
    std::vector<TrafficRow> copied;

    std::size_t next = sut.copy_rows(0, 40, copied);
    sut.forget_links_unless([](LinkId link) { return link.value % 2 == 0; });
    for (std::uint32_t link = 101; link <= 120; ++link) sut.add(LinkId{link}, heartbeat, at(2s));
    while (next != TrafficTable::end) next = sut.copy_rows(next, 40, copied);

    std::map<std::uint32_t, int> times;
    for (const auto& row : copied) ++times[row.link.value];
    for (std::uint32_t link = 2; link <= 100; link += 2) EXPECT_EQ(times[link], 1) << link;
    for (const auto& [link, count] : times) EXPECT_EQ(count, 1) << link;
    EXPECT_EQ(sut.rows().size(), 70u);
}

TEST(TrafficTable, ACopyOfAnEmptyTableEndsAtOnce) {
    std::vector<TrafficRow> copied;
    EXPECT_EQ(TrafficTable().copy_rows(0, 10, copied), TrafficTable::end);
    EXPECT_TRUE(copied.empty());
}

}  // namespace mavloom::observe
