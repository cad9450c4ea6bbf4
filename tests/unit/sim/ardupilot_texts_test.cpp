// SPDX-License-Identifier: MIT
// The texts of ArduPilot's pre-arm checks, fail-safes and fences. Texts, severities and moments are those of ArduPilot
// 4.6: AP_Arming.cpp, AP_BattMonitor.cpp, AC_Fence.cpp, AP_Vehicle.cpp, and of ArduCopter, ArduPlane and Rover
// AP_Arming.cpp, events.cpp, failsafe.cpp, fence.cpp and mode.cpp.
#include <gmock/gmock.h>

#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/enums/mav_sys_status_sensor.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "unit/sim/bench.hpp"

namespace mavloom::sim::ardupilot_texts_tests {
namespace {

using namespace test;
using namespace std::chrono_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Not;

constexpr int critical = 2, warning = 4, notice = 5, info = 6;
constexpr int start_compass = 42424, accept_compass = 42425, cancel_compass = 42426, calibrate = 241, position = 42429;
constexpr int set_mode = 176, reboot = 246;
constexpr std::uint8_t standby = 3;

// All texts since the bench forgot them, each with its severity.
using Text = std::pair<int, std::string>;
std::vector<Text> texts(const Bench& bench) {
    std::vector<Text> all;
    for (const auto& m : bench.rig.all<msg::Statustext>())
        all.emplace_back(m.severity, std::string(m.text.data(), strnlen(m.text.data(), m.text.size())));
    return all;
}

void expect_arming_refused(Bench& bench, std::string_view text) {
    EXPECT_EQ(bench.arm(), failed);
    EXPECT_THAT(texts(bench), ElementsAre(Text(critical, text)));
}

void expect_arming_after_reboot(Bench& bench) {
    EXPECT_EQ(bench.command(reboot, {1}), accepted);
    bench.rig.run(8s);
    EXPECT_EQ(bench.arm(), accepted);
}

// --- Pre-arm checks

// The need begins when the calibration does, and remains if it is cancelled.
TEST(ArduPilotTexts, ACompassCalibrationNeedsAReboot) {
    Bench bench(Autopilot::ardupilot);
    ASSERT_EQ(bench.command(start_compass, {1}), accepted);
    bench.rig.run(1s);
    expect_arming_refused(bench, "PreArm: Compass calibration running");
    bench.rig.run(15s);
    ASSERT_EQ(bench.command(accept_compass, {1}), accepted);
    bench.rig.run(1500ms);
    EXPECT_EQ(bench.rig.last<msg::SysStatus>()->onboard_control_sensors_health & msg::MAV_SYS_STATUS_PREARM_CHECK, 0u);
    EXPECT_EQ(bench.rig.last<msg::Heartbeat>()->system_status, standby);
    expect_arming_refused(bench, "PreArm: Compass calibrated requires reboot");
    expect_arming_after_reboot(bench);
}

TEST(ArduPilotTexts, ACancelledCompassCalibrationNeedsARebootToo) {
    Bench bench(Autopilot::ardupilot);
    ASSERT_EQ(bench.command(start_compass, {1}), accepted);
    ASSERT_EQ(bench.command(cancel_compass, {1}), accepted);
    expect_arming_refused(bench, "PreArm: Compass calibrated requires reboot");
    expect_arming_after_reboot(bench);
}

TEST(ArduPilotTexts, AnAccelerometerCalibrationNeedsAReboot) {
    Bench bench(Autopilot::ardupilot);
    ASSERT_EQ(bench.command(calibrate, {0, 0, 0, 0, 1}), accepted);
    expect_arming_refused(bench, "PreArm: 3D Accel calibration needed");
    for (float side = 1; side <= 6; ++side) ASSERT_EQ(bench.command(position, {side}), accepted);
    expect_arming_refused(bench, "PreArm: Accels calibrated requires reboot");
    expect_arming_after_reboot(bench);
}

TEST(ArduPilotTexts, AVehicleThatIsNotReadyStatesWhy) {
    Rig rig(VehicleOptions{.autopilot = Autopilot::ardupilot, .ready_after = 10s});
    rig.run(1s);
    const auto without_position = rig.vehicle.arm(false);
    ASSERT_FALSE(without_position);
    EXPECT_EQ(without_position.error().text, "PreArm: GPS 1: Bad fix");
    rig.run(6s);
    const auto booting = rig.vehicle.arm(false);
    ASSERT_FALSE(booting);
    EXPECT_EQ(booting.error().text, "PreArm: AHRS: EKF3 still initialising");
}

TEST(ArduPilotTexts, AModeThatForbidsToArmIsNamed) {
    Bench copter(Autopilot::ardupilot), plane(Autopilot::ardupilot, Kind::plane),
        rover(Autopilot::ardupilot, Kind::rover);
    ASSERT_EQ(copter.command(set_mode, {1, 6}), accepted);
    expect_arming_refused(copter, "Arm: RTL mode not armable");
    ASSERT_EQ(copter.command(set_mode, {1, 3}), accepted);
    expect_arming_refused(copter, "PreArm: Mode requires mission");
    ASSERT_EQ(plane.command(set_mode, {1, 11}), accepted);
    expect_arming_refused(plane, "PreArm: RTL mode not armable");
    ASSERT_EQ(rover.command(set_mode, {1, 11}), accepted);
    expect_arming_refused(rover, "PreArm: Mode not armable");
}

// --- Modes

TEST(ArduPilotTexts, AModeThatDoesNotExistHasNoName) {
    for (const Kind kind : {Kind::quad, Kind::plane, Kind::rover}) {
        Bench bench(Autopilot::ardupilot, kind);
        EXPECT_EQ(bench.command(set_mode, {1, 99}), failed);
        EXPECT_THAT(texts(bench), ElementsAre(Text(warning, "No such mode 99")));
    }
}

TEST(ArduPilotTexts, AutoNeedsAMission) {
    Bench copter(Autopilot::ardupilot), rover(Autopilot::ardupilot, Kind::rover);
    ASSERT_TRUE(copter.fly());
    EXPECT_EQ(copter.command(set_mode, {1, 3}), failed);
    EXPECT_THAT(texts(copter), ElementsAre(Text(warning, "Mode change to AUTO failed: init failed")));
    ASSERT_EQ(rover.arm(), accepted);
    EXPECT_EQ(rover.command(set_mode, {1, 10}), failed);
    EXPECT_THAT(texts(rover),
                ElementsAre(Text(notice, "No Mission. Can't set AUTO."), Text(warning, "Flight mode change failed")));
}

// --- Fail-safes

// Without an action, too. The numbers are those of BATTERY_STATUS.
TEST(ArduPilotTexts, ALowBatteryIsAnnouncedWithItsVoltageWhileArmed) {
    Bench bench(Autopilot::ardupilot);
    const double capacity = bench.rig.vehicle.parameter("BATT_CAPACITY").value_or(0);
    ASSERT_TRUE(bench.rig.vehicle.set_parameter("BATT_LOW_MAH", capacity - 1));
    ASSERT_TRUE(bench.rig.vehicle.set_parameter("BATT_CRT_MAH", capacity - 20));
    ASSERT_TRUE(bench.fly());
    bench.rig.run(3s);
    const auto all = texts(bench);
    const auto battery = bench.rig.last<msg::BatteryStatus>();
    ASSERT_TRUE(battery);
    const auto level = std::ranges::find_if(
        all, [](const Text& text) { return text.second.starts_with("Battery 1 is critical"); });
    ASSERT_NE(level, all.end());
    double volts = 0, used = 0;
    ASSERT_EQ(std::sscanf(level->second.c_str(), "Battery 1 is critical %lfV used %lf mAh", &volts, &used), 2);
    EXPECT_EQ(level->first, warning);
    double shown = 0;
    for (const std::uint16_t cell : battery->voltages) shown += cell == 0xffff ? 0 : cell / 1e3;
    EXPECT_NEAR(volts, shown, 0.5);
    EXPECT_GE(used, 20);
    EXPECT_LE(used, battery->current_consumed);
    EXPECT_THAT(all, Contains(Text(warning, "Battery Failsafe")));

    Bench standing(Autopilot::ardupilot);
    ASSERT_TRUE(standing.rig.vehicle.set_parameter("BATT_LOW_MAH", capacity));
    standing.rig.run(5s);
    EXPECT_THAT(texts(standing), IsEmpty());
}

msg::Heartbeat ground_station() { return {.type = 6, .autopilot = 8}; }

void lose_ground_station(Bench& bench) {
    bench.rig.send(ground_station());
    bench.rig.run(1s);
    bench.rig.forget();
    bench.rig.run(7s);
}

TEST(ArduPilotTexts, ALostGroundStationIsAnnouncedIfAParameterAsksForIt) {
    Bench indifferent(Autopilot::ardupilot), copter(Autopilot::ardupilot), rover(Autopilot::ardupilot, Kind::rover);
    lose_ground_station(indifferent);
    EXPECT_THAT(texts(indifferent), IsEmpty());
    for (Bench* const bench : {&copter, &rover}) {
        ASSERT_TRUE(bench->rig.vehicle.set_parameter("FS_GCS_ENABLE", 1));
        lose_ground_station(*bench);
        EXPECT_THAT(texts(*bench), ElementsAre(Text(warning, "GCS Failsafe")));
        bench->rig.forget();
        bench->rig.send(ground_station());
        bench->rig.run(1s);
        EXPECT_THAT(texts(*bench), ElementsAre(Text(bench == &rover ? info : warning, "GCS Failsafe Cleared")));
    }
}

TEST(ArduPilotTexts, APlaneNamesTheModeOfItsFailSafe) {
    Bench plane(Autopilot::ardupilot, Kind::plane);
    ASSERT_TRUE(plane.rig.vehicle.set_parameter("FS_GCS_ENABL", 1));
    ASSERT_TRUE(plane.rig.vehicle.set_parameter("FS_LONG_ACTN", 1));
    (void)plane.rig.vehicle.set_mode("GUIDED");
    ASSERT_TRUE(plane.rig.vehicle.arm(true));
    ASSERT_TRUE(plane.rig.vehicle.take_off(40));
    plane.rig.run(20s);
    lose_ground_station(plane);
    EXPECT_THAT(texts(plane), Contains(Text(warning, "GCS Failsafe On: RTL")));
    plane.rig.send(ground_station());
    plane.rig.run(1s);
    EXPECT_THAT(texts(plane), Contains(Text(warning, "GCS Failsafe Off")));
}

// --- Fences

TEST(ArduPilotTexts, ABreachNamesTheFences) {
    Bench bench(Autopilot::ardupilot);
    for (const auto& [name, value] :
         {std::pair{"FENCE_ENABLE", 1.0}, std::pair{"FENCE_TYPE", 7.0}, std::pair{"FENCE_RADIUS", 30.0},
          std::pair{"FENCE_ALT_MAX", 12.0}, std::pair{"FENCE_ACTION", 0.0}})
        ASSERT_TRUE(bench.rig.vehicle.set_parameter(name, value));
    ASSERT_TRUE(bench.fly());
    bench.rig.forget();
    ASSERT_EQ(bench.command_int(192, 6, {-1, 1, 0, nan_f}, 473'981'920, 85'455'940, 10), accepted);  // 50 m north
    bench.rig.run(15s);
    EXPECT_THAT(texts(bench), ElementsAre(Text(notice, "Circle fence breached")));
    ASSERT_EQ(bench.command_int(192, 6, {-1, 1, 0, nan_f}, 473'981'920, 85'455'940, 15), accepted);
    bench.rig.run(10s);
    EXPECT_THAT(texts(bench), ElementsAre(Text(notice, "Max Alt fence breached")));
    ASSERT_EQ(bench.command_int(192, 6, {-1, 1, 0, nan_f}, 473'977'420, 85'455'940, 10), accepted);
    bench.rig.run(20s);
    EXPECT_THAT(texts(bench), ElementsAre(Text(notice, "Fence breach cleared")));
}

TEST(ArduPilotTexts, ARoverActsOnItsFenceWithoutAText) {
    Bench rover(Autopilot::ardupilot, Kind::rover);
    ASSERT_TRUE(rover.rig.vehicle.set_parameter("FENCE_ENABLE", 1));
    ASSERT_TRUE(rover.rig.vehicle.set_parameter("FENCE_RADIUS", 30));
    ASSERT_EQ(rover.command(set_mode, {1, 15}), accepted);
    ASSERT_EQ(rover.arm(), accepted);
    ASSERT_EQ(rover.command_int(192, 6, {-1, 1, 0, nan_f}, 473'981'920, 85'455'940, 0), accepted);
    ASSERT_TRUE(rover.rig.run_until([&] { return rover.state().mode == "RTL"; }, 60));
    for (const auto& [severity, text] : texts(rover)) EXPECT_THAT(text, Not(testing::HasSubstr("ence")));
}

}  // namespace
}  // namespace mavloom::sim::ardupilot_texts_tests
