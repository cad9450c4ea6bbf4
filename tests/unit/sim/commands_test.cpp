// SPDX-License-Identifier: MIT
// Commands that fly and maintain a vehicle, as clients send them. Sources: MAVLink common.xml and its guide, "Command
// Protocol"; answers of PX4 1.17.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <string_view>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/command_cancel.hpp"
#include "mavloom/msg/enums/mav_sys_status_sensor.hpp"
#include "mavloom/msg/gps_global_origin.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/mission_count.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/mission_item_int.hpp"
#include "mavloom/msg/param_request_read.hpp"
#include "mavloom/msg/param_set.hpp"
#include "mavloom/msg/param_value.hpp"
#include "mavloom/msg/play_tune_v2.hpp"
#include "mavloom/msg/set_mode.hpp"
#include "mavloom/msg/supported_tunes.hpp"
#include "mavloom/msg/sys_status.hpp"
#include "unit/sim/bench.hpp"

namespace mavloom::sim {
namespace {

using namespace std::chrono_literals;
using namespace test;

constexpr std::int32_t no_coordinate = std::numeric_limits<std::int32_t>::max();
constexpr std::uint32_t px4_hold = 0x03040000, px4_takeoff = 0x02040000, px4_mission = 0x04040000,
                        px4_return = 0x05040000, px4_land = 0x06040000, px4_orbit = 0x01030000;
constexpr Peer second_client{LinkId{1}, {SystemId{245}, ComponentId{190}}};

// --- Arming

TEST(FlightCommands, ArmAndDisarm) {
    Bench bench;
    EXPECT_EQ(bench.arm(), accepted);
    EXPECT_EQ(bench.text().substr(0, 25), "Armed by external command");
    EXPECT_TRUE(bench.state().armed);
    EXPECT_EQ(bench.rig.last<msg::Heartbeat>()->base_mode & 128, 128) << "shown at once";
    EXPECT_EQ(bench.arm(), accepted) << "it is armed";
    EXPECT_EQ(bench.command(400, {0}), accepted);
    EXPECT_FALSE(bench.state().armed);
    EXPECT_EQ(bench.command(400, {0}), accepted) << "it is disarmed";
}

TEST(FlightCommands, RefuseToArmByAStrangeNumber) {
    Bench bench;
    for (const float value : {2.f, -1.f, 0.5f, nan_f, inf_f}) EXPECT_EQ(bench.command(400, {value}), denied);
    EXPECT_FALSE(bench.state().armed);
}

TEST(FlightCommands, RefuseToArmBeforeTheVehicleIsReady) {
    Rig rig(VehicleOptions{.ready_after = 5s});
    rig.run(1.0);
    const auto arm = [&](float magic) {
        rig.forget();
        rig.send(msg::CommandLong{.target_system = 1, .command = 400, .param1 = 1, .param2 = magic});
        return rig.last<msg::CommandAck>()->result;
    };
    EXPECT_EQ(arm(0), temporarily_rejected);
    EXPECT_EQ(rig.all<msg::Statustext>().size(), 1u);
    EXPECT_EQ(arm(2989), accepted) << "QGroundControl forces arming by ArduPilot's number";
}

TEST(FlightCommands, DisarmInTheAirOnlyByForce) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(400, {0}), temporarily_rejected);
    EXPECT_TRUE(bench.state().armed);
    EXPECT_EQ(bench.command(400, {0, 21196}), accepted);
    EXPECT_FALSE(bench.state().armed);
}

TEST(FlightCommands, TerminateAnArmedVehicle) {
    Bench bench;
    EXPECT_EQ(bench.command(185, {0}), accepted) << "nothing to do";
    EXPECT_EQ(bench.command(185, {nan_f}), denied);
    ASSERT_EQ(bench.arm(), accepted);
    EXPECT_EQ(bench.command(185, {1}), accepted);
    EXPECT_FALSE(bench.state().armed);
    EXPECT_EQ(bench.state().custom_mode, 0x000a0000u);
    EXPECT_NE(bench.arm(), accepted);
}

// --- Modes

TEST(FlightCommands, SetTheModeInAllForms) {
    Bench bench;
    EXPECT_EQ(bench.command(176, {1, 4, 5}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_return);
    EXPECT_EQ(bench.rig.last<msg::Heartbeat>()->custom_mode, px4_return);
    EXPECT_EQ(bench.command(176, {29, 4, 3}), accepted) << "pymavlink's base mode";
    EXPECT_EQ(bench.state().custom_mode, px4_hold);
    EXPECT_EQ(bench.command(176, {1, 4, nan_f}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_mission) << "auto without a sub mode";

    bench.rig.send(msg::SetMode{.target_system = 1, .base_mode = 157, .custom_mode = px4_land});
    EXPECT_EQ(bench.answer(176), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_land);
    EXPECT_EQ(bench.command(262, {2}), accepted) << "the standard mode Orbit";
    EXPECT_EQ(bench.state().custom_mode, px4_orbit);
    EXPECT_EQ(bench.command(262, {3}), unsupported);
    EXPECT_EQ(bench.command(262, {0}), denied);
}

TEST(FlightCommands, RefuseUnknownModes) {
    Bench bench;
    EXPECT_EQ(bench.command(176, {1, 44, 0}), temporarily_rejected);
    EXPECT_FALSE(bench.text().empty());
    for (const float value : {nan_f, inf_f, -1.f, 1e30f}) {
        EXPECT_EQ(bench.command(176, {value, 4, 3}), denied) << value;
        EXPECT_EQ(bench.command(176, {1, value, 3}), denied) << value;
    }
    EXPECT_EQ(bench.state().custom_mode, px4_hold);
    Bench copter(Autopilot::ardupilot);
    EXPECT_EQ(copter.command(176, {1, 8}), failed);
    EXPECT_EQ(copter.command(176, {1, 4}), accepted);
    EXPECT_EQ(copter.state().mode, "GUIDED");
}

TEST(FlightCommands, HoldByTheCommandThatPymavlinkSends) {
    Bench bench;
    (void)bench.command(176, {1, 4, 5});
    EXPECT_EQ(bench.command(17, {}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_hold);
}

// --- Take-off

TEST(FlightCommands, TakeOffToTheAltitudeThatQGroundControlSends) {
    Bench bench;
    EXPECT_EQ(bench.command(22, {-1, 0, 0, nan_f, nan_f, nan_f, home_altitude + 12}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_takeoff) << "even while it is disarmed";
    ASSERT_EQ(bench.arm(), accepted);
    EXPECT_TRUE(bench.rig.run_until([&] { return bench.state().custom_mode == px4_hold; }, 30));
    bench.rig.run(3.0);
    EXPECT_NEAR(bench.state().relative_altitude_m, 12, 0.6);
}

TEST(FlightCommands, TakeOffWithoutAnAltitude) {
    Bench bench;
    EXPECT_EQ(bench.command(22, {nan_f, nan_f, nan_f, nan_f, nan_f, nan_f, nan_f}), accepted) << "MAVSDK";
    ASSERT_EQ(bench.arm(), accepted);
    EXPECT_TRUE(bench.rig.run_until([&] { return bench.state().custom_mode == px4_hold; }, 20));
    bench.rig.run(3.0);
    EXPECT_NEAR(bench.state().relative_altitude_m, 2.5, 0.5) << "MIS_TAKEOFF_ALT";
}

// MAVProxy's `takeoff 10` sends zeros and a height above home.
TEST(FlightCommands, TakeOffToAHeightAboveHome) {
    Bench bench;
    EXPECT_EQ(bench.command(22, {0, 0, 0, 0, 0, 0, 10}), accepted);
    ASSERT_EQ(bench.arm(), accepted);
    EXPECT_TRUE(bench.rig.run_until([&] { return bench.state().custom_mode == px4_hold; }, 30));
    bench.rig.run(3.0);
    EXPECT_NEAR(bench.state().relative_altitude_m, 10, 0.5);
    EXPECT_NEAR(bench.north(), 0, 2) << "0/0 is here";
}

TEST(FlightCommands, ArduPilotTakesOffInGuidedAndArmed) {
    Bench bench(Autopilot::ardupilot);
    EXPECT_EQ(bench.command(22, {0, 0, 0, 0, 0, 0, 10}), failed);
    ASSERT_EQ(bench.command(176, {1, 4}), accepted);
    EXPECT_EQ(bench.command(22, {0, 0, 0, 0, 0, 0, 10}), failed);
    ASSERT_EQ(bench.arm(), accepted);
    EXPECT_EQ(bench.command(22, {0, 0, 0, 0, 0, 0, 10}), accepted);
    EXPECT_TRUE(bench.rig.run_until([&] { return bench.state().relative_altitude_m > 9.5; }, 20));
    EXPECT_EQ(bench.state().mode, "GUIDED");
}

// --- Going somewhere

TEST(FlightCommands, RepositionInEveryFrame) {
    struct Case {
        int frame;
        float z;
    };
    for (const Case& c :
         {Case{5, home_altitude + 20}, Case{0, home_altitude + 20}, Case{6, 20}, Case{3, 20}, Case{11, 20}}) {
        Bench bench;
        ASSERT_TRUE(bench.fly());
        EXPECT_EQ(bench.command_int(192, c.frame, {-1, 1, 0, 1.5f}, 474'000'000, 85'460'000, c.z), accepted) << c.frame;
        EXPECT_EQ(bench.state().custom_mode, px4_hold);
        bench.rig.run(90.0);
        EXPECT_NEAR(bench.state().relative_altitude_m, 20, 0.5) << c.frame;
        EXPECT_NEAR(bench.state().latitude_deg, 47.4, 2e-5);
        EXPECT_NEAR(bench.state().longitude_deg, 8.546, 3e-5);
        EXPECT_NEAR(bench.state().heading_deg, 1.5 * 180 / 3.14159, 3) << "radians";
    }
}

TEST(FlightCommands, RefuseAPositionInALocalFrame) {
    Bench bench;
    for (const int frame : {1, 8, 12, 99})
        EXPECT_EQ(bench.command_int(192, frame, {-1, 1, 0, nan_f}, 100'000, 0, -10), 9) << frame;
}

TEST(FlightCommands, RefusePositionsThatDoNotExist) {
    Bench bench;
    EXPECT_EQ(bench.command(192, {-1, 1, 0, nan_f, 95, 8, 500}), denied);
    EXPECT_EQ(bench.command(192, {-1, 1, 0, nan_f, 47, 500, 500}), denied);
    EXPECT_EQ(bench.command(192, {-1, 1, 0, nan_f, 47, nan_f, 500}), denied) << "half a position";
    EXPECT_EQ(bench.command(34, {1e9f, 1, 0, 0, 47, 8, 500}), denied);
    EXPECT_EQ(bench.command(34, {20, 1, 77, 0, nan_f, nan_f, nan_f}), denied) << "yaw behaviour";
    EXPECT_EQ(bench.command(201, {3, 0, 0, 0, 95, 8, 500}), denied);
}

// QGroundControl pauses by a position of NaN, which becomes an integer on its way.
TEST(FlightCommands, RepositionToNowhereStops) {
    for (const std::int32_t nothing : {no_coordinate, std::numeric_limits<std::int32_t>::min(), 0x7ff80000}) {
        Bench bench;
        ASSERT_TRUE(bench.fly());
        (void)bench.command_int(192, 6, {-1, 1, 0, nan_f}, 474'000'000, 85'460'000, 10);
        bench.rig.run(5.0);
        EXPECT_EQ(bench.command_int(192, 0, {-1, 1, 0, nan_f}, nothing, nothing, nan_f), accepted);
        bench.rig.run(5.0);
        EXPECT_NEAR(std::hypot(bench.state().north_m_s, bench.state().east_m_s), 0, 0.2);
        EXPECT_GT(bench.north(), 5);
    }
}

TEST(FlightCommands, RepositionWithoutTheFlagOnlyInHold) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(20, {}), accepted);
    EXPECT_EQ(bench.command(192, {-1, 0, 0, nan_f, nan_f, nan_f, home_altitude + 30}), denied);
    EXPECT_EQ(bench.command(176, {1, 4, 3}), accepted);
    EXPECT_EQ(bench.command(192, {-1, 0, 0, nan_f, nan_f, nan_f, home_altitude + 30}), accepted);
}

TEST(FlightCommands, ChangeAltitudeByItsFrame) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(186, {15, 3}), accepted);
    EXPECT_TRUE(bench.rig.run_until([&] { return bench.state().relative_altitude_m > 14.7; }, 20));
    EXPECT_EQ(bench.command(186, {home_altitude + 12, 0}), accepted);
    EXPECT_TRUE(bench.rig.run_until([&] { return bench.state().relative_altitude_m < 12.3; }, 20));
    for (const float value : {nan_f, inf_f}) EXPECT_EQ(bench.command(186, {value, 0}), denied);
    EXPECT_EQ(bench.command(186, {10, 1}), denied) << "a local frame";
    (void)bench.command(20, {});
    EXPECT_EQ(bench.command(186, {15, 3}), temporarily_rejected) << "not in Return";
}

TEST(FlightCommands, ChangeTheSpeed) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(178, {1, 2, -1, 0}), accepted);
    (void)bench.command_int(192, 6, {-1, 1, 0, nan_f}, 474'100'000, 85'456'000, 10);
    bench.rig.run(10.0);
    EXPECT_NEAR(bench.state().north_m_s, 2, 0.3);
    EXPECT_EQ(bench.command(178, {1, -1, -1, 0}), accepted);
    bench.rig.run(10.0);
    EXPECT_NEAR(bench.state().north_m_s, 5, 0.5) << "back to MPC_XY_CRUISE";
    EXPECT_EQ(bench.command(178, {9, 5}), denied);
    EXPECT_EQ(bench.command(178, {nan_f, 5}), denied);
    EXPECT_EQ(bench.command(178, {1, inf_f}), denied);
}

TEST(FlightCommands, OrbitAroundAPoint) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command_int(34, 6, {20, 4, 0, 0}, 473'977'420, 85'455'940, 15), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_orbit);
    bench.rig.run(40.0);
    for (int i = 0; i < 10; ++i) {
        bench.rig.run(2.0);
        EXPECT_NEAR(std::hypot(bench.north(), bench.east()), 20, 2);
    }
    EXPECT_NEAR(bench.state().relative_altitude_m, 15, 0.5);
}

TEST(FlightCommands, LandAndReturn) {
    Bench bench;
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(20, {}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_return);
    EXPECT_EQ(bench.command(21, {0, 0, 0, nan_f, nan_f, nan_f, nan_f}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_land);
    EXPECT_TRUE(bench.rig.run_until([&] { return !bench.state().armed; }, 40));
}

TEST(FlightCommands, PauseAndContinueAMission) {
    Bench bench;
    EXPECT_EQ(bench.command(193, {2}), denied);
    EXPECT_EQ(bench.command(193, {nan_f}), denied);
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(193, {0}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_hold);
}

// --- Missions

void upload(Bench& bench, std::uint16_t count, std::uint16_t land_start = 0xffff) {
    bench.rig.send(msg::MissionCount{.target_system = 1, .target_component = 1, .count = count});
    for (std::uint16_t i = 0; i < count; ++i) {
        msg::MissionItemInt item{.target_system = 1, .target_component = 1, .seq = i, .frame = 6, .command = 16};
        item.current = i == 0;
        item.x = 473'980'000;
        item.y = 85'456'000 + i * 1000;
        item.z = 10;
        item.autocontinue = 1;
        if (i == land_start) item.command = 189;
        bench.rig.send(item);
    }
}

TEST(FlightCommands, StartAMissionAtAnItem) {
    Bench bench;
    EXPECT_EQ(bench.command(300, {-1}), denied) << "no mission";
    upload(bench, 4);
    for (const float first : {4.f, -2.f, 1e9f, inf_f}) EXPECT_EQ(bench.command(300, {first}), denied) << first;
    EXPECT_EQ(bench.command(300, {2}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_mission);
    EXPECT_TRUE(bench.state().armed);
    EXPECT_EQ(bench.state().mission_current, 2);
}

TEST(FlightCommands, SetTheCurrentItem) {
    Bench bench;
    upload(bench, 4);
    ASSERT_EQ(bench.command(300, {0}), accepted);
    EXPECT_EQ(bench.command(224, {3, 0}), accepted);
    ASSERT_TRUE(bench.rig.last<msg::MissionCurrent>());
    EXPECT_EQ(bench.rig.last<msg::MissionCurrent>()->seq, 3);
    EXPECT_EQ(bench.command(224, {-1, 1}), accepted);
    for (const float seq : {4.f, 70'000.f, -2.f, nan_f, inf_f}) EXPECT_EQ(bench.command(224, {seq}), failed) << seq;
    EXPECT_EQ(bench.state().mission_current, 3);
}

TEST(FlightCommands, JumpToTheLandingOfAMission) {
    Bench bench;
    upload(bench, 4);
    EXPECT_EQ(bench.command(189, {}), cancelled) << "the mission has none";
    upload(bench, 4, 2);
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(189, {}), accepted);
    EXPECT_EQ(bench.state().custom_mode, px4_mission);
    EXPECT_GE(bench.state().mission_current, 2);
}

// --- Home, origin, region of interest, fence

TEST(FlightCommands, SetHome) {
    Bench bench;
    EXPECT_EQ(bench.command_int(179, 0, {0, 0, 0, 0}, 473'980'000, 85'456'000, 480), accepted);
    EXPECT_NEAR(bench.state().relative_altitude_m, 9.4, 0.1);
    EXPECT_EQ(bench.command(179, {1, 0, 0, 0, nan_f, nan_f, nan_f}), accepted);
    EXPECT_NEAR(bench.state().relative_altitude_m, 0, 0.1);
    EXPECT_EQ(bench.command(179, {0, 0, 0, 0, nan_f, 8, 480}), denied);
    EXPECT_EQ(bench.command(179, {0, 0, 0, 0, 47, 8, nan_f}), denied);
    EXPECT_EQ(bench.command(179, {0, 0, 0, 0, 95, 8, 480}), denied);
}

TEST(FlightCommands, SetTheOriginAndReportItOnAllLinks) {
    Bench bench;
    bench.rig.vehicle.open(LinkId{2}, {.profile = Profile::lite}, bench.rig.now());
    EXPECT_EQ(bench.command_int(611, 0, {}, 473'970'000, 85'450'000, 400), accepted);
    for (const LinkId link : {LinkId{1}, LinkId{2}}) {
        ASSERT_TRUE(bench.rig.last<msg::GpsGlobalOrigin>(link));
        EXPECT_EQ(bench.rig.last<msg::GpsGlobalOrigin>(link)->latitude, 473'970'000);
        EXPECT_EQ(bench.rig.last<msg::GpsGlobalOrigin>(link)->altitude, 400'000);
    }
    EXPECT_EQ(bench.command_int(611, 0, {}, no_coordinate, 85'450'000, 400), denied);
}

TEST(FlightCommands, LookAtARegionOfInterest) {
    for (const auto kind : {Autopilot::px4, Autopilot::ardupilot}) {
        Bench bench(kind);
        EXPECT_EQ(bench.command(195, {0, 0, 0, 0, 47.398f, 8.5456f, 490}), accepted);
        EXPECT_EQ(bench.command(195, {0, 0, 0, 0, nan_f, nan_f, nan_f}), denied);
        EXPECT_EQ(bench.command(201, {3, 0, 0, 0, 47.398f, 8.5456f, 490}), accepted);
        EXPECT_EQ(bench.command(201, {0}), accepted);
        EXPECT_EQ(bench.command(196, {}), accepted);
        EXPECT_EQ(bench.command(197, {}), accepted);
    }
}

TEST(FlightCommands, ArduPilotKeepsTheFenceInAParameter) {
    Bench bench(Autopilot::ardupilot);
    EXPECT_EQ(bench.command(207, {1}), accepted);
    ASSERT_TRUE(bench.rig.last<msg::ParamValue>());
    EXPECT_EQ(std::string_view(bench.rig.last<msg::ParamValue>()->param_id.data()), "FENCE_ENABLE");
    EXPECT_EQ(bench.rig.last<msg::ParamValue>()->param_value, 1);
    EXPECT_EQ(bench.command(207, {nan_f}), denied);
    Bench px4;
    EXPECT_EQ(px4.command(207, {0}), accepted);
}

TEST(FlightCommands, ArduPilotTurnsInGuided) {
    Bench bench(Autopilot::ardupilot);
    EXPECT_EQ(bench.command(115, {90, 20, 1, 0}), failed) << "not in Guided";
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(115, {90, 20, 1, 0}), accepted);
    bench.rig.run(15.0);
    EXPECT_NEAR(bench.state().heading_deg, 90, 3);
    EXPECT_EQ(bench.command(115, {30, 20, -1, 1}), accepted);
    bench.rig.run(10.0);
    EXPECT_NEAR(bench.state().heading_deg, 60, 3);
    EXPECT_EQ(bench.command(115, {500, 20, 1, 0}), failed);
    EXPECT_EQ(bench.command(115, {nan_f, 20, 1, 0}), failed);
    EXPECT_EQ(Bench().command(115, {90, 20, 1, 0}), unsupported) << "PX4 does not know it";
}

TEST(FlightCommands, ZeroZeroIsNoHome) {
    Bench bench;
    bench.rig.run(5.0);
    const double before = bench.state().relative_altitude_m;
    EXPECT_EQ(bench.command(179, {0, 0, 0, 0, 0, 0, 0}), denied);
    EXPECT_EQ(bench.command(179, {0, 0, 0, 0, 10, 10, 0}), denied) << "thousands of kilometres away";
    bench.rig.run(0.1);
    EXPECT_NEAR(bench.state().relative_altitude_m, before, 0.5);
}

TEST(FlightCommands, HalfAModeIsNone) { EXPECT_EQ(Bench().command(512, {435, 1.5f}), denied); }

TEST(Console, TakeOffBringsAnArduPilotCopterIntoGuided) {
    Rig rig(VehicleOptions{.autopilot = Autopilot::ardupilot, .ready_after = 0ms});
    rig.run(3.0);
    ASSERT_TRUE(rig.vehicle.take_off(10));
    rig.run(20.0);
    EXPECT_EQ(rig.vehicle.status().mode, "GUIDED");
    EXPECT_NEAR(rig.vehicle.status().relative_altitude_m, 10, 1);
}

TEST(Console, RefusesParametersThatTheirTypeCannotHold) {
    Rig rig;
    EXPECT_FALSE(rig.vehicle.set_parameter("MIS_TAKEOFF_ALT", 1e300));
    EXPECT_FALSE(rig.vehicle.set_parameter("MIS_TAKEOFF_ALT", std::nan("")));
    EXPECT_FALSE(rig.vehicle.set_parameter("NAV_DLL_ACT", 2.5));
    EXPECT_FALSE(rig.vehicle.set_parameter("NAV_DLL_ACT", 3e9));
    EXPECT_TRUE(rig.vehicle.set_parameter("NAV_DLL_ACT", 2));
}

TEST(FlightCommands, ArduPilotNamesTheModeThatForbidsToArm) {
    Rig rig(VehicleOptions{.autopilot = Autopilot::ardupilot, .ready_after = 0ms});
    rig.run(3.0);
    ASSERT_TRUE(rig.vehicle.set_mode("RTL"));
    const auto refused = rig.vehicle.arm(false);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text, "Arm: RTL mode not armable");
    rig.run(1.0);
    EXPECT_NE(rig.last<msg::SysStatus>()->onboard_control_sensors_health & msg::MAV_SYS_STATUS_PREARM_CHECK, 0u);
}

// --- Maintenance

TEST(MaintenanceCommands, RebootKeepsParametersAndStartsTheClockAgain) {
    Bench bench;
    bench.rig.send(msg::ParamSet{.target_system = 1,
                                 .param_id = {'M', 'A', 'V', '_', 'S', 'Y', 'S', '_', 'I', 'D'},
                                 .param_value = std::bit_cast<float>(9),
                                 .param_type = 6});
    bench.rig.run(10.0);
    EXPECT_EQ(bench.rig.vehicle.system().value, 1) << "a reboot changes it";
    EXPECT_EQ(bench.command(246, {1}), accepted);
    bench.rig.forget();
    bench.rig.run(2.0);
    EXPECT_TRUE(bench.rig.sink.frames.empty());
    bench.rig.run(2.0);
    ASSERT_TRUE(bench.rig.last<msg::Attitude>());
    EXPECT_LT(bench.rig.last<msg::Attitude>()->time_boot_ms, 2000u);
    EXPECT_EQ(bench.rig.vehicle.system().value, 9);
    EXPECT_EQ(bench.rig.sink.frames.back().frame().source().system.value, 9);
}

TEST(MaintenanceCommands, RebootMotionDoesNotDependOnMessageRates) {
    const auto north_after = [](double attitude_hz) {
        Rig rig({.ready_after = 0ms}, {.rates = {{msg::Attitude::id, attitude_hz}}});
        rig.run(0.5993);
        rig.send(msg::CommandLong{.target_system = 1, .command = 246, .param1 = 1});
        rig.run(4.0);
        return rig.vehicle.status().north_m_s;  // with noise, which each step draws
    };
    const double expected = north_after(0);
    for (const double hz : {1, 40, 90, 170, 249}) EXPECT_EQ(north_after(hz), expected) << hz;
}

TEST(MaintenanceCommands, RebootIsDeniedWhileArmed) {
    Bench bench;
    ASSERT_EQ(bench.arm(), accepted);
    EXPECT_EQ(bench.command(246, {0}), accepted) << "nothing to do";
    EXPECT_EQ(bench.command(246, {1}), denied);
    EXPECT_EQ(bench.command(246, {2}), denied);
    EXPECT_EQ(bench.command(246, {1, 0, 0, 0, 0, 20190226}), accepted) << "by force";
}

TEST(MaintenanceCommands, AVehicleThatIsShutDownIsSilent) {
    Bench bench;
    EXPECT_EQ(bench.command(246, {3}), denied);
    EXPECT_EQ(bench.command(246, {nan_f}), denied);
    EXPECT_EQ(bench.command(246, {2}), accepted);
    bench.rig.forget();
    bench.rig.run(10.0);
    EXPECT_TRUE(bench.rig.sink.frames.empty());
    EXPECT_EQ(bench.command(400, {1}), none);
}

TEST(MaintenanceCommands, ResetOfTheStorageReportsWhatChanges) {
    Bench bench;
    EXPECT_TRUE(bench.rig.vehicle.set_parameter("MIS_TAKEOFF_ALT", 7).has_value());
    EXPECT_EQ(bench.command(245, {1}), accepted);
    EXPECT_TRUE(bench.rig.all<msg::ParamValue>().empty());
    EXPECT_EQ(bench.command(245, {2}), accepted);
    const auto values = bench.rig.all<msg::ParamValue>();
    ASSERT_EQ(values.size(), 1u);
    EXPECT_EQ(values[0].param_value, 2.5f);
    EXPECT_EQ(bench.command(245, {9}), denied);
    EXPECT_EQ(bench.command(245, {nan_f}), denied);
    ASSERT_EQ(bench.arm(), accepted);
    EXPECT_EQ(bench.command(245, {1}), temporarily_rejected);
}

TEST(MaintenanceCommands, InjectFailuresOfSensors) {
    Bench bench;
    EXPECT_EQ(bench.command(420, {4, 1, 0}), accepted) << "GPS off";
    bench.rig.run(3.0);
    EXPECT_EQ(bench.arm(), temporarily_rejected);
    EXPECT_EQ(bench.command(420, {4, 0, 0}), accepted);
    bench.rig.run(3.0);
    EXPECT_EQ(bench.command(420, {4, 2, 0}), accepted) << "GPS stuck";
    EXPECT_EQ(bench.command(420, {2, 4, 0}), unsupported) << "no magnetometer is wrong";
    EXPECT_EQ(bench.command(420, {102, 1, 0}), unsupported) << "no servo fails";
    EXPECT_EQ(bench.command(420, {nan_f, 1, 0}), denied);
    EXPECT_EQ(bench.command(420, {100, 1, 0}), accepted) << "battery";
    EXPECT_LT(bench.state().battery_percent, 5);
    EXPECT_EQ(bench.command(420, {100, 2, 0}), unsupported) << "no battery gets stuck";
    EXPECT_EQ(bench.command(420, {100, 0, 0}), accepted);
    EXPECT_GT(bench.state().battery_percent, 99);
    EXPECT_TRUE(bench.rig.vehicle.set_parameter("SYS_FAILURE_EN", 0).has_value());
    EXPECT_EQ(bench.command(420, {4, 1, 0}), denied);
}

TEST(MaintenanceCommands, AutomaticTuningReportsItsProgress) {
    Bench bench;
    EXPECT_EQ(bench.command(212, {1}), temporarily_rejected) << "not on the ground";
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(bench.command(212, {1}), in_progress);
    EXPECT_EQ(bench.command(212, {1}), in_progress) << "a repeated command";
    EXPECT_EQ(bench.command(212, {1}, second_client), temporarily_rejected);
    bench.rig.forget();
    bench.rig.run(15.0);

    const auto answers = bench.rig.all<msg::CommandAck>();
    ASSERT_GE(answers.size(), 10u);
    for (std::size_t i = 1; i < answers.size(); ++i) EXPECT_GE(answers[i].progress, answers[i - 1].progress);
    EXPECT_EQ(answers.front().result, in_progress);
    EXPECT_EQ(answers.back().result, accepted);
    EXPECT_EQ(answers.back().target_system, 255);
}

TEST(MaintenanceCommands, ClientsCancelWhatIsInProgress) {
    Bench bench;
    bench.rig.forget();
    bench.rig.send(msg::CommandCancel{.target_system = 1, .target_component = 1, .command = 212});
    EXPECT_TRUE(bench.rig.all<msg::CommandAck>().empty()) << "nothing runs";
    ASSERT_TRUE(bench.fly());
    ASSERT_EQ(bench.command(212, {1}), in_progress);
    bench.rig.send(msg::CommandCancel{.target_system = 1, .target_component = 1, .command = 212});
    EXPECT_EQ(bench.answer(212), cancelled);
    bench.rig.forget();
    bench.rig.run(15.0);
    EXPECT_TRUE(bench.rig.all<msg::CommandAck>().empty());
}

TEST(Commands, UnknownOnesAreUnsupportedInBothForms) {
    Bench bench;
    EXPECT_EQ(bench.command(31999, {}), unsupported);
    EXPECT_EQ(bench.command_int(31999, 0, {}, 0, 0, 0), unsupported);
    EXPECT_EQ(bench.command(3000, {3}), unsupported) << "not a VTOL";
    EXPECT_EQ(bench.command(84, {}), unsupported);
}

TEST(Commands, TunesArePlayedSilentlyAndTheirFormatIsReported) {
    Bench bench;
    bench.rig.forget();
    bench.rig.send(msg::PlayTuneV2{.target_system = 1, .target_component = 1, .format = 1});
    EXPECT_TRUE(bench.rig.sink.frames.empty());
    EXPECT_EQ(bench.command(512, {401}), accepted);
    ASSERT_TRUE(bench.rig.last<msg::SupportedTunes>());
    EXPECT_EQ(bench.rig.last<msg::SupportedTunes>()->format, 1u) << "QBasic";
}

// Each command with every parameter NaN, infinite, huge or negative: an answer, and a vehicle that still works.
TEST(Commands, SurviveAnyParameters) {
    for (const Autopilot autopilot : {Autopilot::px4, Autopilot::ardupilot}) {
        for (const float value : {nan_f, inf_f, -inf_f, 1e38f, -1e38f, 4e9f, -1.f}) {
            Bench bench(autopilot);
            for (int id = 0; id < 700; ++id) {
                if (id == 246) continue;
                EXPECT_NE(bench.command(id, {value, value, value, value, value, value, value}), none) << id;
                EXPECT_NE(
                    bench.command_int(id, id % 16, {value, value, value, value}, no_coordinate, -no_coordinate, value),
                    none);
            }
            for (const int id : {2000, 2500, 2510, 2511, 3000, 5300, 42428, 42429, 42600, 43000, 43001, 43002})
                EXPECT_NE(bench.command(id, {value, value, value, value, value, value, value}), none) << id;
            bench.rig.run(1.0);
            EXPECT_TRUE(std::isfinite(bench.state().latitude_deg));
            EXPECT_TRUE(std::isfinite(bench.state().altitude_m));
        }
    }
}

}  // namespace
}  // namespace mavloom::sim
