// SPDX-License-Identifier: MIT
// Every type_mask that a client or a guide sends, and what a real vehicle does then. The answers are those of PX4's
// mavlink_receiver.cpp and of the handlers in ArduCopter, Rover and ArduPlane (GCS_MAVLink_Copter.cpp and so on): PX4
// sends a text, a copter of ArduPilot stops without one, a rover continues. There is one exception: PX4 knows the
// frames 1 and 8 only, and the simulated PX4 takes 7 and 9 too.
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
    bool px4, copter;  // whether the vehicle flies it
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
    {"position and acceleration", 0xc38, local_ned, true, false},
    {"a frame of global positions", 0xdf8, relative_int, false, false},
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
    {"position above ground with a velocity", 0xdc0, terrain_int, true, false},
    {"everything ignored", 0xfff, relative_int, false, false},
};

// The part of a mask that the vehicle flies.
enum class Asked { position, velocity, acceleration };
Asked asked(const MaskCase& c, bool is_px4) {
    const bool has_position = (c.mask & 7) == 0 && !(is_px4 && c.frame == body_ned);
    if (has_position) return Asked::position;
    return (c.mask & 0x18) == 0 ? Asked::velocity : Asked::acceleration;
}

// Excluded fields have values that would be noticed.
float field(const MaskCase& c, unsigned bit, float value) { return (c.mask & bit) != 0 ? 77 : value; }

template <class Message>
void fill_motion(Message& m, const MaskCase& c, Asked what) {
    const float v = what == Asked::velocity ? 1 : 0, a = what == Asked::acceleration ? 1 : 0;
    m.vx = field(c, 0x8, 2 * v);
    m.vy = field(c, 0x10, v);
    m.vz = field(c, 0x20, 0);
    m.afx = field(c, 0x40, a);
    m.afy = field(c, 0x80, a / 2);
    m.afz = field(c, 0x100, 0);
    m.yaw = field(c, 0x400, 0);
    m.yaw_rate = field(c, 0x800, 0);
}

// 6 m north, 4 m east and 2 m above the place that is 10 m above home.
msg::SetPositionTargetLocalNed local_target(const MaskCase& c, Asked what) {
    const float z = c.frame == local_ned ? -12 : -2;
    msg::SetPositionTargetLocalNed m{.target_system = 1,
                                     .coordinate_frame = c.frame,
                                     .type_mask = c.mask,
                                     .x = field(c, 1, 6),
                                     .y = field(c, 2, 4),
                                     .z = field(c, 4, z)};
    fill_motion(m, c, what);
    return m;
}

msg::SetPositionTargetGlobalInt global_target(const MaskCase& c, Asked what) {
    const float altitude = c.frame == global_int ? home_altitude + 12 : 12;
    msg::SetPositionTargetGlobalInt m{.target_system = 1,
                                      .coordinate_frame = c.frame,
                                      .type_mask = c.mask,
                                      .lat_int = (c.mask & 1) != 0 ? 950'000'000 : 473'977'960,
                                      .lon_int = (c.mask & 2) != 0 ? 1'850'000'000 : 85'456'470,
                                      .alt = field(c, 4, altitude)};
    fill_motion(m, c, what);
    return m;
}

template <class Message>
void repeat(Bench& bench, const Message& message, Nanoseconds time) {
    for (Nanoseconds passed{0}; passed < time; passed += 50ms) {
        bench.rig.send(message);
        bench.rig.run(50ms);
    }
}

double speed(const Bench& bench) { return std::hypot(bench.state().north_m_s, bench.state().east_m_s); }

// Repeated frames with an offset lead on and on.
void expect_at_target(const Bench& bench, bool leads_on) {
    if (leads_on) {
        EXPECT_GT(bench.north(), 5);
        EXPECT_NEAR(bench.east(), bench.north() * 4 / 6, 1.5);
        return;
    }
    EXPECT_NEAR(bench.north(), 6, 1);
    EXPECT_NEAR(bench.east(), 4, 1);
    EXPECT_NEAR(bench.state().relative_altitude_m, 12, 0.7);
}

void expect_motion(const Bench& bench, Asked what, std::uint8_t frame) {
    if (what == Asked::acceleration) {
        EXPECT_GT(bench.state().north_m_s, 1);
        EXPECT_GT(bench.state().east_m_s, 0.5);
        return;
    }
    EXPECT_NEAR(speed(bench), std::hypot(2, 1), 0.3);
    if (frame == body_ned || frame == body_offset) return;  // the nose may follow the velocity
    EXPECT_NEAR(bench.state().north_m_s, 2, 0.3);
    EXPECT_NEAR(bench.state().east_m_s, 1, 0.3);
}

// A copter of ArduPilot gets a position once, and all else again and again.
template <class Message>
void expect_flies(Bench& bench, const MaskCase& c, const Message& target) {
    const bool is_px4 = bench.state().autopilot == Autopilot::px4;
    const Asked what = asked(c, is_px4);
    const bool is_goal = !is_px4 && what == Asked::position && (c.mask & 0x38) != 0;
    bench.rig.forget();
    bench.rig.send(target);
    if (is_px4) {
        ASSERT_EQ(bench.command(176, {1, 6}), accepted);
    }
    const Nanoseconds time = what == Asked::position ? 12s : what == Asked::velocity ? 5s : 2s;
    is_goal ? bench.rig.run(time) : repeat(bench, target, time);
    const bool has_offset = c.frame == local_offset || c.frame == body_ned || c.frame == body_offset;
    what == Asked::position ? expect_at_target(bench, has_offset && !is_goal) : expect_motion(bench, what, c.frame);
    EXPECT_THAT(bench.rig.all<msg::Statustext>(), testing::IsEmpty());
    EXPECT_EQ(bench.state().mode, is_px4 ? "Offboard" : "GUIDED");
}

template <class Message>
void expect_refusal(Bench& bench, const Message& target) {
    bench.rig.forget();
    bench.rig.send(target);
    EXPECT_THAT(bench.text(), testing::HasSubstr("invalid"));
    EXPECT_EQ(bench.command(176, {1, 6}), temporarily_rejected) << "it was no set-point";
}

// Flies east. Without an answer to the target, it would do so for 3 s more (GUID_TIMEOUT).
template <class Message>
void expect_stop(Bench& bench, const Message& target) {
    repeat(bench,
           msg::SetPositionTargetLocalNed{.target_system = 1, .coordinate_frame = 1, .type_mask = 0xdc7, .vy = 3}, 4s);
    ASSERT_NEAR(bench.state().east_m_s, 3, 0.2);
    bench.rig.forget();
    bench.rig.send(target);
    bench.rig.run(2500ms);
    EXPECT_LT(speed(bench), 0.3);
    EXPECT_NEAR(bench.state().relative_altitude_m, 10, 0.5);
    EXPECT_THAT(bench.rig.all<msg::Statustext>(), testing::IsEmpty());
    EXPECT_EQ(bench.state().mode, "GUIDED");
}

template <class Cases, class TargetOf>
void expect_answers(const Cases& cases, TargetOf target_of) {
    for (const MaskCase& c : cases) {
        Bench px4, copter(Autopilot::ardupilot);
        ASSERT_TRUE(px4.fly());
        ASSERT_TRUE(copter.fly());
        {
            const testing::ScopedTrace trace(__FILE__, __LINE__, "PX4: " + testing::PrintToString(c));
            const auto target = target_of(c, asked(c, true));
            c.px4 ? expect_flies(px4, c, target) : expect_refusal(px4, target);
        }
        const testing::ScopedTrace trace(__FILE__, __LINE__, "ArduPilot: " + testing::PrintToString(c));
        const auto target = target_of(c, asked(c, false));
        c.copter ? expect_flies(copter, c, target) : expect_stop(copter, target);
    }
}

TEST(SetpointMasks, LocalTargetsAreFlownAsByARealVehicle) { expect_answers(local_cases, local_target); }

TEST(SetpointMasks, GlobalTargetsAreFlownAsByARealVehicle) { expect_answers(global_cases, global_target); }

TEST(SetpointMasks, ACopterOfArduPilotStopsAtValuesThatItCannotFly) {
    const MaskCase velocity{"velocity", 0xdc7, local_ned, true, false}, place{"place", 0xdf8, relative_int, true, false};
    auto too_fast = local_target(velocity, Asked::velocity), no_number = too_fast;
    too_fast.vx = 1001;
    no_number.vz = nan_f;
    auto no_place = global_target(place, Asked::position), no_height = no_place;
    no_place.lat_int = 950'000'000;
    no_height.alt = nan_f;
    for (const auto& target : {too_fast, no_number}) {
        Bench bench(Autopilot::ardupilot);
        ASSERT_TRUE(bench.fly());
        expect_stop(bench, target);
    }
    for (const auto& target : {no_place, no_height}) {
        Bench bench(Autopilot::ardupilot);
        ASSERT_TRUE(bench.fly());
        expect_stop(bench, target);
    }
}

// --- Rovers of ArduPilot

msg::SetPositionTargetLocalNed rover_target(std::uint16_t mask, float vx, float vy, std::uint8_t frame = local_ned) {
    return {.target_system = 1, .coordinate_frame = frame, .type_mask = mask, .x = 12, .y = 5, .vx = vx, .vy = vy};
}

[[nodiscard]] bool drive(Bench& rover) { return rover.command(176, {1, 15}) == accepted && rover.arm() == accepted; }

TEST(SetpointMasks, ARoverDrivesWhatTheMaskAsks) {
    Bench goal(Autopilot::ardupilot, Kind::rover), velocity(Autopilot::ardupilot, Kind::rover),
        backwards(Autopilot::ardupilot, Kind::rover), turn(Autopilot::ardupilot, Kind::rover);
    for (Bench* const rover : {&goal, &velocity, &backwards, &turn}) ASSERT_TRUE(drive(*rover));
    goal.rig.send(rover_target(0xdfc, 0, 0));  // the height does not matter
    goal.rig.run(15s);
    EXPECT_NEAR(goal.north(), 12, 1);
    EXPECT_NEAR(goal.east(), 5, 1);
    repeat(velocity, rover_target(0xde7, 1, 1), 8s);
    EXPECT_NEAR(velocity.state().north_m_s, 1, 0.2);
    EXPECT_NEAR(velocity.state().east_m_s, 1, 0.2);
    repeat(backwards, rover_target(0x9e7, -1, 0), 5s);  // a velocity with the heading 0
    EXPECT_NEAR(backwards.state().north_m_s, -1, 0.2);
    EXPECT_NEAR(backwards.state().heading_deg, 0, 3);
    auto circle = rover_target(0x5e7, 1, 0);  // a velocity with a turn rate
    circle.yaw_rate = 0.5;
    repeat(turn, circle, 12s);
    EXPECT_NEAR(speed(turn), 1, 0.2);
    EXPECT_LT(std::hypot(turn.north(), turn.east()), 2 * 1 / 0.5 + 1) << "it turns on the spot, nearly";
    for (Bench* const rover : {&goal, &velocity, &backwards, &turn})
        EXPECT_THAT(rover->rig.all<msg::Statustext>(), testing::Each(testing::Field(&msg::Statustext::severity, 6)));
}

// A copter would stop. A yaw or a rate without a velocity means the speed 0.
TEST(SetpointMasks, ARoverDrivesOnIfItCannotObey) {
    struct RoverCase {
        std::uint16_t mask;
        std::uint8_t frame;
        double speed;
    };
    for (const RoverCase& c :
         {RoverCase{0xdff, local_ned, 1.5}, RoverCase{0xdc7, relative_int, 1.5}, RoverCase{0xc3f, local_ned, 1.5},
          RoverCase{0x1c7, local_ned, 1.5}, RoverCase{0x9ff, local_ned, 0}, RoverCase{0x5ff, local_ned, 0}}) {
        Bench rover(Autopilot::ardupilot, Kind::rover);
        ASSERT_TRUE(drive(rover));
        repeat(rover, rover_target(0xdc7, 1.5, 0), 4s);
        rover.rig.forget();
        rover.rig.send(rover_target(c.mask, 0, 1.5, c.frame));
        rover.rig.run(2500ms);
        EXPECT_NEAR(rover.state().north_m_s, c.speed, 0.2) << std::hex << c.mask << ", frame " << int{c.frame};
        EXPECT_NEAR(rover.state().east_m_s, 0, 0.1) << std::hex << c.mask;
        EXPECT_THAT(rover.rig.all<msg::Statustext>(), testing::IsEmpty()) << std::hex << c.mask;
    }
}

// --- Planes of ArduPilot: of both messages, they take the altitude only.

[[nodiscard]] bool circle(Bench& plane) {
    (void)plane.rig.vehicle.set_mode("GUIDED");
    (void)plane.rig.vehicle.arm(true);
    (void)plane.rig.vehicle.take_off(60);
    if (!plane.rig.run_until([&] { return plane.state().relative_altitude_m > 58; }, 60)) return false;
    if (plane.command_int(192, 6, {-1, 1, 0, nan_f}, 473'977'420, 85'455'940, 60) != accepted) return false;
    plane.rig.run(60s);
    plane.rig.forget();
    return plane.state().mode == "GUIDED";
}

TEST(SetpointMasks, APlaneTakesAltitudesOnly) {
    Bench plane(Autopilot::ardupilot, Kind::plane);
    ASSERT_TRUE(circle(plane));
    plane.rig.send(global_target({"far away", 0xdf8, relative_int, false, false}, Asked::position));
    plane.rig.send(msg::SetPositionTargetGlobalInt{.target_system = 1,
                                                   .coordinate_frame = relative_int,
                                                   .type_mask = 0xdf8,
                                                   .lat_int = 474'100'000,
                                                   .lon_int = 85'455'940,
                                                   .alt = 80});
    plane.rig.run(40s);
    EXPECT_NEAR(plane.state().relative_altitude_m, 80, 4);
    EXPECT_LT(std::hypot(plane.north(), plane.east()), 120) << "it circles where it did";
    EXPECT_THAT(plane.rig.all<msg::Statustext>(), testing::IsEmpty());
    plane.rig.send(rover_target(0xdc7, 15, 0));
    plane.rig.run(20s);
    EXPECT_LT(std::hypot(plane.north(), plane.east()), 120) << "no velocity moves it";
    EXPECT_THAT(plane.rig.all<msg::Statustext>(), testing::IsEmpty());
    ASSERT_EQ(plane.command_int(192, 6, {-1, 1, 0, nan_f}, 474'067'420, 85'455'940, 60), accepted);
    plane.rig.run(5s);
    plane.rig.send(msg::SetPositionTargetGlobalInt{
        .target_system = 1, .coordinate_frame = relative_int, .type_mask = 0xdf8, .alt = 90});
    plane.rig.run(100s);
    EXPECT_NEAR(plane.north(), 1000, 120) << "on its way, it goes on";
    EXPECT_NEAR(plane.state().relative_altitude_m, 90, 4);
}

TEST(SetpointMasks, APlaneReportsANewAltitudeFromALocalTarget) {
    Bench plane(Autopilot::ardupilot, Kind::plane);
    ASSERT_TRUE(circle(plane));
    plane.rig.send(msg::SetPositionTargetLocalNed{
        .target_system = 1, .coordinate_frame = local_offset, .type_mask = 0xffb, .z = -20});
    EXPECT_EQ(plane.text(), "Change alt to 80.0");
    plane.rig.run(40s);
    EXPECT_NEAR(plane.state().relative_altitude_m, 80, 4);
    plane.rig.forget();
    plane.rig.send(msg::SetPositionTargetGlobalInt{
        .target_system = 1, .coordinate_frame = local_ned, .type_mask = 0xdf8, .alt = 100});
    const auto chunks = plane.rig.all<msg::Statustext>();  // of one text
    ASSERT_EQ(chunks.size(), 2u);
    EXPECT_EQ(std::string(chunks[0].text.data(), chunks[0].text.size()) + plane.text(),
              "Invalid coord frame in SET_POSTION_TARGET_GLOBAL_INT");
    plane.rig.run(20s);
    EXPECT_NEAR(plane.state().relative_altitude_m, 80, 4);
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
