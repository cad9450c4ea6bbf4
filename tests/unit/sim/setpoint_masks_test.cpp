// SPDX-License-Identifier: MIT
// Every type_mask that a client or a guide sends, and whether a real vehicle obeys it. The answers are those of PX4's
// mavlink_receiver.cpp and of ArduPilot's GCS_MAVLink_Copter.cpp and GCS_MAVLink_Rover.cpp. There is one exception: PX4
// knows the frames 1 and 8 only, and the simulated PX4 takes 7 and 9 too.
#include <gmock/gmock.h>

#include <string_view>

#include "mavloom/msg/set_position_target_global_int.hpp"
#include "mavloom/msg/set_position_target_local_ned.hpp"
#include "unit/sim/bench.hpp"

namespace mavloom::sim::setpoint_mask_tests {
namespace {

using namespace test;
using namespace std::chrono_literals;

constexpr std::uint8_t local_ned = 1, local_offset = 7, body_ned = 8, body_offset = 9;
constexpr std::uint8_t global_int = 5, relative_int = 6, terrain_int = 11;

struct MaskCase {
    std::string_view source;
    std::uint16_t mask;
    std::uint8_t frame;
    bool px4, copter;  // whether the vehicle obeys
};

void PrintTo(const MaskCase& c, std::ostream* out) {
    *out << c.source << ", mask 0x" << std::hex << c.mask << std::dec << ", frame " << int{c.frame};
}

constexpr MaskCase local_cases[]{
    {"DroneKit, goto_position_target_local_ned", 0xff8, local_ned, true, true},
    {"DroneKit, send_ned_velocity", 0xfc7, local_ned, true, true},
    {"DroneKit guide, velocity of the body", 0xfc7, body_offset, true, true},
    {"MAVProxy, velocity", 4039, body_ned, true, true},
    {"MAVProxy, position", 3576, body_ned, false, true},
    {"MAVProxy, guided forward", 0x5f8, body_ned, false, true},
    {"MAVProxy, setpos", 0xfbf8, body_offset, true, true},
    {"MAVSDK, set_position_ned", 0x9f8, local_ned, true, true},
    {"MAVSDK, set_velocity_ned", 0x9c7, local_ned, true, true},
    {"MAVSDK, set_position_velocity_ned", 0x9c0, local_ned, true, true},
    {"MAVSDK, set_position_velocity_acceleration_ned", 0x800, local_ned, true, true},
    {"MAVSDK, set_acceleration_ned", 0xc3f, local_ned, true, true},
    {"MAVSDK, set_velocity_body", 0x5c7, body_ned, true, true},
    {"MAVROS, setpoint_position", 0x9f8, local_ned, true, true},
    {"MAVROS, setpoint_velocity", 0x5c7, local_ned, true, true},
    {"MAVROS, setpoint_velocity with mav_frame", 0x5c7, body_offset, true, true},
    {"MAVROS, setpoint_accel", 0xc3f, local_ned, true, true},
    {"MAVROS, setpoint_accel with send_force", 0xe3f, local_ned, false, false},
    {"MAVROS, setpoint_trajectory, all of a point", 0x000, local_ned, true, true},
    {"MAVROS, setpoint_trajectory, without accelerations", 0x1c0, local_ned, true, true},
    {"MAVROS, setpoint_trajectory, a position", 0x9f8, local_ned, true, true},
    {"MAVROS, setpoint_trajectory, a velocity", 0x5c7, local_ned, true, true},
    {"MAVLink guide and ArduPilot guide, position", 0xdf8, local_ned, true, true},
    {"ArduPilot guide, position from here", 0xdf8, local_offset, true, true},
    {"MAVLink guide and ArduPilot guide, velocity", 0xdc7, local_ned, true, true},
    {"ArduPilot guide, velocity of the body", 0xdc7, body_offset, true, true},
    {"ArduPilot guide, acceleration", 0xc3f, local_ned, true, true},
    {"ArduPilot guide, position and velocity", 0xdc0, local_ned, true, true},
    {"ArduPilot guide, position, velocity and acceleration", 0xc00, local_ned, true, true},
    {"ArduPilot guide, yaw", 0x9ff, local_ned, false, false},
    {"ArduPilot guide, yaw rate", 0x5ff, local_ned, false, false},
    {"ArduPilot guide, position and yaw", 0x9f8, body_offset, true, true},
    {"ArduPilot guide, velocity and yaw rate", 0x5c7, body_offset, true, true},
    {"PX4's c_uart_interface_example, velocity and yaw rate", 0x5c7, local_ned, true, true},
    {"PX4's c_uart_interface_example, position and yaw", 0x9f8, local_ned, true, true},
    {"PX4's c_uart_interface_example, force", 0xe3f, local_ned, false, false},
    {"PX4 guide, take-off of a plane", 0x1000, local_ned, true, true},
    {"PX4 guide, loitering of a plane", 0x3000, local_ned, true, true},
    {"common.xml, everything", 0x000, local_ned, true, true},
    {"common.xml, everything, as a force", 0x200, local_ned, false, false},
    {"everything ignored", 0xfff, local_ned, false, false},
    {"altitude and horizontal velocity", 0xde3, local_ned, true, false},
    {"horizontal velocity", 0xde7, local_ned, true, false},
    {"horizontal velocity of the body", 0xde7, body_ned, false, false},
    {"position of the body with a velocity", 0xdc0, body_ned, true, true},
    {"velocity, and a vertical force", 0xec7, local_ned, false, true},
};

constexpr MaskCase global_cases[]{
    {"DroneKit, goto_position_target_global_int", 0xff8, relative_int, true, true},
    {"DroneKit, send_global_velocity", 0xfc7, relative_int, true, true},
    {"MAVProxy, posvel with a click", 0x1f8, relative_int, true, true},
    {"MAVProxy, posvel with a velocity", 0x1c7, relative_int, true, true},
    {"MAVProxy, posvel with both", 0x1c0, relative_int, true, true},
    {"MAVSDK, set_position_global, above sea level", 0x9f8, global_int, true, true},
    {"MAVSDK, set_position_global, above home", 0x9f8, relative_int, true, true},
    {"MAVSDK, set_position_global, above ground", 0x9f8, terrain_int, true, true},
    {"MAVROS, setpoint_position/global", 0x1f8, global_int, true, true},
    {"ArduPilot guide, position", 0xdf8, relative_int, true, true},
    {"ArduPilot guide, velocity", 0xdc7, relative_int, true, true},
    {"ArduPilot guide, acceleration", 0xc3f, relative_int, true, true},
    {"ArduPilot guide, position and velocity", 0xdc0, relative_int, true, true},
    {"a velocity in a frame that no position can have", 0xdc7, local_ned, true, true},
    {"a position in a frame that no position can have", 0xdf8, local_ned, false, false},
    {"force", 0xe3f, relative_int, false, false},
    {"altitude", 0xdfb, relative_int, false, false},
    {"everything ignored", 0xfff, relative_int, false, false},
};

// A message without effect is reported by a text.
template <class Message>
bool obeys(Bench& bench, const Message& message) {
    bench.rig.run(1100ms);
    bench.rig.forget();
    bench.rig.send(message);
    return bench.rig.all<msg::Statustext>().empty();
}

bool obeys_local(Bench& bench, const MaskCase& c) {
    return obeys(bench, msg::SetPositionTargetLocalNed{
                            .target_system = 1, .coordinate_frame = c.frame, .type_mask = c.mask, .z = -10});
}

bool obeys_global(Bench& bench, const MaskCase& c) {
    return obeys(bench, msg::SetPositionTargetGlobalInt{.target_system = 1,
                                                        .coordinate_frame = c.frame,
                                                        .type_mask = c.mask,
                                                        .lat_int = 473'977'420,
                                                        .lon_int = 85'455'940,
                                                        .alt = 10});
}

TEST(SetpointMasks, LocalTargetsAreObeyedAsByARealVehicle) {
    Bench px4, copter(Autopilot::ardupilot);
    for (const MaskCase& c : local_cases) {
        EXPECT_EQ(obeys_local(px4, c), c.px4) << "PX4: " << testing::PrintToString(c);
        EXPECT_EQ(obeys_local(copter, c), c.copter) << "ArduPilot: " << testing::PrintToString(c);
    }
}

TEST(SetpointMasks, GlobalTargetsAreObeyedAsByARealVehicle) {
    Bench px4, copter(Autopilot::ardupilot);
    for (const MaskCase& c : global_cases) {
        EXPECT_EQ(obeys_global(px4, c), c.px4) << "PX4: " << testing::PrintToString(c);
        EXPECT_EQ(obeys_global(copter, c), c.copter) << "ArduPilot: " << testing::PrintToString(c);
    }
}

// ArduPilot's guide for rovers: each alone is enough.
TEST(SetpointMasks, ARoverTakesAHeadingOrATurnAlone) {
    Bench rover(Autopilot::ardupilot, Kind::rover);
    for (const std::uint16_t mask : std::initializer_list<std::uint16_t>{0x9ff, 0x5ff, 0xde7, 0xdfc, 0xfc7, 0xff8})
        EXPECT_TRUE(obeys_local(rover, {"rover", mask, local_ned, false, false})) << mask;
    EXPECT_FALSE(obeys_local(rover, {"rover", 0xdff, local_ned, false, false}));
}

// DroneKit's send_ned_velocity and MAVProxy's `velocity`: the bit for a force is set, and there is no acceleration.
TEST(SetpointMasks, AVelocityWithTheForceBitMovesTheVehicle) {
    for (const Autopilot autopilot : {Autopilot::px4, Autopilot::ardupilot}) {
        Bench bench(autopilot);
        ASSERT_TRUE(bench.fly());
        const msg::SetPositionTargetLocalNed target{
            .target_system = 1, .coordinate_frame = local_ned, .type_mask = 0b0000111111000111, .vx = 3};
        bench.rig.send(target);
        if (autopilot == Autopilot::px4) {
            ASSERT_EQ(bench.command(176, {1, 6}), accepted);
        }
        for (int i = 0; i < 100; ++i) {
            bench.rig.send(target);
            bench.rig.run(50ms);
        }
        EXPECT_NEAR(bench.state().north_m_s, 3, 0.3);
        EXPECT_EQ(bench.state().mode, autopilot == Autopilot::px4 ? "Offboard" : "GUIDED");
    }
}

}  // namespace
}  // namespace mavloom::sim::setpoint_mask_tests
