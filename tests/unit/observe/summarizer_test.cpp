// SPDX-License-Identifier: MIT
// What tests/system/program/test_info.py does not see: limits, other encodings, positions that jump.
#include "mavloom/observe/summarizer.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "mavloom/msg/autopilot_version.hpp"
#include "mavloom/msg/param_value.hpp"
#include "mavloom/msg/statustext.hpp"
#include "unit/observe/fixture.hpp"

namespace mavloom::observe {

using namespace testing;

namespace {

struct SummarizerTest : ::testing::Test {
    template <class Message>
    void add(const Message& message, Nanoseconds at = 0s, Source source = vehicle) {
        const auto bytes = frame_of(message, source);
        sut.add(view(bytes), dialect::default_dialect().wire_table().find(Message::id), wall(at));
    }
    void add_parameter(float value, std::uint8_t type, Nanoseconds at) {
        msg::ParamValue message{.param_value = value, .param_type = type};
        std::ranges::copy(std::string_view("NAME"), message.param_id.begin());
        add(message, at);
    }
    [[nodiscard]] SenderSummary sender(std::size_t place = 0) const { return sut.summary().senders.at(place); }

    Summarizer sut{dialect::default_dialect(), Summarizer::Tracks::yes};
};

constexpr std::uint8_t uint32 = 5, real32 = 9;                     // MAV_PARAM_TYPE
constexpr std::uint8_t ardupilot = 3, px4 = 12, no_autopilot = 8;  // MAV_AUTOPILOT

}  // namespace

TEST_F(SummarizerTest, NothingIsAnEmptySummary) {
    const auto all = sut.summary();
    EXPECT_FALSE(all.begin);
    EXPECT_FALSE(all.end);
    EXPECT_TRUE(all.senders.empty());
    EXPECT_EQ(all.duration, 0s);
}

// MAVLink guide, "Parameter Encoding": PX4 sends the bytes of an integer, ArduPilot a float of its value.
TEST_F(SummarizerTest, IntegersOfParametersAreReadAsTheAutopilotSendsThem) {
    add(msg::Heartbeat{.autopilot = px4});
    add_parameter(std::bit_cast<float>(7u), uint32, 1s);
    add_parameter(std::bit_cast<float>(4'000'000'000u), uint32, 2s);
    add(msg::Heartbeat{.autopilot = ardupilot}, 3s);
    add_parameter(12.0F, uint32, 4s);
    add_parameter(0.15F, real32, 5s);
    add_parameter(0.15F, real32, 6s);

    const auto changes = sut.summary().parameters;
    ASSERT_EQ(changes.size(), 3u);
    EXPECT_EQ(changes[0].name, "NAME");
    EXPECT_EQ(changes[0].before, 7);
    EXPECT_EQ(changes[0].after, 4'000'000'000);
    EXPECT_EQ(changes[1].after, 12);
    EXPECT_EQ(changes[2].after, 0.15);  // not 0.15000000596
    EXPECT_EQ(changes[2].when.at, 5s);
}

TEST_F(SummarizerTest, APositionThatJumpsIsNoWayAndInterruptsTheTrack) {
    const auto at = [&](Nanoseconds time, double north_km) {
        add(msg::GlobalPositionInt{.lat = 470'000'000 + static_cast<int>(north_km * 1e7 / 111.195), .lon = 80'000'000},
            time);
    };
    at(0s, 0);
    at(10s, 0.5);
    at(11s, 500);
    at(21s, 500.5);

    const auto journey = sender().journey;
    EXPECT_NEAR(journey.distance_m, 1000, 5);
    ASSERT_EQ(journey.track.size(), 4u);
    EXPECT_TRUE(journey.track[0].begins);
    EXPECT_FALSE(journey.track[1].begins);
    EXPECT_TRUE(journey.track[2].begins);
    EXPECT_FALSE(journey.track[3].begins);
    EXPECT_TRUE(sender().is_vehicle);
}

TEST_F(SummarizerTest, WithoutGlobalPositionsTheGpsIsTheWay) {
    add(msg::GpsRawInt{.fix_type = 2, .lat = 1, .lon = 1}, 0s);  // no 3D fix
    add(msg::GpsRawInt{.fix_type = 3, .lat = 470'000'000, .lon = 80'000'000, .alt = 500'000, .vel = 1'200}, 1s);
    add(msg::GpsRawInt{.fix_type = 3, .lat = 470'000'000, .lon = 80'000'000, .alt = 400'000, .vel = UINT16_MAX}, 2s);

    const auto journey = sender().journey;
    EXPECT_EQ(journey.first->when.at, 1s);
    EXPECT_EQ(journey.highest_alt_m, 500);
    EXPECT_EQ(journey.highest_speed_m_s, 12);
    EXPECT_FALSE(journey.highest_relative_alt_m);
}

TEST_F(SummarizerTest, ALongTrackIsThinnedOut) {
    for (int i = 0; i < 200'000; ++i)
        add(msg::GlobalPositionInt{.lat = 470'000'000 + 100 * i, .lon = 80'000'000}, i * 250ms);

    const auto track = sender().journey.track;
    EXPECT_LE(track.size(), 65'536u);
    EXPECT_GE(track.size(), 32'768u);
    EXPECT_EQ(track.front().lat_deg_e7, 470'000'000);
    EXPECT_GT(track.back().lat_deg_e7, 470'000'000 + 100 * 199'900);
    EXPECT_EQ(std::ranges::count(track, true, &TrackPoint::begins), 1);
}

TEST_F(SummarizerTest, AGroundStationIsNoVehicle) {
    add(msg::Heartbeat{.type = 6, .autopilot = no_autopilot}, 0s, station);
    EXPECT_FALSE(sender().is_vehicle);
    EXPECT_TRUE(sender().has_heartbeat);
}

// FIRMWARE_VERSION_TYPE; ArduPilot's text of eight digits, and PX4's number.
TEST_F(SummarizerTest, FirmwareIsPrintedAsPeopleWriteIt) {
    add(msg::AutopilotVersion{.flight_sw_version = 0x040603ff,
                              .flight_custom_version = {'3', 'f', 'c', '7', '0', '1', '1', 'a'}});
    EXPECT_EQ(sender().firmware->text(), "4.6.3");
    EXPECT_EQ(sender().firmware->git, "3fc7011a");
    add(msg::AutopilotVersion{.flight_sw_version = 0x010f00c0,
                              .flight_custom_version = {0, 0, 0, 0xcd, 0x37, 0xc6, 0x59, 0xbb}});
    EXPECT_EQ(sender().firmware->text(), "1.15.0 rc");
    EXPECT_EQ(sender().firmware->git, "bb59c637cd");
}

TEST_F(SummarizerTest, TooManySendersAreCountedAndNotListed) {
    for (int system = 1; system <= 5; ++system)
        for (int component = 0; component < 256; ++component)
            add(msg::Heartbeat{}, 0s,
                {SystemId{static_cast<std::uint8_t>(system)}, ComponentId{static_cast<std::uint8_t>(component)}});

    const auto all = sut.summary();
    EXPECT_EQ(all.senders.size(), Summarizer::max_senders);
    EXPECT_EQ(all.frames, 5 * 256u);
    EXPECT_EQ(all.unlisted_frames, 5 * 256 - Summarizer::max_senders);
}

TEST_F(SummarizerTest, ListsEndAndCountWhatFollows) {
    for (std::uint32_t i = 0; i < 1500; ++i) {
        add(msg::Heartbeat{.autopilot = px4, .custom_mode = i}, std::chrono::milliseconds(i));
        msg::Statustext text{.severity = 3};
        std::ranges::copy(fmt::format("text {}", i), text.text.begin());
        add(text, std::chrono::milliseconds(i));
    }
    const auto all = sut.summary();
    EXPECT_EQ(all.senders[0].modes.size(), Summarizer::max_entries);
    EXPECT_EQ(all.texts.size(), Summarizer::max_entries);
    EXPECT_EQ(all.unlisted_entries, 2 * 500u);
}

}  // namespace mavloom::observe
