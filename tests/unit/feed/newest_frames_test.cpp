// SPDX-License-Identifier: MIT
#include "mavloom/feed/newest_frames.hpp"
#include "mavloom/feed/vehicle.hpp"

#include <gtest/gtest.h>

#include "unit/feed/fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;

constexpr std::uint32_t heartbeat_id = 0, battery_id = 147, named_float_id = 251;
constexpr std::size_t battery_number_at = 32, name_at = 8;  // payload offsets

Bytes battery(std::uint8_t number) {
    Bytes payload(battery_number_at + 1);
    payload[battery_number_at] = number;
    return frame_of(battery_id, payload);
}
Bytes named_float(const std::string& name, std::uint8_t first_byte = 1) {
    Bytes payload(name_at + 10);
    payload[0] = first_byte;
    std::ranges::copy(name, payload.begin() + name_at);
    return frame_of(named_float_id, payload);
}

struct NewestFramesTest : ::testing::Test {
    void put(const Bytes& bytes, MonoTime now = {}) {
        const auto frame = view(bytes);
        newest.put(NewestFrames::key_of(frame, dialect::default_dialect().find(frame.id())), {}, frame, now);
    }
    // The bytes of what is found; empty for nothing.
    Bytes find(const dialect::Filter& filter = {}, const std::optional<message::Instance>& instance = {},
               MonoTime not_before = MonoTime::min()) const {
        const auto* found = newest.find(filter, instance, not_before);
        return found == nullptr ? Bytes() : found->bytes;
    }
    NewestFrames newest;
};

TEST_F(NewestFramesTest, EachSourceAndIdHasItsNewest) {
    put(numbered(1, 1));
    put(numbered(2, 2));
    put(numbered(3, 1));
    EXPECT_EQ(find(), numbered(3, 1));
    EXPECT_EQ(find(make_filter({.systems = {2}})), numbered(2, 2));
    EXPECT_EQ(find(make_filter({.messages = {"HEARTBEAT"}})), Bytes());
    put(frame_of(heartbeat_id));
    EXPECT_EQ(find(), frame_of(heartbeat_id));
    EXPECT_EQ(find(make_filter({.messages = {"ATTITUDE"}})), numbered(3, 1));
    EXPECT_TRUE(newest.has(MessageId{heartbeat_id}));
    EXPECT_FALSE(newest.has(MessageId{1}));
}

TEST_F(NewestFramesTest, SensorsOfOneMessageAreDistinguishedByNumberOrText) {
    put(battery(3));
    put(battery(7));
    put(named_float("left"));
    put(named_float("right"));
    put(named_float("left", 2));
    EXPECT_EQ(find({}, message::Instance(std::int64_t{3})), battery(3));
    EXPECT_EQ(find({}, message::Instance(std::int64_t{7})), battery(7));
    EXPECT_EQ(find({}, message::Instance(std::int64_t{8})), Bytes());
    EXPECT_EQ(find({}, message::Instance(std::string("right"))), named_float("right"));
    EXPECT_EQ(find({}, message::Instance(std::string("left"))), named_float("left", 2));
}

TEST_F(NewestFramesTest, WhatIsTooOldIsNotFound) {
    put(numbered(1), MonoTime{10s});
    EXPECT_EQ(find({}, {}, MonoTime{10s}), numbered(1));
    EXPECT_EQ(find({}, {}, MonoTime{10s + 1ns}), Bytes());
}

TEST_F(NewestFramesTest, ForgedSourcesFillTheTableAndNoMore) {
    std::uint64_t sources = 0;
    for (unsigned component = 1; component <= 65; ++component)
        for (unsigned system = 1; system <= 255; ++system, ++sources)
            put(frame_of(
                heartbeat_id, {},
                {SystemId{static_cast<std::uint8_t>(system)}, ComponentId{static_cast<std::uint8_t>(component)}}));
    ASSERT_GT(sources, NewestFrames::capacity);
    EXPECT_EQ(newest.not_kept(), sources - NewestFrames::capacity);
    EXPECT_EQ(find(make_filter({.systems = {255}, .components = {65}})), Bytes());
    put(frame_of(heartbeat_id, {9}));  // a source that has its place keeps it
    EXPECT_EQ(find(), frame_of(heartbeat_id, {9}));
}

TEST(Vehicle, OnlyTheHeartbeatOfAVehicleMakesOne) {
    const auto heartbeat = [](std::uint8_t type, std::uint8_t autopilot) {
        return frame_of(heartbeat_id, {0, 0, 0, 0, type, autopilot});
    };
    constexpr std::uint8_t quadrotor = 2, ground_station = 6, gimbal = 26, ardupilot = 3, no_autopilot = 8;
    EXPECT_TRUE(is_vehicle_heartbeat(view(heartbeat(quadrotor, ardupilot))));
    EXPECT_TRUE(is_vehicle_heartbeat(view(heartbeat(0, 0))));
    EXPECT_FALSE(is_vehicle_heartbeat(view(heartbeat(ground_station, ardupilot))));
    EXPECT_FALSE(is_vehicle_heartbeat(view(heartbeat(gimbal, 0))));
    EXPECT_TRUE(is_vehicle_heartbeat(view(heartbeat(quadrotor, no_autopilot))));  // home-made boards
    EXPECT_FALSE(is_vehicle_heartbeat(view(heartbeat(ground_station, no_autopilot))));
    EXPECT_FALSE(is_vehicle_heartbeat(view(heartbeat(0, no_autopilot))));
    EXPECT_FALSE(is_vehicle_heartbeat(view(numbered(1))));
}

}  // namespace
}  // namespace mavloom::feed
