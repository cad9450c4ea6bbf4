// SPDX-License-Identifier: MIT
// Missions, fences and fail-safes, flown without MAVLink. The first mission is that of a recording of PX4 1.17.
#include <gmock/gmock.h>

#include "unit/flight/support/flight_rig.hpp"

namespace mavloom::flight {
namespace {

using namespace msg;
using test::FlightRig;
using test::ready;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::Not;
using enum LandedState;

constexpr float not_given = std::numeric_limits<float>::quiet_NaN();

class MissionTest : public ::testing::Test {
protected:
    explicit MissionTest(const VehicleOptions& options = ready) : rig(options) { rig.run(1); }

    [[nodiscard]] PlanItem waypoint(double north, double east, double height, float hold = 0) const {
        return rig.item(MAV_CMD_NAV_WAYPOINT, north, east, height, {hold, 2, 0, not_given});
    }
    [[nodiscard]] PlanItem takeoff_to(double height) const {
        return rig.item(MAV_CMD_NAV_TAKEOFF, 0, 0, height, {0, 0, 0, not_given});
    }
    void upload(std::vector<PlanItem> items) { rig.upload(PlanType::mission, std::move(items)); }
    void start() { ASSERT_TRUE(rig.flight.start_mission({}).is_accepted()); }
    [[nodiscard]] bool fly_until(MissionState state, double limit) {
        return rig.run_until([&] { return rig.flight.mission().state == state; }, limit);
    }
    [[nodiscard]] MissionState state() const { return rig.flight.mission().state; }
    [[nodiscard]] std::uint16_t current() const { return rig.flight.mission().current; }

    FlightRig rig;
};

TEST_F(MissionTest, FliesTheRecordedMissionToItsEnd) {
    EXPECT_EQ(state(), MissionState::no_mission);
    upload({takeoff_to(10), waypoint(20, 0, 12), rig.action(MAV_CMD_DO_CHANGE_SPEED, {1, 4, -1, 0}),
            waypoint(20, 20, 15, 3), waypoint(0, 20, 12), rig.item(MAV_CMD_NAV_LAND, 2, 2, 0, {0, 0, 0, not_given})});
    EXPECT_EQ(state(), MissionState::not_started);
    ASSERT_TRUE(rig.set_mode("Mission").is_accepted());
    EXPECT_EQ(state(), MissionState::not_started);
    start();
    EXPECT_EQ(state(), MissionState::active);
    double fastest = 0, highest = 0;
    ASSERT_TRUE(rig.run_until(
        [&] {
            if (current() > 2) fastest = std::max(fastest, rig.ground_speed());
            highest = std::max(highest, rig.height());
            return !rig.flight.armed();
        },
        120));

    EXPECT_THAT(rig.reached, ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_THAT(fastest, AllOf(Ge(3.7), Le(4.4)));
    EXPECT_NEAR(highest, 15, 0.5);
    EXPECT_NEAR(rig.place().x(), 2, 0.5);
    EXPECT_NEAR(rig.place().y(), 2, 0.5);
    EXPECT_EQ(state(), MissionState::complete);
    EXPECT_EQ(current(), 5);
    EXPECT_THAT(rig.landed, ElementsAre(on_ground, takeoff, in_air, landing, on_ground));
    EXPECT_EQ(rig.mode(), "Mission");  // PX4 stays in it
    for (const char* const text :
         {"Executing Mission", "Climb to 10.0 meters above home", "Mission finished, landed", "Disarmed by landing"})
        EXPECT_TRUE(rig.was_said(text)) << text;
}

TEST_F(MissionTest, WithoutALandingItEndsInHold) {
    upload({takeoff_to(8), waypoint(15, 0, 8)});
    start();
    ASSERT_TRUE(fly_until(MissionState::complete, 60));
    rig.run(10);

    EXPECT_EQ(rig.mode(), "Hold");
    EXPECT_TRUE(rig.flight.armed());
    EXPECT_LT((rig.place() - Vector3(15, 0, -8)).norm(), 0.5);
    EXPECT_EQ(state(), MissionState::complete);
    EXPECT_EQ(current(), 1);
}

TEST_F(MissionTest, HoldsItsTimeAtAWaypoint) {
    upload({takeoff_to(8), waypoint(15, 0, 8, 5), waypoint(0, 0, 8)});
    start();
    ASSERT_TRUE(rig.run_until([&] { return (rig.place() - Vector3(15, 0, -8)).norm() < 2 && current() == 1; }, 60));
    const double arrived = rig.seconds();
    ASSERT_TRUE(rig.run_until([&] { return current() == 2; }, 20));
    EXPECT_NEAR(rig.seconds() - arrived, 5, 1);
}

TEST_F(MissionTest, PointsTheNoseAsAWaypointAsks) {
    upload({takeoff_to(8), rig.item(MAV_CMD_NAV_WAYPOINT, 15, 0, 8, {3, 2, 0, 90})});
    start();
    ASSERT_TRUE(fly_until(MissionState::complete, 60));
    EXPECT_NEAR(to_degrees(rig.flight.estimate().heading), 90, 3);
}

TEST_F(MissionTest, TakesOffByItselfIfTheFirstItemIsAWaypoint) {
    upload({waypoint(15, 0, 6)});
    start();
    ASSERT_TRUE(fly_until(MissionState::complete, 60));
    EXPECT_THAT(rig.landed, ElementsAre(on_ground, takeoff, in_air));
    EXPECT_TRUE(rig.was_said("Climb to 6.0 meters above home"));
}

TEST_F(MissionTest, JumpsAsOftenAsRequested) {
    upload({takeoff_to(8), waypoint(6, 0, 8), waypoint(0, 0, 8), rig.action(MAV_CMD_DO_JUMP, {1, 2}), waypoint(0, 6, 8)});
    start();
    ASSERT_TRUE(fly_until(MissionState::complete, 120));
    EXPECT_THAT(rig.reached, ElementsAre(0, 1, 2, 3, 1, 2, 3, 1, 2, 3, 4));
}

TEST_F(MissionTest, AnEndlessLoopOfActionsDoesNotBlock) {
    upload({takeoff_to(8), rig.action(MAV_CMD_DO_CHANGE_SPEED, {1, 4}), rig.action(MAV_CMD_DO_JUMP, {1, -1})});
    start();
    rig.run(20);
    EXPECT_NEAR(rig.height(), 8, 0.5);
    EXPECT_EQ(state(), MissionState::active);
    ASSERT_TRUE(rig.set_mode("Hold").is_accepted());
    EXPECT_EQ(state(), MissionState::paused);
}

TEST_F(MissionTest, WaitsForADelay) {
    upload({takeoff_to(8), rig.action(MAV_CMD_NAV_DELAY, {4, -1, -1, -1}), waypoint(10, 0, 8)});
    start();
    ASSERT_TRUE(rig.run_until([&] { return current() == 1; }, 30));
    const double begun = rig.seconds();
    ASSERT_TRUE(rig.run_until([&] { return current() == 2; }, 30));
    EXPECT_NEAR(rig.seconds() - begun, 4, 0.1);
}

TEST_F(MissionTest, LoitersForATimeAndToAnAltitude) {
    upload({takeoff_to(8), rig.item(MAV_CMD_NAV_LOITER_TIME, 10, 0, 8, {5, 0, 0, not_given}),
            rig.item(MAV_CMD_NAV_LOITER_TO_ALT, 10, 0, 14), rig.item(MAV_CMD_NAV_LOITER_UNLIM, 0, 0, 14)});
    start();
    ASSERT_TRUE(rig.run_until([&] { return current() == 2; }, 60));
    EXPECT_NEAR(rig.height(), 8, 0.7);
    ASSERT_TRUE(rig.run_until([&] { return current() == 3; }, 60));
    EXPECT_NEAR(rig.height(), 14, 1);
    rig.run(60);
    EXPECT_EQ(current(), 3);
    EXPECT_EQ(state(), MissionState::active);
}

TEST_F(MissionTest, FliesTurnsAroundAPoint) {
    upload({takeoff_to(8), rig.item(MAV_CMD_NAV_LOITER_TURNS, 0, 0, 8, {2, 0, -10, not_given})});
    start();
    ASSERT_TRUE(rig.run_until([&] { return current() == 1; }, 30));
    double turned = 0, last = nan;
    ASSERT_TRUE(rig.run_until(
        [&] {
            const double bearing = std::atan2(rig.place().y(), rig.place().x());
            const bool is_out = rig.place().head<2>().norm() > 9;
            if (is_out && !std::isnan(last)) turned += wrap_pi(bearing - last);
            last = is_out ? bearing : nan;
            return state() == MissionState::complete;
        },
        80));
    EXPECT_NEAR(turned, -4 * pi, 1);
}

// PX4's navigator asks its commander for the mode Return; the mission is then over.
TEST_F(MissionTest, ReturnsByItsModeAndDisarms) {
    upload({takeoff_to(8), waypoint(30, 0, 8), rig.action(MAV_CMD_NAV_RETURN_TO_LAUNCH)});
    start();
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Return"; }, 60));
    EXPECT_TRUE(rig.was_said("Returning to launch"));
    EXPECT_FALSE(rig.was_said("Mission finished, loitering"));
    EXPECT_EQ(state(), MissionState::complete);
    EXPECT_EQ(current(), 2);
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 150));
    EXPECT_THAT(rig.modes, ElementsAre("Hold", "Mission", "Return", "Hold"));
    EXPECT_LT(rig.place().head<2>().norm(), 1);
    EXPECT_EQ(state(), MissionState::complete);
    EXPECT_THAT(rig.reached, ElementsAre(0, 1, 2));
}

TEST_F(MissionTest, StandsBetweenALandingAndTheNextTakeOff) {
    upload({takeoff_to(5), waypoint(3, 0, 5, 1), rig.item(MAV_CMD_NAV_LAND, 3, 0, 0),
            rig.action(MAV_CMD_NAV_DELAY, {6, -1, -1, -1}), takeoff_to(6), waypoint(0, 0, 6)});
    start();
    ASSERT_TRUE(fly_until(MissionState::complete, 120));
    EXPECT_THAT(rig.landed, ElementsAre(on_ground, takeoff, in_air, landing, on_ground, takeoff, in_air));
    EXPECT_TRUE(rig.flight.armed());
}

TEST_F(MissionTest, PausesAndContinues) {
    upload({takeoff_to(8), waypoint(40, 0, 8), waypoint(0, 0, 8)});
    start();
    ASSERT_TRUE(rig.run_until([&] { return current() == 1 && rig.place().x() > 10; }, 40));
    ASSERT_TRUE(rig.flight.pause().is_accepted());
    EXPECT_EQ(rig.mode(), "Hold");
    EXPECT_EQ(state(), MissionState::paused);
    rig.run(8);
    EXPECT_LT(rig.ground_speed(), 0.1);
    ASSERT_TRUE(rig.flight.resume().is_accepted());
    EXPECT_EQ(state(), MissionState::active);
    EXPECT_EQ(current(), 1);
    ASSERT_TRUE(fly_until(MissionState::complete, 60));
}

TEST_F(MissionTest, JumpsToTheItemThatAClientSets) {
    upload({takeoff_to(8), waypoint(20, 0, 8), waypoint(0, 20, 8), waypoint(0, 0, 8)});
    EXPECT_EQ(rig.flight.set_current_item(std::uint16_t{4}, false).result, Result::failed);
    const int before = rig.progress_changes;
    ASSERT_TRUE(rig.flight.set_current_item(std::uint16_t{2}, false).is_accepted());
    EXPECT_EQ(current(), 2);
    EXPECT_GT(rig.progress_changes, before);
    start();
    ASSERT_TRUE(rig.run_until([&] { return current() == 3; }, 60));
    EXPECT_THAT(rig.reached, ElementsAre(2));
    ASSERT_TRUE(rig.flight.set_current_item(std::uint16_t{1}, false).is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return current() == 2; }, 60));
    EXPECT_GT(rig.place().x(), 15);
}

TEST_F(MissionTest, BeginsAgainAfterItsEnd) {
    upload({takeoff_to(5), rig.item(MAV_CMD_NAV_LAND, 0, 0, 0)});
    start();
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 60));
    EXPECT_EQ(state(), MissionState::complete);
    ASSERT_TRUE(rig.arm().is_accepted());
    EXPECT_EQ(state(), MissionState::active);
    EXPECT_EQ(current(), 0);
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 60));
    EXPECT_THAT(rig.reached, ElementsAre(0, 1, 0, 1));
}

TEST_F(MissionTest, AClearedPlanLeavesTheVehicleHovering) {
    upload({takeoff_to(8), waypoint(60, 0, 8), waypoint(0, 0, 8)});
    start();
    ASSERT_TRUE(rig.run_until([&] { return rig.place().x() > 10; }, 40));
    upload({});
    EXPECT_EQ(state(), MissionState::no_mission);
    EXPECT_EQ(current(), 0);
    rig.run(8);
    EXPECT_LT(rig.ground_speed(), 0.1);
    EXPECT_NEAR(rig.height(), 8, 0.5);
}

TEST_F(MissionTest, ItemsOfAnyNumbersDoNoHarm) {
    Random random(3);
    constexpr std::array commands{MAV_CMD_NAV_WAYPOINT,        MAV_CMD_NAV_LOITER_TIME, MAV_CMD_NAV_LOITER_TURNS,
                                  MAV_CMD_NAV_TAKEOFF,         MAV_CMD_NAV_DELAY,       MAV_CMD_DO_JUMP,
                                  MAV_CMD_DO_CHANGE_SPEED,     MAV_CMD_DO_SET_HOME,     MAV_CMD_CONDITION_YAW,
                                  MAV_CMD_DO_SET_ROI_LOCATION, MAV_CMD_NAV_LAND};
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr std::array numbers{0.f, 1.f, -1.f, 1e30f, -1e9f, infinity, -infinity, not_given};
    const auto any = [&] { return numbers[random.bits() % numbers.size()]; };
    for (int round = 0; round < 30; ++round) {
        std::vector<PlanItem> items{takeoff_to(8)};
        for (int i = 0; i < 10; ++i)
            items.push_back({.command = static_cast<std::uint16_t>(commands[random.bits() % commands.size()]),
                             .frame = static_cast<std::uint8_t>(random.bits() % 12),
                             .params = {any(), any(), any(), any()},
                             .x = static_cast<std::int32_t>(random.bits()),
                             .y = static_cast<std::int32_t>(random.bits()),
                             .z = any()});
        upload(std::move(items));
        (void)rig.flight.start_mission(std::uint16_t{0});
        rig.run(10);
        ASSERT_TRUE(rig.flight.truth().position.allFinite()) << "round " << round;
        ASSERT_LT(rig.flight.truth().velocity.norm(), 50) << "round " << round;
        if (const auto& home = rig.flight.home()) {
            ASSERT_LE(std::abs(home->latitude), 90);
        }
        ASSERT_TRUE(rig.flight.set_home(rig.point(0, 0, 0), 0).is_accepted());
    }
}

TEST_F(MissionTest, ReportsItemsForThePayload) {
    upload({takeoff_to(5), rig.action(MAV_CMD_IMAGE_START_CAPTURE, {0, 0, 1}), rig.action(MAV_CMD_DO_GRIPPER, {1, 0}),
            waypoint(0, 0, 5)});
    start();
    ASSERT_TRUE(fly_until(MissionState::complete, 60));
    EXPECT_THAT(rig.payload, ElementsAre(MAV_CMD_IMAGE_START_CAPTURE, MAV_CMD_DO_GRIPPER));
}

TEST_F(MissionTest, StartingWithoutAMissionIsDenied) {
    EXPECT_EQ(rig.flight.start_mission({}).result, Result::denied);
    EXPECT_FALSE(rig.flight.armed());
    upload({takeoff_to(5)});
    EXPECT_EQ(rig.flight.start_mission(std::uint16_t{7}).result, Result::denied);
    EXPECT_FALSE(rig.flight.armed());
}

class ArduPilotMissionTest : public MissionTest {
protected:
    ArduPilotMissionTest() : MissionTest({.autopilot = Autopilot::ardupilot, .ready_after = Nanoseconds{0}}) {}
};

TEST_F(ArduPilotMissionTest, SkipsHomeAndStaysInItsMode) {
    upload({waypoint(500, 500, 100), takeoff_to(8), waypoint(20, 0, 8)});
    ASSERT_TRUE(rig.set_mode("GUIDED").is_accepted());
    ASSERT_TRUE(rig.arm().is_accepted());
    ASSERT_TRUE(rig.set_mode("AUTO").is_accepted());
    ASSERT_TRUE(fly_until(MissionState::complete, 60));
    EXPECT_THAT(rig.reached, ElementsAre(1, 2));
    rig.run(5);
    EXPECT_EQ(rig.mode(), "AUTO");
    EXPECT_LT((rig.place() - Vector3(20, 0, -8)).norm(), 1);
}

TEST_F(ArduPilotMissionTest, PausesWithinItsMode) {
    upload({waypoint(0, 0, 0), takeoff_to(8), waypoint(60, 0, 8)});
    ASSERT_TRUE(rig.set_mode("GUIDED").is_accepted());
    ASSERT_TRUE(rig.arm().is_accepted());
    ASSERT_TRUE(rig.set_mode("AUTO").is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return rig.place().x() > 15; }, 40));
    ASSERT_TRUE(rig.flight.pause().is_accepted());
    rig.run(8);
    EXPECT_EQ(rig.mode(), "AUTO");
    EXPECT_LT(rig.ground_speed(), 0.1);
    ASSERT_TRUE(rig.flight.resume().is_accepted());
    ASSERT_TRUE(fly_until(MissionState::complete, 40));
}

class PlaneMissionTest : public MissionTest {
protected:
    PlaneMissionTest() : MissionTest({.kind = Kind::plane, .ready_after = Nanoseconds{0}}) {}
};

TEST_F(PlaneMissionTest, FliesAroundAndLands) {
    upload({rig.item(MAV_CMD_NAV_TAKEOFF, 200, 0, 40, {0, 0, 0, not_given}), waypoint(500, 200, 50),
            waypoint(300, 500, 60), rig.item(MAV_CMD_NAV_LOITER_TIME, 0, 300, 50, {20, 0, 60, not_given}),
            rig.item(MAV_CMD_NAV_LAND, 0, 0, 0, {0, 0, 0, not_given})});
    start();
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 400));
    EXPECT_THAT(rig.reached, ElementsAre(0, 1, 2, 3, 4));
    EXPECT_LT(rig.place().head<2>().norm(), 80);
    EXPECT_THAT(rig.landed, ElementsAre(on_ground, takeoff, in_air, landing, on_ground));
}

// As QGroundControl plans a landing: circle down beside the tangent that leads to the runway.
class PlaneLandingTest : public ::testing::TestWithParam<std::tuple<Autopilot, double>> {};

TEST_P(PlaneLandingTest, DescendsOnItsCircleAndLeavesItAlongTheTangent) {
    const auto [autopilot, radius] = GetParam();
    FlightRig rig({.kind = Kind::plane, .autopilot = autopilot, .ready_after = Nanoseconds{0}});
    rig.run(1);
    const float length = 400, low = 40;
    const Vector3 center(length, -radius, 0);  // the tangent at its eastern or western end leads south, to home
    std::vector<PlanItem> items{
        rig.item(MAV_CMD_NAV_TAKEOFF, 0, 0, 60), rig.item(MAV_CMD_NAV_WAYPOINT, 800, -300, 90),
        rig.item(MAV_CMD_NAV_LOITER_TO_ALT, center.x(), center.y(), low, {1, static_cast<float>(radius), 0, 1}),
        rig.item(MAV_CMD_NAV_LAND, 0, 0, 0)};
    if (autopilot == Autopilot::ardupilot) items.insert(items.begin(), rig.item(MAV_CMD_NAV_WAYPOINT, 0, 0, 0));
    const auto loiter = static_cast<std::uint16_t>(items.size() - 2);
    rig.upload(PlanType::mission, std::move(items));
    if (autopilot == Autopilot::ardupilot) {
        ASSERT_TRUE(rig.set_mode("AUTO").is_accepted());
        ASSERT_TRUE(rig.arm().is_accepted());
    } else {
        ASSERT_TRUE(rig.flight.start_mission({}).is_accepted());
    }
    const auto current = [&] { return rig.flight.mission().current; };
    ASSERT_TRUE(rig.run_until([&] { return current() == loiter; }, 120));
    const auto off_circle = [&] { return (rig.place() - center).head<2>().norm() - std::abs(radius); };
    double innermost = 0, highest_on_circle = 0, widest = 0;
    bool is_on_circle = false;
    ASSERT_TRUE(rig.run_until(
        [&] {
            innermost = std::min(innermost, off_circle());
            is_on_circle = is_on_circle || std::abs(off_circle()) < 3;
            if (is_on_circle) widest = std::max(widest, off_circle());
            if (std::abs(off_circle()) < 20) highest_on_circle = std::max(highest_on_circle, rig.height());
            return current() == loiter + 1;
        },
        200));
    EXPECT_GT(innermost, -12);
    EXPECT_LT(widest, 12);
    EXPECT_NEAR(highest_on_circle, 90, 8);
    EXPECT_NEAR(rig.height(), low, 2);
    EXPECT_NEAR(rig.place().y(), 0, 15);
    double off_line = 0;
    ASSERT_TRUE(rig.run_until(
        [&] {
            if (rig.height() < low / 2) off_line = std::max(off_line, std::abs(rig.place().y()));
            return rig.flight.landed() == on_ground;
        },
        90));
    EXPECT_LT(off_line, 5);
    EXPECT_NEAR(rig.place().x(), 0, 80);
}

INSTANTIATE_TEST_SUITE_P(Both, PlaneLandingTest,
                         ::testing::Values(std::tuple(Autopilot::px4, -75.0), std::tuple(Autopilot::px4, 100.0),
                                           std::tuple(Autopilot::ardupilot, 75.0)));

class RoverMissionTest : public MissionTest {
protected:
    RoverMissionTest() : MissionTest({.kind = Kind::rover, .ready_after = Nanoseconds{0}}) {}
};

TEST_F(RoverMissionTest, DrivesFromPointToPoint) {
    upload({waypoint(30, 0, 0), waypoint(30, 30, 0), waypoint(0, 30, 0)});
    start();
    ASSERT_TRUE(fly_until(MissionState::complete, 120));
    rig.run(5);
    EXPECT_LT((rig.place() - Vector3(0, 30, 0)).head<2>().norm(), 3);
    EXPECT_NEAR(rig.height(), 0, 0.2);
}

// --- ArduPilot: texts of release 4.6, AP_Mission and the vehicles' commands

std::vector<std::string> texts_of_a_mission(Kind kind, const std::function<std::vector<PlanItem>(FlightRig&)>& plan) {
    FlightRig rig({.kind = kind, .autopilot = Autopilot::ardupilot, .ready_after = Nanoseconds{0}});
    rig.run(1);
    std::vector<PlanItem> items = plan(rig);
    items.insert(items.begin(), rig.item(MAV_CMD_NAV_WAYPOINT, 0, 0, 0));  // home
    rig.upload(PlanType::mission, std::move(items));
    if (kind == Kind::quad) {
        EXPECT_TRUE(rig.set_mode("GUIDED").is_accepted());
    }
    EXPECT_TRUE(rig.arm().is_accepted());
    EXPECT_TRUE(rig.set_mode("AUTO").is_accepted());
    EXPECT_TRUE(rig.run_until([&] { return rig.flight.mission().state == MissionState::complete; }, 300));
    rig.run(0.1);
    rig.texts.emplace_back(rig.mode());
    return rig.texts;
}

TEST(ArduPilotMission, CopterReportsItsItems) {
    const auto plan = [](FlightRig& rig) {
        return std::vector{rig.item(MAV_CMD_NAV_TAKEOFF, 0, 0, 6), rig.item(MAV_CMD_NAV_WAYPOINT, 10, 0, 6),
                           rig.action(MAV_CMD_DO_CHANGE_SPEED, {1, 4, -1, 0}), rig.action(MAV_CMD_DO_JUMP, {2, 1, 0, 0}),
                           rig.item(MAV_CMD_NAV_LOITER_TIME, 10, 0, 6, {1, 0, 0, not_given})};
    };
    EXPECT_THAT(texts_of_a_mission(Kind::quad, plan),
                ElementsAre("Arming motors", "Mission: 1 Takeoff", "Mission: 2 WP", "Reached command #2",
                            "Mission: 3 ChangeSpeed", "Mission: 4 Jump 1/1", "Mission: 2 WP", "Reached command #2",
                            "Mission: 3 ChangeSpeed", "Mission: 5 LoitTime", "Reached command #5", "AUTO"));
}

// ArduPilot looks at 255 items for the next way to go, and then ends the mission. It does not announce endless jumps.
TEST(ArduPilotMission, AnEndlessLoopOfActionsEndsTheMission) {
    const auto plan = [](FlightRig& rig) {
        return std::vector{rig.item(MAV_CMD_NAV_TAKEOFF, 0, 0, 6), rig.action(MAV_CMD_DO_CHANGE_SPEED, {1, 4, -1, 0}),
                           rig.action(MAV_CMD_DO_JUMP, {2, -1, 0, 0})};
    };
    const auto texts = texts_of_a_mission(Kind::quad, plan);
    EXPECT_LT(texts.size(), 140);
    EXPECT_THAT(texts, Not(Contains(HasSubstr("Jump"))));
}

TEST(ArduPilotMission, PlaneReportsDistancesAndThenReturns) {
    const auto plan = [](FlightRig& rig) {
        return std::vector{rig.item(MAV_CMD_NAV_TAKEOFF, 0, 0, 40), rig.item(MAV_CMD_NAV_WAYPOINT, 600, 0, 50)};
    };
    const auto texts = texts_of_a_mission(Kind::plane, plan);
    ASSERT_EQ(texts.size(), 7) << ::testing::PrintToString(texts);
    EXPECT_EQ(texts[0], "Throttle armed");
    EXPECT_EQ(texts[1], "Mission: 1 Takeoff");
    EXPECT_THAT(texts[2], ::testing::MatchesRegex("Takeoff complete at [34][0-9]\\.[0-9][0-9]m"));
    EXPECT_EQ(texts[3], "Mission: 2 WP");
    EXPECT_THAT(texts[4], ::testing::MatchesRegex("Reached waypoint #2 dist [0-9]+m"));
    EXPECT_EQ(texts[5], "Mission complete, changing mode to RTL");
    EXPECT_EQ(texts[6], "RTL");
}

TEST(ArduPilotMission, RoverReportsItsWaypoints) {
    const auto plan = [](FlightRig& rig) {
        return std::vector{rig.item(MAV_CMD_NAV_WAYPOINT, 15, 0, 0), rig.item(MAV_CMD_NAV_WAYPOINT, 15, 10, 0, {2})};
    };
    EXPECT_THAT(texts_of_a_mission(Kind::rover, plan),
                ElementsAre("Throttle armed", "Mission: 1 WP", "Reached waypoint #1", "Mission: 2 WP",
                            "Reached waypoint #2. Loiter for 2 seconds", "Mission Complete", "AUTO"));
}

// --- Fences

class FenceTest : public ::testing::Test {
protected:
    void fly_north(double metres) {
        const GeoPoint to = rig.point(metres, 0, 10);
        ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    }
    [[nodiscard]] std::vector<PlanItem> square(std::uint16_t command, double south, double west, double north,
                                               double east) const {
        return {rig.item(command, south, west, 0, {4}), rig.item(command, south, east, 0, {4}),
                rig.item(command, north, east, 0, {4}), rig.item(command, north, west, 0, {4})};
    }
    // Flies north until the fence acts; returns how far.
    [[nodiscard]] double caught_at() {
        rig.take_off(10);
        rig.set("GF_ACTION", 3);
        fly_north(150);
        return rig.run_until([&] { return rig.mode() == "Return"; }, 40) ? rig.place().x() : nan;
    }

    FlightRig rig{ready};
};

TEST_F(FenceTest, KeepsTheVehicleInsideOfAPolygon) {
    rig.upload(PlanType::fence, square(MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, -30, -30, 40, 30));
    EXPECT_NEAR(caught_at(), 40, 1);
    EXPECT_TRUE(rig.was_said("Geofence violation"));
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::critical);
    EXPECT_EQ(rig.flight.intended_mode().name, "Hold");
}

TEST_F(FenceTest, KeepsTheVehicleOutOfAPolygonAndACircle) {
    rig.upload(PlanType::fence, square(MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION, 50, -30, 80, 30));
    EXPECT_NEAR(caught_at(), 50, 1);

    FlightRig& other = rig;
    ASSERT_TRUE(other.set_mode("Hold").is_accepted());
    rig.upload(PlanType::fence, {rig.item(MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, 100, 0, 0, {20})});
    fly_north(150);
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Return"; }, 40));
    EXPECT_NEAR(rig.place().x(), 80, 1);
}

TEST_F(FenceTest, KeepsTheVehicleInsideOfACircleOrTheParameters) {
    rig.upload(PlanType::fence, {rig.item(MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0, 0, 0, {35})});
    EXPECT_NEAR(caught_at(), 35, 1);
}

TEST_F(FenceTest, ParametersLimitDistanceAndHeight) {
    rig.set("GF_MAX_HOR_DIST", 25);
    EXPECT_NEAR(caught_at(), 25, 1);
    rig.set("GF_MAX_HOR_DIST", 0);
    rig.set("GF_MAX_VER_DIST", 50);
    ASSERT_TRUE(rig.set_mode("Hold").is_accepted());
    ASSERT_TRUE(rig.flight.change_altitude(489.4 + 70).is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Return"; }, 40));
    EXPECT_NEAR(rig.height(), 50, 1);
}

TEST_F(FenceTest, CanBeTurnedOffAndOnlyWarn) {
    rig.set("GF_MAX_HOR_DIST", 25);
    rig.take_off(10);
    ASSERT_TRUE(rig.flight.enable_fence(false).is_accepted());
    fly_north(60);
    rig.run(20);
    EXPECT_FALSE(rig.was_said("Geofence violation"));
    rig.set("GF_ACTION", 1);
    ASSERT_TRUE(rig.flight.enable_fence(true).is_accepted());
    rig.run(1);
    EXPECT_TRUE(rig.was_said("Geofence violation"));
    EXPECT_EQ(rig.mode(), "Hold");
    EXPECT_FALSE(rig.flight.has_failsafe());
}

TEST_F(FenceTest, AClientMayFlyOnAfterABreach) {
    rig.set("GF_MAX_HOR_DIST", 25);
    EXPECT_NEAR(caught_at(), 25, 1);
    ASSERT_TRUE(rig.set_mode("Hold").is_accepted());
    rig.run(5);
    EXPECT_EQ(rig.mode(), "Hold");
    EXPECT_FALSE(rig.flight.has_failsafe());
}

TEST_F(FenceTest, OddPlansDoNoHarm) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    rig.upload(PlanType::fence, {rig.item(MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, 0, 0, 0, {4}),
                                 rig.item(MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, 0, 0, 0, {infinity}),
                                 rig.item(MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION, 0, 0, 0, {not_given}),
                                 rig.item(MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION, 0, 0, 0, {not_given}),
                                 rig.item(MAV_CMD_NAV_FENCE_RETURN_POINT, 0, 0, 0)});
    rig.take_off(10);
    EXPECT_FALSE(rig.was_said("Geofence violation"));
}

// --- Fail-safes

TEST(Failsafe, TheBatteryWarnsReturnsAndLands) {
    FlightRig rig(ready);
    rig.take_off(30);
    const GeoPoint to = rig.point(80, 0, 30);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    rig.run(20);
    ASSERT_TRUE(rig.flight.set_battery(0.14).is_accepted());
    rig.run(1);
    EXPECT_THAT(rig.texts, Contains(HasSubstr("Low battery")));
    EXPECT_EQ(rig.mode(), "Hold");
    ASSERT_TRUE(rig.flight.set_battery(0.065).is_accepted());
    rig.run(1);
    EXPECT_THAT(rig.texts, Contains(HasSubstr("Critical battery")));
    EXPECT_EQ(rig.mode(), "Return");
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::critical);
    ASSERT_TRUE(rig.flight.set_battery(0.045).is_accepted());
    rig.run(1);
    EXPECT_THAT(rig.texts, Contains(HasSubstr("Emergency battery")));
    EXPECT_EQ(rig.mode(), "Land");
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 60));
    EXPECT_EQ(rig.arm().result, Result::temporarily_rejected);
    EXPECT_TRUE(rig.flight.unready() & unready_battery);
}

TEST(Failsafe, TheBatteryLastsAsLongAsTheOptionsState) {
    VehicleOptions options = ready;
    options.battery.hover_minutes = 2;
    FlightRig rig(options);
    rig.take_off(10);
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Return"; }, 150));
    // From full to 7 percent: 112 s of hovering; take-off and climb draw a little more.
    EXPECT_THAT(rig.seconds(), AllOf(Ge(100), Le(120)));
    EXPECT_LT(rig.flight.battery().remaining(), 0.07);
}

TEST(Failsafe, AFailedBatteryRestsAtItsLevelUntilItIsRestored) {
    VehicleOptions options = ready;
    options.battery.start_percent = 80;
    FlightRig rig(options);
    ASSERT_TRUE(rig.flight.set_battery(0.04).is_accepted());
    rig.run(5);
    EXPECT_NEAR(rig.flight.battery().remaining(), 0.04, 0.001);
    ASSERT_TRUE(rig.flight.restore_battery().is_accepted());
    rig.run(5);
    EXPECT_NEAR(rig.flight.battery().remaining(), 0.8, 0.001);
}

TEST(Failsafe, TheEndOfOtherFaultsChargesNoBattery) {
    FlightRig rig(ready);
    rig.take_off(10);
    rig.run(60);
    const double left = rig.flight.battery().remaining();
    ASSERT_LT(left, 0.97);
    ASSERT_TRUE(rig.flight.set_fault({.part = FaultPart::battery, .kind = FaultKind::off}).is_accepted());
    ASSERT_TRUE(rig.flight.set_fault({.part = FaultPart::all, .kind = FaultKind::ok}).is_accepted());
    EXPECT_EQ(rig.flight.battery().remaining(), left);
}

TEST(Failsafe, AfterABootTheBatteryIsAsAtTheStart) {
    VehicleOptions options = ready;
    options.battery.start_percent = 80;
    FlightRig rig(options);
    rig.take_off(10);
    ASSERT_GT(rig.flight.battery().seconds_left(), 0);
    ASSERT_TRUE(rig.flight.set_battery(0.04).is_accepted());
    rig.flight.reboot();
    const Battery& battery = rig.flight.battery();
    EXPECT_EQ(battery.used_joule(), 0);
    EXPECT_EQ(battery.seconds_left(), 0);
    EXPECT_NEAR(battery.remaining(), 0.8, 1e-9);
    rig.run(5);
    EXPECT_NEAR(battery.remaining(), 0.8, 0.001) << "also after a failure";
}

TEST(Failsafe, AnEmptyBatteryDropsTheVehicle) {
    FlightRig rig(ready);
    rig.set("COM_LOW_BAT_ACT", 0);
    rig.take_off(10);
    ASSERT_TRUE(rig.flight.set_battery(0).is_accepted());
    rig.run(5);
    EXPECT_EQ(rig.flight.landed(), on_ground);
    EXPECT_NEAR(rig.height(), 0, 0.2);
}

TEST(Failsafe, ActsOnlyOnALossOfAGroundStationThatWasThere) {
    FlightRig rig(ready);
    rig.set("NAV_DLL_ACT", 2);
    rig.take_off(30);
    rig.run(20);
    EXPECT_EQ(rig.mode(), "Hold");
    rig.flight.on_ground_station_heard();
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Return"; }, 15));
    EXPECT_TRUE(rig.was_said("Connection to ground control station lost"));
    rig.flight.on_ground_station_heard();
    rig.run(1);
    EXPECT_EQ(rig.mode(), "Hold");
    EXPECT_TRUE(rig.was_said("GCS connection regained"));
}

TEST(Failsafe, ALandingVehicleLandsOn) {
    FlightRig rig(ready);
    rig.set("NAV_DLL_ACT", 2);
    rig.take_off(30);
    rig.flight.on_ground_station_heard();
    ASSERT_TRUE(rig.set_mode("Land").is_accepted());
    rig.run(15);
    EXPECT_EQ(rig.mode(), "Land");
}

TEST(Failsafe, LostSticksLeadToHold) {
    FlightRig rig(ready);
    rig.take_off(10);
    rig.flight.on_sticks({});
    ASSERT_TRUE(rig.set_mode("Position").is_accepted());
    rig.run(2, [&] { rig.flight.on_sticks({.pitch = 0.5}); });
    const double last = rig.seconds();
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Hold"; }, 3));
    EXPECT_NEAR(rig.seconds() - last, 0.5, 0.1);  // COM_RC_LOSS_T
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::critical);
    EXPECT_EQ(rig.flight.intended_mode().name, "Position");
    rig.run(8);
    EXPECT_LT(rig.ground_speed(), 0.1);
    rig.run(0.5, [&] { rig.flight.on_sticks({}); });
    EXPECT_EQ(rig.mode(), "Position");
}

TEST(Failsafe, WithoutAPositionTheVehicleComesDown) {
    FlightRig rig(ready);
    rig.take_off(10);
    ASSERT_TRUE(rig.flight.inject_failures({.gps = Failure::off}).is_accepted());
    rig.run(1);
    EXPECT_EQ(rig.mode(), "Descend");
    EXPECT_EQ(rig.set_mode("Hold").result, Result::temporarily_rejected);
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 60));
    EXPECT_TRUE(rig.flight.unready() & unready_position);
    EXPECT_EQ(rig.arm().result, Result::temporarily_rejected);
}

TEST(Failsafe, AClientThatChangesTheModeEndsIt) {
    FlightRig rig(ready);
    rig.set("NAV_DLL_ACT", 2);
    rig.take_off(20);
    rig.flight.on_ground_station_heard();
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Return"; }, 15));
    ASSERT_TRUE(rig.set_mode("Hold").is_accepted());
    EXPECT_FALSE(rig.flight.has_failsafe());
    rig.run(20);
    EXPECT_EQ(rig.mode(), "Hold");
}

TEST(Calibration, KeepsTheVehicleFromArming) {
    FlightRig rig(ready);
    rig.flight.set_calibrating(true);
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::calibrating);
    EXPECT_FALSE(rig.arm().is_accepted());
    rig.flight.set_calibrating(false);
    EXPECT_TRUE(rig.arm().is_accepted());
}

}  // namespace
}  // namespace mavloom::flight
