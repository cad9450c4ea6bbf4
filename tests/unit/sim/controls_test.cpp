// SPDX-License-Identifier: MIT
// Sticks and set-points of clients. Sources: MAVLink common.xml; masks and frames as MAVSDK and pymavlink send them.
#include <gmock/gmock.h>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/follow_target.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/manual_control.hpp"
#include "mavloom/msg/mission_item.hpp"
#include "mavloom/msg/rc_channels_override.hpp"
#include "mavloom/msg/set_actuator_control_target.hpp"
#include "mavloom/msg/set_attitude_target.hpp"
#include "mavloom/msg/set_gps_global_origin.hpp"
#include "mavloom/msg/set_home_position.hpp"
#include "mavloom/msg/set_position_target_global_int.hpp"
#include "mavloom/msg/set_position_target_local_ned.hpp"
#include "unit/sim/bench.hpp"

namespace mavloom::sim {
namespace {

using namespace test;
using namespace std::chrono_literals;

constexpr std::uint16_t position_mask = 0x9f8, velocity_mask = 0x9c7, body_velocity_mask = 0x5c7,
                        acceleration_mask = 0xc3f, nothing_mask = 0xfff;
constexpr std::uint8_t local_ned = 1, local_offset = 7, body_ned = 8, body_offset = 9;

msg::SetPositionTargetLocalNed local_target(std::uint16_t mask, std::uint8_t frame = local_ned) {
    return {.target_system = 1, .target_component = 1, .coordinate_frame = frame, .type_mask = mask};
}

// Repeats a message 20 times a second.
template <class Message>
void repeat(Bench& bench, const Message& message, double seconds) {
    for (double passed = 0; passed < seconds; passed += 0.05) {
        bench.rig.send(message);
        bench.rig.run(50ms);
    }
}
// Flies in Offboard, or in Guided, by this message.
template <class Message>
[[nodiscard]] bool begin(Bench& bench, const Message& message) {
    if (!bench.fly()) return false;
    bench.rig.send(message);
    return bench.state().autopilot == Autopilot::ardupilot || bench.command(176, {1, 6}) == accepted;
}
double speed(const Bench& bench) { return std::hypot(bench.state().north_m_s, bench.state().east_m_s); }

// --- Set-points

TEST(Controls, OffboardNeedsSetpointsFirst) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(176, {1, 6}), temporarily_rejected);
    bench.rig.send(local_target(velocity_mask));
    EXPECT_EQ(bench.command(176, {1, 6}), accepted);
    repeat(bench, local_target(velocity_mask), 3);
    EXPECT_EQ(bench.state().mode, "Offboard");
    bench.rig.run(3.0);
    EXPECT_NE(bench.state().mode, "Offboard") << "set-points ended";
}

TEST(Controls, FollowsAVelocity) {
    Bench bench;
    auto target = local_target(velocity_mask);
    target.vx = 3;
    target.vy = -2;
    target.yaw = 1;
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 6);
    EXPECT_NEAR(bench.state().north_m_s, 3, 0.2);
    EXPECT_NEAR(bench.state().east_m_s, -2, 0.2);
    EXPECT_NEAR(bench.state().heading_deg, 57.3, 3);
}

TEST(Controls, TurnsAVelocityOfTheBodyFrame) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command_int(192, 6, {-1, 1, 0, 1.5708f}, 473'977'420, 85'455'940, 10), accepted);
    bench.rig.run(10.0);
    auto target = local_target(body_velocity_mask, body_ned);
    target.vx = 2;
    bench.rig.send(target);
    ASSERT_EQ(bench.command(176, {1, 6}), accepted);
    repeat(bench, target, 6);
    EXPECT_NEAR(bench.state().east_m_s, 2, 0.2) << "forward is east";
    EXPECT_NEAR(bench.state().north_m_s, 0, 0.2);
}

TEST(Controls, FollowsAPosition) {
    Bench bench;
    auto target = local_target(position_mask);
    target.x = 10;
    target.y = 5;
    target.z = -12;
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 15);
    const auto position = bench.rig.last<msg::LocalPositionNed>();
    ASSERT_TRUE(position);
    EXPECT_NEAR(position->x, 10, 0.5);
    EXPECT_NEAR(position->y, 5, 0.5);
    EXPECT_NEAR(position->z, -12, 0.5);
}

TEST(Controls, FollowsAGlobalPositionInEveryFrame) {
    for (const auto& [frame, altitude] : {std::pair{5, home_altitude + 12}, std::pair{6, 12.f}, std::pair{11, 12.f}}) {
        Bench bench;
        const msg::SetPositionTargetGlobalInt target{.target_system = 1,
                                                     .coordinate_frame = static_cast<std::uint8_t>(frame),
                                                     .type_mask = position_mask,
                                                     .lat_int = 473'978'000,
                                                     .lon_int = 85'457'000,
                                                     .alt = altitude};
        ASSERT_TRUE(begin(bench, target));
        repeat(bench, target, 15);
        EXPECT_NEAR(bench.state().latitude_deg, 47.3978, 5e-6) << frame;
        EXPECT_NEAR(bench.state().longitude_deg, 8.5457, 5e-6);
        EXPECT_NEAR(bench.state().relative_altitude_m, 12, 0.5);
    }
}

TEST(Controls, FollowsAnAcceleration) {
    Bench bench;
    auto target = local_target(acceleration_mask);
    target.afx = 1;
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 3);
    EXPECT_GT(bench.state().north_m_s, 1);
    EXPECT_NEAR(bench.state().east_m_s, 0, 0.3);
}

TEST(Controls, FollowsAnAttitudeAndRates) {
    Bench bench;
    msg::SetAttitudeTarget target{.target_system = 1, .type_mask = 0x07, .thrust = 0.5f};
    target.q = {std::cos(0.1f), std::sin(0.1f), 0, 0};
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 2);
    EXPECT_NEAR(bench.state().roll_deg, 11.46, 1.5);

    target.type_mask = 0x80;
    target.body_roll_rate = target.body_pitch_rate = 0;
    target.body_yaw_rate = 0.5f;
    const double before = bench.state().heading_deg;
    repeat(bench, target, 1);
    EXPECT_NEAR(std::remainder(bench.state().heading_deg - before, 360), 28, 8);
}

TEST(Controls, AcceptsActuatorTargets) {
    Bench bench;
    msg::SetActuatorControlTarget target{.target_system = 1};
    target.controls = {0, 0, 0, 0.5f};
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 0.5);
    EXPECT_EQ(bench.state().mode, "Offboard");
}

template <class Message>
void expect_rejected(const Message& message) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    bench.rig.forget();
    for (int i = 0; i < 10; ++i) bench.rig.send(message);
    EXPECT_EQ(bench.rig.all<msg::Statustext>().size(), 1u) << "one text for all of them";
    EXPECT_THAT(bench.text(), testing::HasSubstr("invalid"));
    EXPECT_EQ(bench.command(176, {1, 6}), temporarily_rejected) << "it was no set-point";
    bench.rig.run(1100ms);
    bench.rig.forget();
    bench.rig.send(message);
    EXPECT_EQ(bench.rig.all<msg::Statustext>().size(), 1u);
}

TEST(Controls, RejectsPositionTargetsWithoutSense) {
    expect_rejected(local_target(nothing_mask));
    expect_rejected(local_target(nothing_mask & ~0x400));    // a yaw alone
    expect_rejected(local_target(acceleration_mask | 512));  // force
    expect_rejected(local_target(velocity_mask, 12));        // a frame that PX4 does not know
    expect_rejected(local_target(position_mask, body_ned));  // PX4 takes velocities only
    auto infinite = local_target(velocity_mask);
    infinite.vx = inf_f;
    expect_rejected(infinite);
    auto empty = local_target(velocity_mask);
    empty.vx = empty.vy = empty.vz = nan_f;
    expect_rejected(empty);
}

TEST(Controls, RejectsGlobalTargetsWithoutSense) {
    msg::SetPositionTargetGlobalInt target{.target_system = 1, .coordinate_frame = 1, .type_mask = position_mask};
    expect_rejected(target);
    target.coordinate_frame = 6;
    target.lat_int = 950'000'000;
    expect_rejected(target);
    target.lat_int = 474'000'000;
    target.alt = inf_f;
    expect_rejected(target);
    target.alt = 10;
    target.type_mask = nothing_mask;
    expect_rejected(target);
}

TEST(Controls, RejectsAttitudeTargetsWithoutSense) {
    msg::SetAttitudeTarget target{.target_system = 1, .type_mask = 0x07, .thrust = 0.5f};
    expect_rejected(target);  // no attitude
    target.q = {1, 0, 0, nan_f};
    expect_rejected(target);
    target.q = {1, 0, 0, 0};
    target.thrust = nan_f;
    expect_rejected(target);
    target.thrust = 0.5f;
    target.type_mask = 0x47;
    expect_rejected(target);  // no thrust
    target.type_mask = 0x81;
    expect_rejected(target);  // neither attitude nor roll rate
    msg::SetActuatorControlTarget actuators{.target_system = 1};
    actuators.controls[2] = inf_f;
    expect_rejected(actuators);
}

TEST(Controls, IgnoresFieldsThatTheMaskLeavesOut) {
    Bench bench;
    auto target = local_target(velocity_mask);
    target.x = target.y = target.z = inf_f;
    target.afx = nan_f;
    target.vx = 1;
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 4);
    EXPECT_NEAR(bench.state().north_m_s, 1, 0.2);
}

TEST(Controls, ArduPilotFliesToAPositionThatItGetsOnce) {
    struct Case {
        std::uint8_t frame;
        float x, y, z;
    };
    // From 10 m above home, heading north.
    for (const Case& c : {Case{local_ned, 10, 5, -12}, Case{local_offset, 10, 5, -2}, Case{body_offset, 10, 5, -2},
                          Case{body_ned, 10, 5, -2}}) {
        Bench bench(Autopilot::ardupilot);
        auto target = local_target(position_mask | 0x400, c.frame);
        target.x = c.x;
        target.y = c.y;
        target.z = c.z;
        ASSERT_TRUE(begin(bench, target));
        bench.rig.run(20.0);
        EXPECT_NEAR(bench.north(), 10, 1) << int{c.frame};
        EXPECT_NEAR(bench.east(), 5, 1) << int{c.frame};
        EXPECT_NEAR(bench.state().relative_altitude_m, 12, 0.7) << int{c.frame};
        EXPECT_EQ(bench.state().mode, "GUIDED");
    }
}

TEST(Controls, ArduPilotStopsWhenVelocitiesEnd) {
    Bench bench(Autopilot::ardupilot);
    auto target = local_target(velocity_mask);
    target.vx = 3;
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 5);
    EXPECT_NEAR(bench.state().north_m_s, 3, 0.3);
    bench.rig.run(8.0);
    EXPECT_NEAR(speed(bench), 0, 0.2);
    EXPECT_EQ(bench.state().mode, "GUIDED");
}

// A thrust must be there, the quaternion must have the length 1, and the rates come together (ArduCopter).
TEST(Controls, ArduPilotStopsAtAttitudesThatItCannotFly) {
    const msg::SetAttitudeTarget good{.target_system = 1, .type_mask = 0x07, .q = {1, 0, 0, 0}, .thrust = 0.5f};
    auto no_thrust = good, no_attitude = good, one_rate = good;
    no_thrust.type_mask = 0x47;
    no_attitude.q = {0.9f, 0, 0, 0};
    one_rate.type_mask = 0x03;
    for (const auto& target : {no_thrust, no_attitude, one_rate}) {
        Bench bench(Autopilot::ardupilot);
        auto east = local_target(velocity_mask);
        east.vy = 3;
        ASSERT_TRUE(begin(bench, east));
        repeat(bench, east, 5);
        bench.rig.forget();
        bench.rig.send(target);
        bench.rig.run(2.5);  // less than GUID_TIMEOUT, 3 s
        EXPECT_LT(speed(bench), 0.3) << int{target.type_mask};
        EXPECT_THAT(bench.rig.all<msg::Statustext>(), testing::IsEmpty());
    }
}

// DroneKit's simple_goto() while velocities are still fresh: the newer order counts.
TEST(Controls, ArduPilotFliesToAGoalThatFollowsVelocities) {
    Bench bench(Autopilot::ardupilot);
    auto target = local_target(velocity_mask);
    target.vx = 3;
    ASSERT_TRUE(begin(bench, target));
    repeat(bench, target, 3);
    bench.rig.send(msg::MissionItem{.target_system = 1,
                                    .target_component = 1,
                                    .frame = 3,
                                    .command = 16,
                                    .current = 2,
                                    .x = 47.397742f,
                                    .y = 8.5457f,
                                    .z = 12});
    bench.rig.run(15.0);
    EXPECT_NEAR(bench.east(), 8, 1);
    EXPECT_NEAR(bench.state().relative_altitude_m, 12, 0.7);
}

TEST(Controls, ADisarmedVehicleTakesEveryModeButCannotBeArmedInOffboard) {
    Bench bench;
    EXPECT_EQ(bench.command(176, {1, 6}), accepted);
    EXPECT_EQ(bench.arm(), temporarily_rejected);
}

TEST(Controls, ArduPilotIgnoresPositionsOutsideOfGuided) {
    Bench bench(Autopilot::ardupilot);
    ASSERT_TRUE(bench.fly());
    ASSERT_EQ(bench.command(176, {1, 5}), accepted);
    auto target = local_target(position_mask);
    target.x = 50;
    bench.rig.send(target);
    bench.rig.run(5.0);
    EXPECT_EQ(bench.state().mode, "LOITER");
    EXPECT_NEAR(bench.north(), 0, 1);
}

// --- Sticks

constexpr std::int16_t unused_axis = 32767;
msg::ManualControl sticks(std::int16_t x, std::int16_t y, std::int16_t z, std::int16_t r) {
    return {.target = 1, .x = x, .y = y, .z = z, .r = r};
}

TEST(Controls, SticksMoveTheVehicleInPosition) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(176, {1, 3}), temporarily_rejected) << "no sticks yet";
    bench.rig.send(sticks(0, 0, 500, 0));
    EXPECT_EQ(bench.command(176, {1, 3}), accepted);
    repeat(bench, sticks(500, 0, 500, 0), 4);
    EXPECT_GT(bench.state().north_m_s, 2) << "forward";
    EXPECT_NEAR(bench.state().east_m_s, 0, 0.5);
    EXPECT_NEAR(bench.state().relative_altitude_m, 10, 0.7);
    repeat(bench, sticks(0, 0, 1000, 0), 3);
    EXPECT_GT(bench.state().relative_altitude_m, 12) << "up";
    bench.rig.run(3.0);
    EXPECT_EQ(bench.state().mode, "Hold") << "sticks are lost";
}

TEST(Controls, SticksForAnotherVehicleOrWithoutAxesAreIgnored) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    auto stranger = sticks(0, 0, 500, 0);
    stranger.target = 2;
    bench.rig.send(stranger);
    EXPECT_EQ(bench.command(176, {1, 3}), temporarily_rejected);
    bench.rig.send(sticks(unused_axis, unused_axis, unused_axis, unused_axis));
    EXPECT_EQ(bench.command(176, {1, 3}), temporarily_rejected);
    ASSERT_TRUE(bench.rig.vehicle.set_parameter("COM_RC_IN_MODE", 4).has_value());
    bench.rig.send(sticks(0, 0, 500, 0));
    EXPECT_EQ(bench.command(176, {1, 3}), temporarily_rejected) << "manual control is off";
}

TEST(Controls, SticksBeyondTheirRangeCountAsFull) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    bench.rig.send(sticks(0, 0, 500, 0));
    ASSERT_EQ(bench.command(176, {1, 2}), accepted);
    repeat(bench, sticks(-32768, 32766, 500, 0), 3);
    EXPECT_LT(std::abs(bench.state().roll_deg), 50);
    EXPECT_LT(std::abs(bench.state().pitch_deg), 50);
}

msg::RcChannelsOverride channels(std::uint16_t roll, std::uint16_t pitch, std::uint16_t throttle, std::uint16_t yaw) {
    constexpr std::uint16_t keep = 0xffff;
    return {.target_system = 1,
            .target_component = 1,
            .chan1_raw = roll,
            .chan2_raw = pitch,
            .chan3_raw = throttle,
            .chan4_raw = yaw,
            .chan5_raw = keep,
            .chan6_raw = keep,
            .chan7_raw = keep,
            .chan8_raw = keep};
}

// A short pulse on the pitch channel is the stick forward.
TEST(Controls, ChannelsSteerArduPilot) {
    Bench bench(Autopilot::ardupilot);
    ASSERT_TRUE(bench.fly());
    ASSERT_EQ(bench.command(176, {1, 5}), accepted);
    repeat(bench, channels(1500, 1250, 1500, 1500), 4);
    EXPECT_GT(bench.state().north_m_s, 2);
    repeat(bench, channels(0, 0, 0, 0), 5);
    EXPECT_NEAR(speed(bench), 0, 0.3) << "given back";
    Bench px4;
    ASSERT_TRUE(px4.fly());
    px4.rig.send(channels(1500, 1250, 1500, 1500));
    EXPECT_EQ(px4.command(176, {1, 3}), temporarily_rejected) << "PX4 has its own message";
}

TEST(Controls, ArduPilotCanListenToOneGroundStationOnly) {
    Bench bench(Autopilot::ardupilot);
    ASSERT_TRUE(bench.rig.vehicle.set_parameter("SYSID_ENFORCE", 1).has_value());
    ASSERT_TRUE(bench.fly());
    ASSERT_EQ(bench.command(176, {1, 5}), accepted);
    for (int i = 0; i < 60; ++i) {
        bench.rig.send(channels(1500, 1000, 1500, 1500), {.id = {SystemId{245}, ComponentId{190}}});
        bench.rig.run(50ms);
    }
    EXPECT_NEAR(speed(bench), 0, 0.3);
}

// --- The rest

TEST(Controls, OriginIsReportedAtOnce) {
    Bench bench;
    bench.rig.forget();
    msg::SetGpsGlobalOrigin origin{
        .target_system = 1, .latitude = 473'970'000, .longitude = 85'450'000, .altitude = 400'000};
    bench.rig.send(origin);
    ASSERT_TRUE(bench.rig.last<msg::GpsGlobalOrigin>());
    EXPECT_EQ(bench.rig.last<msg::GpsGlobalOrigin>()->latitude, 473'970'000);
    bench.rig.forget();
    origin.latitude = 2'000'000'000;
    bench.rig.send(origin);
    EXPECT_FALSE(bench.rig.last<msg::GpsGlobalOrigin>());
}

TEST(Controls, ArduPilotTakesHomeFromAMessage) {
    Bench bench(Autopilot::ardupilot);
    bench.rig.send(msg::SetHomePosition{
        .target_system = 1, .latitude = 473'977'420, .longitude = 85'455'940, .altitude = 480'000});
    EXPECT_NEAR(bench.state().relative_altitude_m, 9.4, 0.2);
}

TEST(Controls, FollowsATarget) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    ASSERT_EQ(bench.command(176, {1, 4, 8}), accepted);
    repeat(bench, msg::FollowTarget{.lat = 473'980'000, .lon = 85'455'940, .alt = 490}, 20);
    EXPECT_NEAR(bench.north(), 28.7 - 8, 1.5) << "8 m from the target";
    EXPECT_NEAR(bench.state().relative_altitude_m, 8, 0.7);
    repeat(bench, msg::FollowTarget{.lat = 2'000'000'000, .lon = 1, .alt = nan_f}, 1);
    EXPECT_NEAR(bench.north(), 28.7 - 8, 1.5);
}

}  // namespace
}  // namespace mavloom::sim
