// SPDX-License-Identifier: MIT
// Gimbal, traffic and servo outputs, as a client sees them.
#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "mavloom/msg/adsb_vehicle.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_result.hpp"
#include "mavloom/msg/gimbal_device_attitude_status.hpp"
#include "mavloom/msg/gimbal_device_information.hpp"
#include "mavloom/msg/gimbal_manager_information.hpp"
#include "mavloom/msg/gimbal_manager_set_attitude.hpp"
#include "mavloom/msg/gimbal_manager_set_pitchyaw.hpp"
#include "mavloom/msg/gimbal_manager_status.hpp"
#include "mavloom/msg/servo_output_raw.hpp"
#include "sim/payload/traffic.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

using test::Peer;
using test::Rig;

constexpr float unset = std::numeric_limits<float>::quiet_NaN();
constexpr float in_vehicle = 32, from_north = 64, locked = 16, neutral = 2;
const Peer sdk{.id = {SystemId{245}, ComponentId{190}}};

VehicleOptions with_gimbal() {
    VehicleOptions options;
    options.has_gimbal = true;
    options.has_noise = false;
    options.home.heading_deg = 90;
    return options;
}

std::uint8_t command(Rig& rig, std::uint16_t id, const std::array<float, 7>& p, const Peer& from = {}) {
    rig.send(msg::CommandLong{.target_system = 1,
                              .target_component = 1,
                              .command = id,
                              .param1 = p[0],
                              .param2 = p[1],
                              .param3 = p[2],
                              .param4 = p[3],
                              .param5 = p[4],
                              .param6 = p[5],
                              .param7 = p[6]},
             from);
    return rig.last<msg::CommandAck>()->result;
}
template <class Message>
Message requested(Rig& rig) {
    EXPECT_EQ(command(rig, msg::MAV_CMD_REQUEST_MESSAGE, {static_cast<float>(Message::id.value)}),
              msg::MAV_RESULT_ACCEPTED);
    return rig.last<Message>().value_or(Message{});
}
void take_control(Rig& rig, const Peer& who = {}) {
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, {-2, -2, -1, -1, 0, 0, 0}, who),
              msg::MAV_RESULT_ACCEPTED);
}
std::uint8_t point(Rig& rig, float pitch, float yaw, float flags, const Peer& who = {}) {
    return command(rig, msg::MAV_CMD_DO_GIMBAL_MANAGER_PITCHYAW, {pitch, yaw, unset, unset, flags, 0, 0}, who);
}

// Degrees, by the formula for Euler angles of a quaternion w, x, y, z.
struct Angles {
    double pitch, yaw;
};
Angles angles(Rig& rig) {
    const auto q = requested<msg::GimbalDeviceAttitudeStatus>(rig).q;
    return {std::asin(2 * (q[0] * q[2] - q[3] * q[1])) * 180 / M_PI,
            std::atan2(2 * (q[0] * q[3] + q[1] * q[2]), 1 - 2 * (q[2] * q[2] + q[3] * q[3])) * 180 / M_PI};
}

TEST(GimbalTest, WithoutOneRequestsAndOrdersAreUnsupportedAtOnce) {
    Rig rig;

    EXPECT_EQ(command(rig, msg::MAV_CMD_REQUEST_MESSAGE, {280}), msg::MAV_RESULT_UNSUPPORTED);
    EXPECT_EQ(command(rig, msg::MAV_CMD_REQUEST_MESSAGE, {283}), msg::MAV_RESULT_UNSUPPORTED);
    EXPECT_EQ(point(rig, 0, 0, 0), msg::MAV_RESULT_UNSUPPORTED);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, {-2, -2, -1, -1}), msg::MAV_RESULT_UNSUPPORTED);
}

TEST(GimbalTest, IntroducesItselfAsDevice1OfTheAutopilot) {
    Rig rig(with_gimbal());

    const auto manager = requested<msg::GimbalManagerInformation>(rig);
    const auto device = requested<msg::GimbalDeviceInformation>(rig);

    EXPECT_EQ(manager.gimbal_device_id, 1);
    EXPECT_EQ(device.gimbal_device_id, 1);
    EXPECT_NEAR(manager.pitch_min, -M_PI / 2, 1e-6);
    EXPECT_LT(device.pitch_min, device.pitch_max);
    EXPECT_STREQ(device.vendor_name.data(), "Mavloom");
}

TEST(GimbalTest, OnlyTheClientInControlMovesIt) {
    Rig rig(with_gimbal());

    EXPECT_EQ(point(rig, -30, 0, in_vehicle), msg::MAV_RESULT_DENIED);
    take_control(rig);
    EXPECT_EQ(point(rig, -30, 0, in_vehicle), msg::MAV_RESULT_ACCEPTED);
    EXPECT_EQ(point(rig, 10, 0, in_vehicle, sdk), msg::MAV_RESULT_DENIED);
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).pitch, -30, 0.1);
    rig.send(msg::GimbalManagerSetPitchyaw{.target_system = 1, .pitch = 0.2f, .yaw = unset}, sdk);
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).pitch, -30, 0.1);
}

TEST(GimbalTest, ControlIsTakenOverGivenAwayAndReturned) {
    Rig rig(with_gimbal());
    take_control(rig);
    EXPECT_EQ(requested<msg::GimbalManagerStatus>(rig).primary_control_sysid, 255);
    take_control(rig, sdk);
    EXPECT_EQ(requested<msg::GimbalManagerStatus>(rig).primary_control_sysid, 245);

    command(rig, msg::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, {-3, -3, -1, -1});  // not in control: no change
    EXPECT_EQ(requested<msg::GimbalManagerStatus>(rig).primary_control_sysid, 245);
    command(rig, msg::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, {7, 8, 9, 10}, sdk);
    const auto given = requested<msg::GimbalManagerStatus>(rig);
    EXPECT_EQ(given.primary_control_sysid, 7);
    EXPECT_EQ(given.primary_control_compid, 8);
    EXPECT_EQ(given.secondary_control_sysid, 9);
    EXPECT_EQ(given.secondary_control_compid, 10);
    take_control(rig, sdk);
    command(rig, msg::MAV_CMD_DO_GIMBAL_MANAGER_CONFIGURE, {-3, -3, -1, -1}, sdk);
    EXPECT_EQ(requested<msg::GimbalManagerStatus>(rig).primary_control_sysid, 0);
}

// At 90 degrees a second, 45 degrees take half a second.
TEST(GimbalTest, MovesAtItsRateAndReportsItsMotionAsTheDerivativeOfItsAngle) {
    Rig rig(with_gimbal());
    take_control(rig);
    point(rig, -60, 0, in_vehicle);
    rig.run(0.1);
    const double before = angles(rig).pitch;
    const auto during = *rig.last<msg::GimbalDeviceAttitudeStatus>();
    rig.run(0.2);

    EXPECT_NEAR(angles(rig).pitch - before, -18, 0.5);
    EXPECT_NEAR(during.angular_velocity_y, -M_PI / 2, 1e-3);
    rig.run(2.0);
    EXPECT_NEAR(angles(rig).pitch, -60, 0.01);
    EXPECT_NEAR(rig.last<msg::GimbalDeviceAttitudeStatus>()->angular_velocity_y, 0, 1e-3);
}

// The vehicle's nose points east.
TEST(GimbalTest, YawIsFromTheNoseOrFromNorthByTheFlags) {
    Rig rig(with_gimbal());
    take_control(rig);
    const auto flags = [&] { return requested<msg::GimbalDeviceAttitudeStatus>(rig).flags; };

    point(rig, 0, 20, in_vehicle);
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).yaw, 20, 0.1);
    EXPECT_EQ(flags() & (32 | 64 | 16), 32);
    EXPECT_NEAR(rig.last<msg::GimbalDeviceAttitudeStatus>()->delta_yaw, M_PI / 2, 1e-3);
    point(rig, 0, 20, from_north);  // follows from there on
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).yaw, -70, 0.1);
    EXPECT_EQ(flags() & (32 | 64 | 16), 32);
    point(rig, 0, 20, locked);
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).yaw, 20, 0.1);
    EXPECT_EQ(flags() & (32 | 64 | 16), 64 | 16);
    point(rig, 0, 20, locked + in_vehicle);
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).yaw, 110, 0.1);
    point(rig, unset, unset, neutral);
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).yaw, 0, 0.1);
    EXPECT_EQ(requested<msg::GimbalManagerStatus>(rig).flags & 2u, 2u);
}

TEST(GimbalTest, TurnsAtARateUntilTheNextOrderAndStopsAtTheEndOfItsRange) {
    Rig rig(with_gimbal());
    take_control(rig);
    rig.send(msg::GimbalManagerSetPitchyaw{
        .target_system = 1, .pitch = unset, .yaw = unset, .pitch_rate = 0.5f, .yaw_rate = -0.2f});
    rig.run(10.0);

    EXPECT_NEAR(angles(rig).pitch, 30, 0.1);
    EXPECT_NEAR(angles(rig).yaw, -2 * 180 / M_PI, 2);
}

TEST(GimbalTest, ALimitBoundsTheAngleAndNotANumberLeavesItAlone) {
    Rig rig(with_gimbal());
    take_control(rig);
    point(rig, -500, 0, in_vehicle);
    rig.run(3.0);
    EXPECT_NEAR(angles(rig).pitch, -90, 0.1);
    point(rig, -45, 30, in_vehicle);
    rig.run(3.0);
    point(rig, unset, 1e30f, unset);
    rig.send(msg::GimbalManagerSetAttitude{.target_system = 1,
                                           .q = {unset, unset, unset, unset},
                                           .angular_velocity_x = unset,
                                           .angular_velocity_y = unset,
                                           .angular_velocity_z = unset});
    rig.run(3.0);

    EXPECT_NEAR(angles(rig).pitch, -45, 0.1);
    EXPECT_NEAR(angles(rig).yaw, 30, 0.1);
}

TEST(GimbalTest, FollowsAQuaternion) {
    Rig rig(with_gimbal());
    take_control(rig);
    // Pitch -30 degrees, then yaw 40 degrees.
    const float cp = std::cos(-0.2618f), sp = std::sin(-0.2618f), cy = std::cos(0.34907f), sy = std::sin(0.34907f);
    rig.send(msg::GimbalManagerSetAttitude{.target_system = 1,
                                           .flags = 32,
                                           .q = {cp * cy, -sp * sy, sp * cy, cp * sy},
                                           .angular_velocity_x = unset,
                                           .angular_velocity_y = unset,
                                           .angular_velocity_z = unset});
    rig.run(3.0);

    EXPECT_NEAR(angles(rig).pitch, -30, 0.1);
    EXPECT_NEAR(angles(rig).yaw, 40, 0.1);
}

// --- Traffic

TEST(TrafficTest, EachAircraftIsHeardOnceASecondWithAllFieldsValid) {
    VehicleOptions options;
    options.traffic = 5;
    Rig rig(options);
    rig.run(20.0);

    const auto heard = rig.all<msg::AdsbVehicle>();
    std::set<std::uint32_t> addresses;
    for (const auto& aircraft : heard) {
        addresses.insert(aircraft.ICAO_address);
        EXPECT_EQ(aircraft.flags & 0x3f, 0x3f);
        EXPECT_GT(aircraft.altitude, 600'000);
        EXPECT_GT(std::string(aircraft.callsign.data()).size(), 4u);
        EXPECT_LT(aircraft.heading, 36000);
        EXPECT_NEAR(aircraft.lat * 1e-7, 47.4, 0.4);
    }
    EXPECT_NEAR(static_cast<double>(heard.size()), 100, 5);
    EXPECT_EQ(addresses.size(), 5u);
}

TEST(TrafficTest, TheSameSeedGivesTheSameTraffic) {
    VehicleOptions options;
    options.traffic = 3;
    Rig first(options), second(options);
    options.seed = 2;
    Rig other(options);
    for (Rig* const rig : {&first, &second, &other}) rig->run(5.0);

    EXPECT_EQ(first.all<msg::AdsbVehicle>(), second.all<msg::AdsbVehicle>());
    EXPECT_NE(first.all<msg::AdsbVehicle>(), other.all<msg::AdsbVehicle>());
}

TEST(TrafficTest, AClientTurnsItOffOnItsLinkAlone) {
    VehicleOptions options;
    options.traffic = 2;
    Rig rig(options);
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    EXPECT_EQ(command(rig, msg::MAV_CMD_SET_MESSAGE_INTERVAL, {246, -1}), msg::MAV_RESULT_ACCEPTED);
    rig.run(5.0);

    EXPECT_TRUE(rig.all<msg::AdsbVehicle>().empty());
    EXPECT_GE(rig.all<msg::AdsbVehicle>(LinkId{2}).size(), 9u);
    EXPECT_EQ(command(rig, msg::MAV_CMD_SET_MESSAGE_INTERVAL, {246, 2e6f}), msg::MAV_RESULT_ACCEPTED);
    rig.run(10.0);
    EXPECT_NEAR(static_cast<double>(rig.all<msg::AdsbVehicle>().size()), 10, 2);
}

TEST(TrafficTest, AStallIsNotFollowedByABurst) {
    VehicleOptions options;
    options.traffic = 2;
    Rig rig(options);
    rig.run(2.0);
    rig.forget();
    rig.flight += std::chrono::seconds{30};
    rig.vehicle.advance(rig.now());

    EXPECT_LE(rig.all<msg::AdsbVehicle>().size(), 3u);
}

TEST(TrafficTest, AircraftMoveAsTheirVelocityClaims) {
    Random random(11);
    for (int i = 0; i < 20; ++i) {
        const Aircraft aircraft = make_aircraft(random);
        for (double t = 0; t < 900; t += 7) {
            const auto a = aircraft.at(t), b = aircraft.at(t + 0.01);
            const Vector3 slope = (b.position - a.position) / 0.01;
            ASSERT_LT((slope - (a.velocity + b.velocity) / 2).norm(), 0.01) << i << " at " << t;
            ASSERT_LT(a.position.head<2>().norm(), 60'000);
            ASSERT_LT(a.position.z(), -150);
        }
    }
}

// --- Servos

TEST(ServoTest, ActuatorsOfPx4ShowInTheAuxiliaryOutputs) {
    Rig rig;
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_ACTUATOR, {-1, 0.5f, unset, unset, unset, unset, 0}),
              msg::MAV_RESULT_ACCEPTED);

    const auto outputs = requested<msg::ServoOutputRaw>(rig);
    EXPECT_EQ(outputs.servo9_raw, 1000);
    EXPECT_EQ(outputs.servo10_raw, 1750);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_SERVO, {9, 1700}), msg::MAV_RESULT_UNSUPPORTED);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_RELAY, {0, 1}), msg::MAV_RESULT_UNSUPPORTED);
}

TEST(ServoTest, ArduPilotSetsServosAndRelaysButNotItsOwnMotors) {
    VehicleOptions options;
    options.autopilot = Autopilot::ardupilot;
    options.kind = Kind::plane;
    Rig rig(options);
    rig.run(0.1);

    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_SERVO, {9, 1700}), msg::MAV_RESULT_ACCEPTED);
    EXPECT_EQ(requested<msg::ServoOutputRaw>(rig).servo9_raw, 1700);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_SERVO, {2, 1700}), msg::MAV_RESULT_FAILED);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_SERVO, {17, 1700}), msg::MAV_RESULT_FAILED);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_SERVO, {unset, unset}), msg::MAV_RESULT_FAILED);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_RELAY, {0, 1}), msg::MAV_RESULT_ACCEPTED);
    EXPECT_EQ(command(rig, msg::MAV_CMD_DO_SET_RELAY, {6, 1}), msg::MAV_RESULT_FAILED);
}

// Absent payload is answered at once; PX4 leaves some of these without an answer, for which clients wait.
TEST(PayloadCommandTest, WhatIsNotSimulatedIsUnsupported) {
    Rig rig;
    for (const std::uint16_t id :
         {msg::MAV_CMD_DO_GRIPPER, msg::MAV_CMD_DO_WINCH, msg::MAV_CMD_DO_DIGICAM_CONTROL,
          msg::MAV_CMD_DO_SET_CAM_TRIGG_DIST, msg::MAV_CMD_SET_CAMERA_MODE, msg::MAV_CMD_SET_CAMERA_ZOOM,
          msg::MAV_CMD_IMAGE_START_CAPTURE, msg::MAV_CMD_VIDEO_START_CAPTURE, msg::MAV_CMD_DO_MOUNT_CONTROL})
        EXPECT_EQ(command(rig, id, {}), msg::MAV_RESULT_UNSUPPORTED) << id;
}

}  // namespace
}  // namespace mavloom::sim
