// SPDX-License-Identifier: MIT
#include "mavloom/observe/sender_streams.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/radio_status.hpp"
#include "mavloom/msg/system_time.hpp"
#include "unit/observe/fixture.hpp"

namespace mavloom::observe {
namespace {

using namespace testing;

struct SenderStreamsTest : ::testing::Test {
    // A frame with this number; other contents are other bytes.
    void hear(int sequence, LinkId link = one, std::uint32_t content = 0) {
        auto bytes = frame_of(
            msg::Attitude{.time_boot_ms = content == 0 ? static_cast<std::uint32_t>(sequence) : content});
        bytes[4] = static_cast<std::uint8_t>(sequence);
        streams.add({.frame = view(bytes), .link = link, .link_name = "a", .time = wall(at), .now = mono(at)});
        at += 10ms;
    }
    void hear_time(int sequence, LinkId link, std::uint64_t unix_us, std::uint32_t boot_ms) {
        auto bytes = frame_of(msg::SystemTime{.time_unix_usec = unix_us, .time_boot_ms = boot_ms});
        bytes[4] = static_cast<std::uint8_t>(sequence);
        streams.add({.frame = view(bytes), .link = link, .link_name = "a", .time = wall(at), .now = mono(at)});
        at += 10ms;
    }
    [[nodiscard]] SenderStream its() const { return streams.all().front(); }

    static constexpr LinkId one{1}, other{2}, third{3};
    static constexpr std::uint64_t utc = 1'700'000'000'000'000;
    Nanoseconds at{};
    SenderStreams streams;
};

TEST_F(SenderStreamsTest, ASequenceThatWrapsIsWhole) {
    for (int i = 0; i < 1000; ++i) hear(i);
    EXPECT_EQ(its().frames, 1000u);
    EXPECT_EQ(its().missing + its().station_lost + its().copies_on_link + its().conflicts_on_link, 0u);
    EXPECT_TRUE(its().has_sequence);
}

TEST_F(SenderStreamsTest, CopiesOfAnotherLinkAreKnownByTheirBytes) {
    for (int i = 0; i < 300; ++i) {
        hear(i);
        hear(i, other);
    }
    EXPECT_EQ(its().copies_across, 300u);
    EXPECT_EQ(its().copies_on_link + its().conflicts_across + its().conflicts_on_link + its().missing, 0u);
    // QGroundControl's rule: the second of two equal numbers is 255 lost frames.
    EXPECT_EQ(its().station_lost, 300u * 255);
}

TEST_F(SenderStreamsTest, ALinkThatLagsHasCopiesToo) {
    for (int i = 0; i < 300; ++i) {
        hear(i);
        if (i >= 40) hear(i - 40, other);
    }
    EXPECT_EQ(its().copies_across, 260u);
    EXPECT_EQ(its().conflicts_across + its().missing, 0u);
}

// A copy, and a port with numbers of its own, three milliseconds later.
TEST_F(SenderStreamsTest, OneClockAtThreePortsContradictsNothing) {
    for (std::uint32_t s = 0; s < 10; ++s) {
        hear_time(static_cast<int>(20 * s), one, utc + s * 1'000'000 + 400, 1000 + 1000 * s);
        hear_time(static_cast<int>(20 * s), other, utc + s * 1'000'000 + 400, 1000 + 1000 * s);
        hear_time(static_cast<int>(20 * s), third, utc + s * 1'000'000 + 3'500, 1003 + 1000 * s);
    }
    EXPECT_EQ(its().clocks_across, 0u);
}

TEST_F(SenderStreamsTest, TwoClocksAreSeenByTheirTimesOfDay) {
    for (std::uint32_t s = 0; s < 4; ++s) {
        hear_time(static_cast<int>(s), one, utc + s * 1'000'000, 1000 * s);
        hear_time(static_cast<int>(s), other, utc + s * 1'000'000 + 5'000, 1000 * s);
    }
    EXPECT_EQ(its().clocks_across, 6u) << "all but the first of each link";
    hear_time(31, one, 0, 5000);
    EXPECT_EQ(its().clocks_across, 6u) << "no time of day";
}

TEST_F(SenderStreamsTest, AClockThatIsSetOrStartsAgainContradictsNothing) {
    for (const std::uint64_t set_by : {0, 0, 50'000, 50'000, 50'000}) {
        hear_time(0, one, utc + set_by, 1000);
        hear_time(0, other, utc + set_by, 1000);
    }
    hear_time(0, other, utc + 60'000, 0);  // and comes by one link only
    at += 2s;
    hear_time(0, other, utc + 2'060'000, 2000);
    EXPECT_EQ(its().clocks_across, 0u);
}

// PX4's simulation at five times real time: time_boot_ms is that of the flight, time_unix_usec is not.
TEST_F(SenderStreamsTest, AClockThatIsFasterThanRealTimeContradictsNothing) {
    for (std::uint32_t s = 0; s < 10; ++s) {
        hear_time(static_cast<int>(s), one, utc + s * 200'000, 1000 * s);
        hear_time(static_cast<int>(s), other, utc + s * 200'000 + 100'000, 1000 * s + 500);
    }
    EXPECT_EQ(its().clocks_across, 0u);
}

TEST_F(SenderStreamsTest, TimesOfDayBeyondAllMeasureAreNoClock) {
    for (const std::uint64_t unix_us : {UINT64_MAX, std::uint64_t{INT64_MAX} / 1000, std::uint64_t{INT64_MAX} / 2000}) {
        hear_time(1, one, 1, UINT32_MAX);
        hear_time(2, other, unix_us, 0);
        hear_time(3, other, unix_us, 0);
    }
    EXPECT_EQ(its().clocks_across, 1u) << "of the last one, which is in 2116";
}

TEST_F(SenderStreamsTest, CopiesOnOneLink) {
    for (int i = 0; i < 100; ++i) {
        hear(i);
        hear(i);
    }
    EXPECT_EQ(its().copies_on_link, 100u);
}

TEST_F(SenderStreamsTest, TwoSendersOnOneLinkConflict) {
    for (int i = 0; i < 300; ++i) {
        hear(i, one, 1000 + static_cast<std::uint32_t>(i));
        hear(i + 200, one, 5000 + static_cast<std::uint32_t>(i));
    }
    EXPECT_GT(its().conflicts_on_link, 100u);
}

// Also if their numbers never meet.
TEST_F(SenderStreamsTest, LinksWithSequencesOfTheirOwn) {
    for (const int distance : {0, 100, 128, 200}) {
        streams = {};
        for (int i = 0; i < 50; ++i) {
            hear(i, one, 1000 + static_cast<std::uint32_t>(i));
            hear(i + distance, other, 5000 + static_cast<std::uint32_t>(i));
        }
        EXPECT_GT(its().conflicts_across, 40u) << distance;
        EXPECT_EQ(its().copies_across, 0u) << distance;
    }
}

TEST_F(SenderStreamsTest, FramesSplitOverLinksAreWholeTogether) {
    for (int i = 0; i < 600; ++i) hear(i, i % 2 == 0 ? one : other);
    EXPECT_EQ(its().missing + its().conflicts_across, 0u);
    EXPECT_EQ(its().links.at(one), 300u);
}

TEST_F(SenderStreamsTest, LateFramesAreNotMissing) {
    for (const int i : {0, 1, 3, 2, 4, 7, 5, 6, 8}) hear(i);
    EXPECT_EQ(its().missing, 0u);
    hear(12);
    EXPECT_EQ(its().missing, 3u);
}

TEST_F(SenderStreamsTest, ASequenceThatBeginsAgainIsNotMissing) {
    for (int i = 0; i < 200; ++i) hear(i, one, 1000 + static_cast<std::uint32_t>(i));
    for (int i = 150; i < 400; ++i) hear(i, one, 9000 + static_cast<std::uint32_t>(i));
    EXPECT_EQ(its().missing, 0u);
    EXPECT_LT(its().conflicts_on_link, 10u);
}

TEST_F(SenderStreamsTest, ASenderThatDoesNotCount) {
    for (std::uint32_t i = 1; i < 20; ++i) hear(0, one, i);
    EXPECT_FALSE(its().has_sequence);
}

// 20 of 100 frames a second, evenly: a stream of 20 Hz is left out. In bursts: a radio.
TEST_F(SenderStreamsTest, RegularGapsAreNoLossByChance) {
    for (int i = 0; i < 1000; ++i) {
        if (i % 5 == 3) at += 10ms;
        else hear(i);
    }
    EXPECT_TRUE(its().has_regular_gaps());
    EXPECT_NEAR(its().station_loss(), 0.2, 0.01);

    streams = {};
    for (int i = 0; i < 1000; ++i) {
        if (i % 100 < 20 && i > 100) at += 10ms;
        else hear(i);
    }
    EXPECT_FALSE(its().has_regular_gaps());
}

TEST_F(SenderStreamsTest, HeartbeatsOfTwoKinds) {
    for (std::uint8_t i = 0; i < 6; ++i) {
        const auto bytes = frame_of(msg::Heartbeat{.type = static_cast<std::uint8_t>(i % 2 == 0 ? 2 : 1)});
        streams.add({.frame = view(bytes), .link = one, .link_name = "a", .time = wall(at), .now = mono(at)});
    }
    EXPECT_EQ(its().heartbeats, 6u);
    EXPECT_EQ(its().changes_of_kind, 5u);
}

TEST_F(SenderStreamsTest, RadiosMaySendUnsigned) {
    hear(0);
    const auto bytes = frame_of(msg::RadioStatus{});
    streams.add({.frame = view(bytes), .link = one, .link_name = "a", .time = wall(at), .now = mono(at)});
    EXPECT_EQ(its().unsigned_frames, 1u);
    EXPECT_EQ(its().frames, 2u);
}

TEST_F(SenderStreamsTest, InventedSendersAreBounded) {
    const auto bytes = frame_of(msg::Heartbeat{});
    for (int i = 0; i < 2000; ++i) {
        auto frame = bytes;
        frame[5] = static_cast<std::uint8_t>(i >> 8);
        frame[6] = static_cast<std::uint8_t>(i);
        streams.add({.frame = view(frame), .link = one, .link_name = "a", .time = wall(at), .now = mono(at)});
    }
    EXPECT_EQ(streams.all().size(), SenderStreams::max_senders);
    EXPECT_EQ(streams.unlisted(), 2000 - SenderStreams::max_senders);
}

}  // namespace
}  // namespace mavloom::observe
