// SPDX-License-Identifier: MIT
// Flights without MAVLink: take-off, landing, modes, points, circles, pilots and external controllers. Expected numbers
// are PX4's documented defaults and what a recording of PX4 1.17 shows.
#include <gmock/gmock.h>

#include "unit/flight/support/flight_rig.hpp"

namespace mavloom::flight {
namespace {

using test::FlightRig;
using test::ready;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Ge;
using ::testing::HasSubstr;
using ::testing::Le;
using enum LandedState;

constexpr VehicleOptions copter_of_ardupilot{.autopilot = Autopilot::ardupilot, .ready_after = Nanoseconds{0}};

VehicleOptions of(Kind kind, Autopilot autopilot = Autopilot::px4) {
    return {.kind = kind, .autopilot = autopilot, .ready_after = Nanoseconds{0}};
}

// --- Start

TEST(Flight, FindsItsPositionThenItsHomeThenIsReady) {
    FlightRig rig;
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::uninitialised);
    EXPECT_EQ(rig.arm().result, Result::temporarily_rejected);
    EXPECT_EQ(rig.texts.size(), 1u);

    ASSERT_TRUE(rig.run_until([&] { return rig.flight.sensors().gps().fix_type == 3; }, 3));
    EXPECT_THAT(rig.seconds(), AllOf(Ge(1), Le(2)));
    EXPECT_TRUE(rig.flight.has_origin());
    EXPECT_FALSE(rig.flight.home());

    ASSERT_TRUE(rig.run_until([&] { return rig.flight.unready() == 0; }, 3));
    EXPECT_NEAR(rig.seconds(), 2.5, 0.1);
    EXPECT_TRUE(rig.flight.home());
    EXPECT_EQ(rig.home_changes, 1);
    rig.step();
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::standby);
    EXPECT_EQ(rig.mode(), "Hold");
}

TEST(Flight, IsReadyAtOnceIfRequested) {
    FlightRig rig(ready);
    EXPECT_EQ(rig.flight.unready(), 0u);
    EXPECT_TRUE(rig.arm().is_accepted());
}

TEST(Flight, ParkedItReportsNoMotion) {
    FlightRig rig;
    rig.run(60, [&] {
        ASSERT_LT(rig.flight.estimate().velocity.norm(), 0.02);
        ASSERT_LT(std::abs(rig.height()), 0.1);
        ASSERT_LT(std::abs(to_degrees(rig.flight.estimate().euler.roll)), 0.3);
    });
    EXPECT_EQ(rig.flight.truth().velocity, Vector3::Zero());
}

// --- Arming

TEST(Arming, SetsHomeAndIsAnnounced) {
    FlightRig rig(ready);
    rig.run(1);
    EXPECT_TRUE(rig.arm().is_accepted());
    EXPECT_TRUE(rig.arm().is_accepted());

    EXPECT_EQ(std::ranges::count(rig.texts, "Armed by external command"), 1);
    EXPECT_EQ(rig.home_changes, 2);
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::active);
    EXPECT_EQ(rig.flight.landed(), on_ground);
}

TEST(Arming, EndsByItselfWithoutTakeOff) {
    FlightRig rig(ready);
    ASSERT_TRUE(rig.arm().is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 12));

    EXPECT_NEAR(rig.seconds(), 10, 0.1);
    EXPECT_EQ(rig.flight.flights(), 1u);
    EXPECT_TRUE(rig.was_said("Disarmed by auto preflight disarming"));
}

TEST(Arming, DisarmingInTheAirNeedsForce) {
    FlightRig rig(ready);
    rig.take_off(10);
    EXPECT_EQ(rig.disarm().result, Result::temporarily_rejected);
    EXPECT_TRUE(rig.flight.armed());
    EXPECT_TRUE(rig.flight.disarm(true, OrderedBy::client).is_accepted());
    EXPECT_FALSE(rig.flight.armed());

    ASSERT_TRUE(rig.run_until([&] { return rig.flight.landed() == on_ground; }, 5));
    rig.run(3);
    EXPECT_EQ(rig.flight.truth().velocity, Vector3::Zero());
}

TEST(Arming, AFailedSensorPreventsIt) {
    FlightRig rig(ready);
    ASSERT_TRUE(rig.flight.inject_failures({.magnetometer = Failure::off}).is_accepted());
    EXPECT_EQ(rig.flight.unready(), std::uint32_t{unready_sensors});
    EXPECT_EQ(rig.arm().result, Result::temporarily_rejected);
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::uninitialised);
    EXPECT_TRUE(rig.flight.arm(true, OrderedBy::client).is_accepted());
    rig.set("SYS_FAILURE_EN", 0);
    EXPECT_EQ(rig.flight.inject_failures({}).result, Result::denied);
}

// PX4's failure detector and ArduPilot's crash check disarm.
TEST(CrashTest, AVehicleThatFallsIsDisarmedAndLanded) {
    for (const Autopilot autopilot : {Autopilot::px4, Autopilot::ardupilot}) {
        VehicleOptions options = ready;
        options.autopilot = autopilot;
        FlightRig rig(options);
        rig.take_off(10);
        ASSERT_TRUE(rig.flight.set_fault({FaultPart::motor, FaultKind::off, {1}, 1}).is_accepted());
        ASSERT_TRUE(rig.run_until([&] { return rig.flight.plant().touches_ground(); }, 10));
        rig.run(2);
        EXPECT_FALSE(rig.flight.armed());
        EXPECT_EQ(rig.flight.landed(), LandedState::on_ground);
        EXPECT_TRUE(rig.was_said(autopilot == Autopilot::px4 ? "Disarmed by failure detector" : "Crash: Disarming"));
    }
}

// With the fastest descent that each firmware's parameters allow.
TEST(CrashTest, APilotWhoDescendsAsFastAsAllowedLands) {
    for (const Autopilot autopilot : {Autopilot::px4, Autopilot::ardupilot}) {
        const bool is_px4 = autopilot == Autopilot::px4;
        FlightRig rig(of(Kind::quad, autopilot));
        if (is_px4) rig.set("MPC_Z_V_AUTO_DN", 4);
        rig.set(is_px4 ? "MPC_Z_VEL_MAX_DN" : "WPNAV_SPEED_DN", is_px4 ? 4 : 500);
        rig.take_off(40);
        rig.flight.on_sticks({});
        ASSERT_TRUE(rig.set_mode(is_px4 ? "Position" : "LOITER").is_accepted());
        double fastest = 0;
        rig.run(20, [&] {
            rig.flight.on_sticks({.throttle = 0});
            fastest = std::max(fastest, rig.flight.truth().velocity.z());
        });
        EXPECT_GT(fastest, is_px4 ? 3.9 : 4.9);
        EXPECT_FALSE(rig.flight.armed());
        EXPECT_FALSE(rig.was_said(is_px4 ? "Disarmed by failure detector" : "Crash: Disarming"));
    }
}

// No scenario has such a wind, which carries it away as soon as it leaves the ground.
TEST(InfiniteMotionTest, TheVehicleIsPutBackAtHomeAndReportsItOnce) {
    VehicleOptions options = ready;
    options.wind.speed_m_s = std::numeric_limits<double>::infinity();
    FlightRig rig(options);
    for (unsigned flight = 1; flight < 3; ++flight) {
        ASSERT_TRUE(rig.flight.take_off({.altitude = rig.flight.ground_altitude() + 5}).is_accepted());
        ASSERT_TRUE(rig.arm().is_accepted());
        ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 10));
        EXPECT_GE(rig.flight.not_finite(), flight);
        EXPECT_TRUE(rig.place().allFinite());
        EXPECT_LT(rig.place().norm(), 1);
        EXPECT_EQ(rig.flight.landed(), LandedState::on_ground);
    }
    EXPECT_EQ(std::ranges::count(rig.texts, "Motion became infinite: back at home, check body and wind"), 1);
}

TEST(InfiniteMotionTest, AVehicleThatMovesAtRandomStaysArmedInTheAir) {
    VehicleOptions options{.motion = Motion::random};
    options.wind.speed_m_s = std::numeric_limits<double>::infinity();
    FlightRig rig(options);
    rig.run(5, [&] {
        ASSERT_TRUE(rig.flight.armed());
        ASSERT_EQ(rig.flight.landed(), LandedState::in_air);
        ASSERT_LT((rig.flight.truth().position - Vector3(0, 0, -50)).norm(), 1);
    });
    EXPECT_GT(rig.flight.not_finite(), 1u);
}

// Of three motors, two on one side make it tumble.
TEST(Faults, WithAMotorLessAQuadFalls) {
    FlightRig rig(ready);
    rig.take_off(20);
    const Fault first_off{.part = FaultPart::motor, .kind = FaultKind::off, .numbers = {1}, .count = 1};
    ASSERT_TRUE(rig.flight.set_fault(first_off).is_accepted());
    rig.run(0.1);
    EXPECT_EQ(rig.flight.outputs()[0], 0);
    EXPECT_GT(rig.flight.outputs()[1], 0);
    ASSERT_TRUE(rig.run_until([&] { return rig.height() < 1; }, 10));
    rig.run(20, [&] { ASSERT_TRUE(rig.place().allFinite()); });
    EXPECT_LT(rig.height(), 1);
}

TEST(Faults, OfMotorsThatTheVehicleLacksAreRefused) {
    FlightRig rig(ready);
    const auto outcome = rig.flight.set_fault({FaultPart::motor, FaultKind::off, {5}, 1});
    EXPECT_EQ(outcome.text, "the vehicle has 4 motors");
    EXPECT_FALSE(outcome.is_accepted());
    const VehicleOptions rover{.kind = Kind::rover, .ready_after = Nanoseconds{0}};
    FlightRig other(rover);
    EXPECT_FALSE(other.flight.set_fault({FaultPart::motor, FaultKind::off}).is_accepted());
}

TEST(Faults, OneMotorWorksAgainWhileTheOthersFail) {
    FlightRig rig(ready);
    rig.take_off(20);
    ASSERT_TRUE(rig.flight.set_fault({FaultPart::motor, FaultKind::off}).is_accepted());
    ASSERT_TRUE(rig.flight.set_fault({FaultPart::motor, FaultKind::ok, {2}, 1}).is_accepted());
    rig.run(0.1);
    EXPECT_EQ(rig.flight.outputs()[0], 0);
    EXPECT_GT(rig.flight.outputs()[1], 0);
    ASSERT_TRUE(rig.flight.set_fault({FaultPart::motor, FaultKind::ok}).is_accepted());
    EXPECT_TRUE(rig.flight.faults().empty());
}

// The vehicle holds what it takes for its place, so it really moves the other way. It lags about a metre behind.
TEST(Faults, ADriftOfTheGpsCarriesTheVehicleAway) {
    FlightRig rig(ready);
    rig.take_off(10);
    ASSERT_TRUE(rig.set_mode("Hold").is_accepted());
    rig.run(5);
    const Vector3 truth = rig.flight.truth().position, place = rig.place();
    ASSERT_TRUE(rig.flight.set_fault({FaultPart::gps, FaultKind::drift, {0, 1}, 2}).is_accepted());
    rig.run(20);
    EXPECT_NEAR(rig.place().y(), place.y(), 1.5);
    EXPECT_NEAR(rig.flight.truth().position.y(), truth.y() - 19.5, 1.5);
    EXPECT_EQ(rig.mode(), "Hold");
}

TEST(Faults, StayOverARebootAndInjectedFailuresDoNot) {
    FlightRig rig(ready);
    ASSERT_TRUE(rig.flight.set_fault({FaultPart::compass, FaultKind::off}).is_accepted());
    ASSERT_TRUE(rig.flight.inject_failures({.barometer = Failure::off}).is_accepted());
    rig.flight.reboot();
    EXPECT_EQ(rig.flight.sensors().failures().magnetometer, Failure::off);
    EXPECT_EQ(rig.flight.sensors().failures().barometer, Failure::none);
    ASSERT_TRUE(rig.flight.set_fault({FaultPart::all, FaultKind::ok}).is_accepted());
    EXPECT_EQ(rig.flight.sensors().failures().magnetometer, Failure::none);
}

TEST(Faults, ABatteryThatReportsNothingCarriesTheVehicle) {
    FlightRig rig(ready);
    rig.set("COM_LOW_BAT_ACT", 0);  // only a warning
    rig.take_off(10);
    ASSERT_TRUE(rig.flight.set_fault({FaultPart::battery, FaultKind::off}).is_accepted());
    rig.run(5);
    EXPECT_EQ(rig.flight.battery().remaining(), 0);
    EXPECT_NEAR(rig.height(), 10, 0.5);
    EXPECT_GT(rig.flight.battery().voltage(), 14);
}

TEST(Arming, ATerminatedVehicleStaysSo) {
    FlightRig rig(ready);
    EXPECT_FALSE(rig.flight.terminate().is_accepted());
    rig.take_off(5);
    ASSERT_TRUE(rig.flight.terminate().is_accepted());
    EXPECT_EQ(rig.mode(), "Termination");
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::terminated);
    rig.run(5);
    EXPECT_FALSE(rig.flight.arm(true, OrderedBy::client).is_accepted());
    EXPECT_FALSE(rig.set_mode("Hold").is_accepted());
    rig.flight.reboot();
    rig.run(1);
    EXPECT_TRUE(rig.arm().is_accepted());
}

// --- Take-off and landing

TEST(TakeOff, GoesThroughTheStatesOfPx4) {
    FlightRig rig(ready);
    rig.run(1);
    ASSERT_TRUE(rig.flight.take_off({.altitude = 499.4}).is_accepted());  // disarmed: it waits
    rig.run(3);
    EXPECT_EQ(rig.mode(), "Takeoff");
    EXPECT_EQ(rig.flight.landed(), on_ground);
    ASSERT_TRUE(rig.arm().is_accepted());
    const double start = rig.seconds();
    ASSERT_TRUE(rig.run_until([&] { return rig.flight.landed() == takeoff; }, 5));
    EXPECT_GT(rig.seconds() - start, 1);  // COM_SPOOLUP_TIME
    ASSERT_TRUE(rig.run_until([&] { return rig.flight.landed() == in_air; }, 15));
    EXPECT_EQ(rig.mode(), "Hold");
    EXPECT_NEAR(rig.height(), 9.2, 0.5);  // NAV_MC_ALT_RAD before the goal
    rig.run(8);

    EXPECT_NEAR(rig.height(), 10, 0.2);
    EXPECT_THAT(rig.landed, ElementsAre(on_ground, takeoff, in_air));
    EXPECT_TRUE(rig.was_said("Takeoff detected"));
    EXPECT_GT(rig.flight.took_off_at(), rig.flight.armed_at());
}

TEST(TakeOff, WithoutAnAltitudeClimbsAsTheParameterStates) {
    FlightRig rig(ready);
    rig.set("MIS_TAKEOFF_ALT", 4);
    ASSERT_TRUE(rig.arm().is_accepted());
    ASSERT_TRUE(rig.flight.take_off({}).is_accepted());
    rig.run(15);

    EXPECT_NEAR(rig.height(), 4, 0.3);
    EXPECT_EQ(rig.mode(), "Hold");
}

TEST(TakeOff, DoesNotDescendToALowAltitude) {
    FlightRig rig(ready);
    rig.take_off(10);
    EXPECT_TRUE(rig.flight.take_off({.altitude = 489.4 + 3}).is_accepted());
    EXPECT_THAT(rig.texts, Contains(HasSubstr("takeoff altitude")));
    rig.run(8);

    EXPECT_NEAR(rig.height(), 10, 0.3);
    EXPECT_EQ(rig.mode(), "Hold");
}

TEST(Landing, DescendsSlowerNearTheGroundAndDisarms) {
    FlightRig rig(ready);
    rig.take_off(20);
    ASSERT_TRUE(rig.flight.land({}).is_accepted());
    double high = 0, low = 0;
    ASSERT_TRUE(rig.run_until(
        [&] {
            const double sink = rig.flight.truth().velocity.z();
            if (rig.height() > 11) high = std::max(high, sink);
            if (rig.height() < 4.5) low = std::max(low, sink);
            return rig.flight.landed() == on_ground;
        },
        60));
    const double landed = rig.seconds();
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 5));

    EXPECT_NEAR(high, 1.5, 0.1);
    EXPECT_NEAR(low, 0.7, 0.1);
    EXPECT_NEAR(rig.seconds() - landed, 2, 0.1);
    EXPECT_THAT(rig.landed, ElementsAre(on_ground, takeoff, in_air, landing, on_ground));
    EXPECT_EQ(rig.mode(), "Hold");
    EXPECT_TRUE(rig.was_said("Landing detected"));
    EXPECT_TRUE(rig.was_said("Disarmed by landing"));
}

TEST(Return, ClimbsFliesHomeAndLands) {
    FlightRig rig(ready);
    rig.take_off(10);
    const GeoPoint far = rig.point(60, 20, 10);
    ASSERT_TRUE(rig.flight.reposition({.latitude = far.latitude, .longitude = far.longitude}).is_accepted());
    rig.run(30);
    ASSERT_TRUE(rig.flight.return_home().is_accepted());
    double highest = 0;
    ASSERT_TRUE(rig.run_until(
        [&] {
            highest = std::max(highest, rig.height());
            return !rig.flight.armed();
        },
        120));

    EXPECT_NEAR(highest, 30, 0.3);  // RTL_RETURN_ALT
    EXPECT_LT(rig.flight.truth().position.head<2>().norm(), 0.5);
    EXPECT_EQ(rig.mode(), "Hold");
}

TEST(Return, NearHomeTheConeAllowsALowerAltitude) {
    FlightRig rig(ready);
    rig.take_off(5);
    const GeoPoint near = rig.point(20, 0, 5);
    ASSERT_TRUE(rig.flight.reposition({.latitude = near.latitude, .longitude = near.longitude}).is_accepted());
    rig.run(15);
    ASSERT_TRUE(rig.flight.return_home().is_accepted());
    double highest = 0;
    rig.run(40, [&] { highest = std::max(highest, rig.height()); });

    EXPECT_NEAR(highest, 20, 0.6);  // 45 degrees
}

// --- Points and circles

TEST(Reposition, FliesToThePointNoseFirstAndStays) {
    FlightRig rig(ready);
    rig.take_off(10);
    const GeoPoint to = rig.point(0, 40, 15);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude, .altitude = to.altitude})
                    .is_accepted());
    rig.run(4);
    EXPECT_NEAR(to_degrees(rig.flight.estimate().heading), 90, 4);
    ASSERT_TRUE(rig.flight.target());
    EXPECT_NEAR(rig.flight.target()->position.y(), 40, 0.01);
    rig.run(20);

    EXPECT_LT((rig.place() - Vector3(0, 40, -15)).norm(), 0.4);
    EXPECT_EQ(rig.mode(), "Hold");
}

TEST(Reposition, TurnsTheNoseAsAsked) {
    FlightRig rig(ready);
    rig.take_off(10);
    const GeoPoint to = rig.point(20, 0, 10);
    ASSERT_TRUE(
        rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude, .yaw = to_radians(200)}).is_accepted());
    rig.run(15);
    EXPECT_NEAR(to_degrees(rig.flight.estimate().heading), 200, 2);
}

TEST(Reposition, WithoutAnythingGivenStops) {
    FlightRig rig(ready);
    rig.take_off(10);
    const GeoPoint to = rig.point(100, 0, 10);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    rig.run(5);
    const double north = rig.place().x();
    ASSERT_GT(rig.ground_speed(), 4);
    ASSERT_TRUE(rig.flight.reposition({}).is_accepted());
    rig.run(8);

    EXPECT_LT(rig.ground_speed(), 0.1);
    EXPECT_THAT(rig.place().x() - north, AllOf(Ge(3), Le(12)));
}

TEST(Reposition, RefusesPlacesThatDoNotExist) {
    FlightRig rig(ready);
    rig.take_off(10);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(rig.flight.reposition({.latitude = 91, .longitude = 8}).result, Result::denied);
    EXPECT_EQ(rig.flight.reposition({.latitude = 47}).result, Result::denied);
    EXPECT_EQ(rig.flight.reposition({.latitude = infinity, .longitude = infinity}).result, Result::denied);
    ASSERT_TRUE(rig.set_mode("Land").is_accepted());
    EXPECT_EQ(rig.flight.reposition({.latitude = 47.4, .longitude = 8.5, .may_change_mode = false}).result,
              Result::denied);
    EXPECT_EQ(rig.mode(), "Land");
}

TEST(Flight, ChangesAltitudeAndSpeed) {
    FlightRig rig(ready);
    rig.take_off(10);
    ASSERT_TRUE(rig.flight.change_altitude(489.4 + 18).is_accepted());
    rig.run(12);
    EXPECT_NEAR(rig.height(), 18, 0.3);

    ASSERT_TRUE(rig.flight.change_speed(SpeedKind::ground, 2).is_accepted());
    const GeoPoint to = rig.point(100, 0, 18);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    rig.run(6);
    EXPECT_NEAR(rig.ground_speed(), 2, 0.15);
    ASSERT_TRUE(rig.flight.change_speed(SpeedKind::ground, 8).is_accepted());
    rig.run(6);
    EXPECT_NEAR(rig.ground_speed(), 8, 0.3);
    ASSERT_TRUE(rig.flight.change_speed(SpeedKind::ground, -1).is_accepted());
    rig.run(4);
    EXPECT_NEAR(rig.ground_speed(), 5, 0.2);

    ASSERT_TRUE(rig.set_mode("Return").is_accepted());
    EXPECT_EQ(rig.flight.change_altitude(600).result, Result::temporarily_rejected);
}

TEST(Flight, LooksAtARegionOfInterest) {
    FlightRig rig(ready);
    rig.take_off(10);
    ASSERT_TRUE(rig.flight.set_roi(rig.point(-50, -50, 0)).is_accepted());
    rig.run(6);
    EXPECT_NEAR(to_degrees(rig.flight.estimate().heading), 225, 2);
    ASSERT_TRUE(rig.flight.set_roi(std::nullopt).is_accepted());
    EXPECT_FALSE(rig.flight.region_of_interest());
    EXPECT_FALSE(rig.flight.set_roi(GeoPoint{nan, 3, 0}).is_accepted());
}

class OrbitTest : public ::testing::TestWithParam<double> {};

TEST_P(OrbitTest, FliesAroundThePointNoseToItsCentre) {
    FlightRig rig(ready);
    rig.take_off(15);
    const GeoPoint center = rig.point(30, 0, 15);
    ASSERT_TRUE(
        rig.flight.orbit({.latitude = center.latitude, .longitude = center.longitude, .radius = GetParam(), .speed = 4})
            .is_accepted());
    EXPECT_EQ(rig.mode(), "Orbit");
    rig.run(25);
    ASSERT_TRUE(rig.flight.orbit_status());
    EXPECT_EQ(rig.flight.orbit_status()->radius, GetParam());
    double turned = 0, last = nan;
    rig.run(20, [&] {
        const Vector3 out = rig.place() - Vector3(30, 0, -15);
        ASSERT_NEAR(out.head<2>().norm(), std::abs(GetParam()), 0.8);
        const double bearing = std::atan2(out.y(), out.x());
        if (!std::isnan(last)) turned += wrap_pi(bearing - last);
        last = bearing;
        ASSERT_NEAR(wrap_pi(bearing + pi - rig.flight.estimate().euler.yaw), 0, 0.15);
    });
    EXPECT_NEAR(turned, 20 * 4 / GetParam(), 0.3);
}
INSTANTIATE_TEST_SUITE_P(Directions, OrbitTest, ::testing::Values(20.0, -20.0));

TEST(Orbit, EndsAfterItsTurnsAndRefusesNonsense) {
    FlightRig rig(ready);
    rig.take_off(15);
    EXPECT_EQ(rig.flight.orbit({.radius = 5000}).result, Result::denied);
    EXPECT_EQ(rig.flight.orbit({.latitude = 95, .longitude = 0, .radius = 10}).result, Result::denied);
    ASSERT_TRUE(rig.flight.orbit({.radius = 8, .speed = 4, .turns = 1}).is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Hold"; }, 40));
    EXPECT_FALSE(rig.flight.orbit_status());
}

// --- Home and origin

TEST(Home, StaysWhereAClientPutsIt) {
    FlightRig rig(ready);
    rig.run(1);
    ASSERT_TRUE(rig.flight.set_home(rig.point(10, 20, -3), to_radians(45)).is_accepted());
    EXPECT_EQ(rig.home_changes, 2);
    EXPECT_NEAR(rig.flight.home()->altitude, 486.4, 1e-6);
    EXPECT_NEAR(rig.flight.home_yaw(), to_radians(45), 1e-9);
    ASSERT_TRUE(rig.arm().is_accepted());
    EXPECT_NEAR(rig.flight.home()->altitude, 486.4, 1e-6);
    EXPECT_FALSE(rig.flight.set_home(GeoPoint{nan, 8, 0}, 0).is_accepted());
    EXPECT_FALSE(rig.flight.set_home(GeoPoint{47, 181, 0}, 0).is_accepted());
}

TEST(Origin, MovesTheLocalFrameAndNotTheVehicle) {
    FlightRig rig(ready);
    rig.take_off(10);
    const GeoPoint before = rig.flight.position();
    const GeoPoint origin{47.40, 8.55, 450};
    ASSERT_TRUE(rig.flight.set_origin(origin).is_accepted());

    EXPECT_EQ(rig.flight.frame().origin().latitude, 47.40);
    EXPECT_LT(distance_m(rig.flight.position(), before), 0.01);
    EXPECT_NEAR(rig.place().z(), -(before.altitude - 450), 1e-6);
    rig.run(20);
    EXPECT_LT(distance_m(rig.flight.position(), before), 0.4);
    EXPECT_NEAR(rig.flight.position().altitude, before.altitude, 0.3);
    ASSERT_TRUE(rig.flight.return_home().is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 60));
    EXPECT_LT(distance_m(rig.flight.position(), *rig.flight.home()), 1);

    EXPECT_FALSE(rig.flight.set_origin({10, 10, 0}).is_accepted());
    EXPECT_FALSE(rig.flight.set_origin({nan, 10, 0}).is_accepted());
}

// --- Modes

TEST(Modes, DisarmedAnyIsAllowedArmedOnlyWhatCanFly) {
    FlightRig rig(ready);
    for (const char* const name : {"Mission", "Offboard", "Position", "Return", "Hold"})
        EXPECT_TRUE(rig.set_mode(name).is_accepted()) << name;
    rig.take_off(10);
    for (const char* const name : {"Mission", "Offboard", "Position", "Termination", "Descend"}) {
        EXPECT_EQ(rig.set_mode(name).result, Result::temporarily_rejected) << name;
        EXPECT_EQ(rig.mode(), "Hold");
    }
    EXPECT_THAT(rig.texts, Contains(HasSubstr("Position")));
    EXPECT_TRUE(rig.set_mode("Land").is_accepted());
}

TEST(Modes, EachChangeIsReported) {
    FlightRig rig(ready);
    const int before = rig.state_changes;
    ASSERT_TRUE(rig.set_mode("Return").is_accepted());
    ASSERT_TRUE(rig.set_mode("Return").is_accepted());
    EXPECT_EQ(rig.state_changes, before + 1);
}

// --- Pilot

TEST(Sticks, InPositionTheyMoveAndCenteredTheyHold) {
    FlightRig rig(ready);
    rig.take_off(10);
    rig.flight.on_sticks({});
    ASSERT_TRUE(rig.set_mode("Position").is_accepted());
    const auto fly = [&](double seconds, const Sticks& sticks) {
        rig.run(seconds, [&] { rig.flight.on_sticks(sticks); });
    };
    fly(4, {.roll = 0.5});
    EXPECT_GT(rig.place().y(), 5);
    EXPECT_GT(rig.flight.estimate().velocity.y(), 3);
    fly(6, {});
    const Vector3 stopped = rig.place();
    fly(10, {});
    EXPECT_LT((rig.place() - stopped).norm(), 0.3);
    fly(3, {.throttle = 1});
    EXPECT_GT(rig.height(), 14);
    fly(2, {.yaw = 1});
    EXPECT_GT(std::abs(rig.flight.estimate().euler.yaw), 1);
}

TEST(Sticks, FliesFromAndToTheGroundByHand) {
    FlightRig rig(ready);
    rig.run(1);
    rig.flight.on_sticks({.throttle = 0});
    ASSERT_TRUE(rig.set_mode("Altitude").is_accepted());
    ASSERT_TRUE(rig.arm().is_accepted());
    const auto fly = [&](double seconds, double throttle) {
        rig.run(seconds, [&] { rig.flight.on_sticks({.throttle = throttle}); });
    };
    fly(3, 0);
    EXPECT_EQ(rig.flight.landed(), on_ground);
    fly(6, 0.9);
    EXPECT_EQ(rig.flight.landed(), in_air);
    EXPECT_GT(rig.height(), 3);
    fly(40, 0);
    EXPECT_EQ(rig.flight.landed(), on_ground);
    EXPECT_FALSE(rig.flight.armed());
}

TEST(Sticks, StabilizedTiltsTheVehicle) {
    FlightRig rig(ready);
    rig.take_off(30);
    rig.flight.on_sticks({});
    ASSERT_TRUE(rig.set_mode("Stabilized").is_accepted());
    rig.run(1.5, [&] { rig.flight.on_sticks({.pitch = 0.5, .throttle = 0.55}); });
    EXPECT_NEAR(to_degrees(rig.flight.estimate().euler.pitch), -17.5, 2);
}

// --- External controller

class OffboardTest : public ::testing::Test {
protected:
    void feed(double seconds, const OffboardSetpoint& setpoint, double interval = 0.05) {
        for (double t = 0; t < seconds; t += interval) {
            rig.flight.on_offboard(setpoint);
            rig.run(interval);
        }
    }
    void begin() {
        rig.take_off(10);
        EXPECT_EQ(rig.set_mode("Offboard").result, Result::temporarily_rejected);
        feed(0.5, {.velocity = Vector3::Zero()});
        ASSERT_TRUE(rig.set_mode("Offboard").is_accepted());
    }

    FlightRig rig{ready};
};

TEST_F(OffboardTest, FollowsVelocityPositionAndAttitude) {
    begin();
    feed(4, {.velocity = {2, -1, 0}, .yaw = 1});
    EXPECT_NEAR(rig.flight.estimate().velocity.x(), 2, 0.1);
    EXPECT_NEAR(rig.flight.estimate().velocity.y(), -1, 0.1);
    EXPECT_NEAR(rig.flight.estimate().euler.yaw, 1, 0.05);
    feed(2, {.velocity = {0, 0, 0}, .yaw_rate = 0.3});
    EXPECT_NEAR(rig.flight.estimate().rates.z(), 0.3, 0.05);
    feed(15, {.position = {5, 5, -12}, .yaw = 0});
    EXPECT_LT((rig.place() - Vector3(5, 5, -12)).norm(), 0.3);
    feed(1.5, {.steering = Steering::attitude, .attitude = to_quaternion({0.2, 0, 0}), .thrust = 0.52});
    EXPECT_NEAR(rig.flight.estimate().euler.roll, 0.2, 0.03);
    EXPECT_EQ(rig.mode(), "Offboard");
}

TEST_F(OffboardTest, ReturnsWhenTheSetpointsEndAndComesBackWhenTheyDo) {
    begin();
    feed(2, {.velocity = {1, 0, 0}});
    const double last = rig.seconds();
    ASSERT_TRUE(rig.run_until([&] { return rig.mode() == "Return"; }, 3));
    EXPECT_NEAR(rig.seconds() - last, 1, 0.1);  // COM_OF_LOSS_T
    EXPECT_EQ(rig.flight.intended_mode().name, "Offboard");
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::critical);
    EXPECT_TRUE(rig.flight.has_failsafe());

    feed(1, {.velocity = {1, 0, 0}});
    EXPECT_EQ(rig.mode(), "Offboard");
    EXPECT_FALSE(rig.flight.has_failsafe());
}

TEST_F(OffboardTest, NumbersThatAreNotFiniteMeanNotGiven) {
    begin();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    feed(3, {.position = {infinity, nan, -1e300}, .velocity = {1e300, -infinity, nan}, .yaw = infinity});
    feed(3, {.steering = Steering::attitude, .attitude = Quaternion(nan, 0, 0, 0), .thrust = 1});
    EXPECT_TRUE(rig.flight.truth().position.allFinite());
    EXPECT_LT(rig.flight.truth().velocity.norm(), 30);
}

TEST_F(OffboardTest, TakesOffFromTheGround) {
    rig.run(1);
    feed(1, {.position = {0, 0, -5}});
    ASSERT_TRUE(rig.set_mode("Offboard").is_accepted());
    ASSERT_TRUE(rig.arm().is_accepted());
    feed(12, {.position = {0, 0, -5}});
    EXPECT_NEAR(rig.height(), 5, 0.3);
    EXPECT_EQ(rig.flight.landed(), in_air);
}

// --- ArduPilot

TEST(ArduPilot, TakesOffInGuidedOnly) {
    FlightRig rig(copter_of_ardupilot);
    rig.run(1);
    EXPECT_EQ(rig.mode(), "STABILIZE");
    ASSERT_TRUE(rig.arm().is_accepted());
    EXPECT_EQ(rig.flight.take_off({.altitude = 499.4}).result, Result::failed);
    ASSERT_TRUE(rig.set_mode("GUIDED").is_accepted());
    ASSERT_TRUE(rig.flight.take_off({.altitude = 499.4}).is_accepted());
    ASSERT_TRUE(rig.flight.take_off({.altitude = 499.4}).is_accepted());
    rig.run(20);
    EXPECT_NEAR(rig.height(), 10, 0.3);
    EXPECT_EQ(rig.mode(), "GUIDED");
    EXPECT_EQ(rig.flight.landed(), in_air);
}

TEST(ArduPilot, GuidedFliesToPointsAndFollowsVelocities) {
    FlightRig rig(copter_of_ardupilot);
    rig.take_off(10);
    const GeoPoint to = rig.point(30, -20, 14);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude, .altitude = to.altitude})
                    .is_accepted());
    rig.run(20);
    EXPECT_LT((rig.place() - Vector3(30, -20, -14)).norm(), 0.5);
    rig.run(3, [&] { rig.flight.on_offboard({.velocity = {0, 3, 0}}); });
    EXPECT_NEAR(rig.flight.estimate().velocity.y(), 3, 0.2);
    rig.run(8);  // the set-points ended
    EXPECT_LT(rig.ground_speed(), 0.1);
    EXPECT_EQ(rig.mode(), "GUIDED");
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::active);
}

TEST(ArduPilot, LoiterWithoutARemoteControlHolds) {
    FlightRig rig(copter_of_ardupilot);
    rig.take_off(10);
    ASSERT_TRUE(rig.set_mode("LOITER").is_accepted());
    rig.run(20);
    EXPECT_NEAR(rig.height(), 10, 0.4);
    EXPECT_LT(rig.place().head<2>().norm(), 1);
}

TEST(ArduPilot, ReturnsAndLandsInItsMode) {
    FlightRig rig(copter_of_ardupilot);
    rig.take_off(10);
    const GeoPoint to = rig.point(40, 0, 10);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    rig.run(15);
    ASSERT_TRUE(rig.set_mode("RTL").is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 120));
    EXPECT_LT(rig.place().head<2>().norm(), 1);
    EXPECT_EQ(rig.mode(), "RTL");
}

// --- Other vehicles

class PlaneTest : public ::testing::TestWithParam<Autopilot> {};

TEST_P(PlaneTest, TakesOffCirclesReturnsAndLands) {
    FlightRig rig(of(Kind::plane, GetParam()));
    rig.take_off(50);
    EXPECT_THAT(rig.landed, ElementsAre(on_ground, takeoff, in_air));
    rig.run(40);
    EXPECT_NEAR(rig.height(), 50, 3);
    EXPECT_GT(rig.ground_speed(), 10);

    const GeoPoint to = rig.point(400, 300, 70);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude, .altitude = to.altitude})
                    .is_accepted());
    rig.run(60);
    double nearest = 1e9, farthest = 0;
    rig.run(40, [&] {
        const double distance = (rig.place() - Vector3(400, 300, -70)).head<2>().norm();
        nearest = std::min(nearest, distance);
        farthest = std::max(farthest, distance);
    });
    EXPECT_NEAR(nearest, std::abs(rig.flight.tuning().loiter_radius), 12);
    EXPECT_NEAR(farthest, std::abs(rig.flight.tuning().loiter_radius), 12);
    EXPECT_NEAR(rig.height(), 70, 3);

    ASSERT_TRUE(rig.flight.return_home().is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return rig.place().head<2>().norm() < 100; }, 80));
    ASSERT_TRUE(rig.flight.land({}).is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return rig.flight.landed() == on_ground; }, 120));
    EXPECT_LT(rig.ground_speed(), 0.5);
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 30));
}

TEST_P(PlaneTest, FliesNoSlowerThanItsSmallestAirspeed) {
    FlightRig rig(of(Kind::plane, GetParam()));
    const bool is_px4 = GetParam() == Autopilot::px4;
    rig.take_off(50);
    rig.set(is_px4 ? "FW_AIRSPD_TRIM" : "AIRSPEED_CRUISE", 10);
    rig.set(is_px4 ? "FW_AIRSPD_MIN" : "AIRSPEED_MIN", 14);
    rig.run(40);
    EXPECT_NEAR(rig.ground_speed(), 14, 1);
}
INSTANTIATE_TEST_SUITE_P(Firmwares, PlaneTest, ::testing::Values(Autopilot::px4, Autopilot::ardupilot));

class RoverFlightTest : public ::testing::TestWithParam<Autopilot> {};

TEST_P(RoverFlightTest, DrivesToPointsAndHomeOnTheGround) {
    FlightRig rig(of(Kind::rover, GetParam()));
    rig.run(1);
    EXPECT_FALSE(rig.flight.take_off({.altitude = 500}).is_accepted());
    if (GetParam() == Autopilot::ardupilot) {
        ASSERT_TRUE(rig.set_mode("GUIDED").is_accepted());
    }
    ASSERT_TRUE(rig.arm().is_accepted());
    const GeoPoint to = rig.point(30, 20, 0);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    rig.run(5);
    EXPECT_FALSE(rig.disarm().is_accepted());
    rig.run(35);
    EXPECT_LT((rig.place() - Vector3(30, 20, 0)).head<2>().norm(), 1.5);
    EXPECT_NEAR(rig.height(), 0, 0.2);
    EXPECT_TRUE(rig.flight.armed());
    ASSERT_TRUE(rig.flight.return_home().is_accepted());
    rig.run(60);
    EXPECT_LT(rig.place().head<2>().norm(), 3);
    EXPECT_TRUE(rig.disarm().is_accepted());
}
INSTANTIATE_TEST_SUITE_P(Firmwares, RoverFlightTest, ::testing::Values(Autopilot::px4, Autopilot::ardupilot));

TEST(RandomMotion, IsAlwaysArmedInTheAirAndCoherent) {
    FlightRig rig({.motion = Motion::random});
    Vector3 last = rig.place();
    double farthest = 0, fastest = 0;
    rig.run(600, [&] {
        ASSERT_TRUE(rig.flight.armed());
        ASSERT_EQ(rig.flight.landed(), in_air);
        ASSERT_LT((rig.place() - last - rig.flight.estimate().velocity * step_s).norm(), 1e-9);
        ASSERT_GT(rig.height(), 2);
        last = rig.place();
        farthest = std::max(farthest, last.norm());
        fastest = std::max(fastest, rig.ground_speed());
    });
    EXPECT_THAT(farthest, AllOf(Ge(50), Le(500)));
    EXPECT_THAT(fastest, AllOf(Ge(5), Le(12)));
    EXPECT_FALSE(rig.disarm().is_accepted());
}

// --- Coherence

TEST(Coherence, HoldsAtEveryStepOfAFlight) {
    VehicleOptions options = ready;
    options.wind = {.speed_m_s = 4, .direction_deg = 200, .gust_m_s = 1};
    FlightRig rig(options);
    Estimate last = rig.flight.estimate();
    double charge = rig.flight.battery().remaining();
    const auto look = [&] {
        const Estimate& now = rig.flight.estimate();
        const Kinematics& truth = rig.flight.truth();
        ASSERT_LT((now.position - last.position - now.velocity * step_s).norm(), 1e-9);
        ASSERT_LT((now.position - truth.position).norm(), 0.25);
        ASSERT_LT(to_degrees(now.attitude.angularDistance(truth.attitude)), 2);
        const double turned = last.attitude.angularDistance(now.attitude);
        ASSERT_NEAR(turned, now.rates.norm() * step_s, 0.0002);
        ASSERT_NEAR(wrap_pi(now.heading - yaw_of(now.attitude)), 0, 1e-9);
        ASSERT_LT((rig.flight.frame().to_local(rig.flight.position()) - now.position).norm(), 1e-6);
        const double left = rig.flight.battery().remaining();
        if (rig.flight.armed()) {
            ASSERT_LE(left, charge);
        }
        charge = left;
        last = now;
    };
    rig.run(1, look);
    ASSERT_TRUE(rig.arm().is_accepted());
    ASSERT_TRUE(rig.flight.take_off({.altitude = 501}).is_accepted());
    rig.run(16, look);
    const GeoPoint to = rig.point(30, 30, 15);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    rig.run(20, look);
    ASSERT_TRUE(rig.flight.return_home().is_accepted());
    rig.run(60, look);
    EXPECT_FALSE(rig.flight.armed());
}

TEST(Coherence, TheSameSeedFliesTheSameFlight) {
    const auto end = [](std::uint64_t seed) {
        VehicleOptions options = ready;
        options.seed = seed;
        options.wind = {.speed_m_s = 3, .gust_m_s = 1};
        FlightRig rig(options);
        rig.take_off(8);
        return rig.place();
    };
    EXPECT_EQ(end(4), end(4));
    EXPECT_NE(end(4), end(5));
}

TEST(Flight, BootsAgainWhereItStands) {
    FlightRig rig;
    rig.take_off(5);
    const GeoPoint to = rig.point(15, 0, 5);
    ASSERT_TRUE(rig.flight.reposition({.latitude = to.latitude, .longitude = to.longitude}).is_accepted());
    rig.run(10);
    ASSERT_TRUE(rig.flight.land({}).is_accepted());
    ASSERT_TRUE(rig.run_until([&] { return !rig.flight.armed(); }, 40));
    const GeoPoint here = rig.flight.position();
    rig.flight.reboot();

    EXPECT_EQ(rig.seconds(), 0);
    EXPECT_EQ(rig.flight.system_status(), SystemStatus::uninitialised);
    EXPECT_FALSE(rig.flight.home());
    EXPECT_LT(distance_m(rig.flight.position(), here), 0.01);
    rig.run(3);
    EXPECT_EQ(rig.flight.unready(), 0u);
    EXPECT_LT(rig.place().norm(), 0.3);  // the new local frame begins here
}

}  // namespace
}  // namespace mavloom::flight
