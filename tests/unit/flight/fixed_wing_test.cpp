// SPDX-License-Identifier: MIT
// The plane and its pilot, without a flight around them. Expected values come from the laws of flight, not from the
// model.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "unit/flight/support/any_setpoint.hpp"
#include "unit/flight/support/piloted.hpp"

namespace mavloom::flight {
namespace {

class FixedWingTest : public ::testing::Test {
protected:
    FixedWingTest() {
        plane.place(Vector3::Zero(), 0);
        setpoint.limits.horizontal = 15;
    }

    void run(double seconds, const std::function<void()>& look = {}) {
        for (double t = 0; t < seconds; t += step_s) {
            plane.step(setpoint, armed, around);
            if (look) look();
        }
    }
    // Cruises north at 15 m/s, 100 m above the ground.
    void climb_out() {
        setpoint.steering = Steering::waypoint;
        setpoint.from = Vector3::Zero();
        setpoint.position = {3000, 0, -100};
        run(80);
    }
    void fly_circle(double radius) {
        setpoint.steering = Steering::circle;
        setpoint.position = motion().position + Vector3{0, radius, 0};
        setpoint.position.z() = -100;
        setpoint.radius = radius;
        run(30);
    }

    [[nodiscard]] const Kinematics& motion() const { return plane.motion(); }
    [[nodiscard]] Euler euler() const { return to_euler(motion().attitude); }
    [[nodiscard]] double airspeed() const { return plane.air_velocity().norm(); }
    [[nodiscard]] double ground_speed() const { return motion().velocity.head<2>().norm(); }
    [[nodiscard]] double distance_to_center() const { return (motion().position - setpoint.position).head<2>().norm(); }

    test::Piloted plane{Kind::plane};
    Setpoint setpoint;
    Surroundings around;
    bool armed = true;
};

TEST_F(FixedWingTest, PositionIsTheSumOfVelocityAndAttitudeThatOfRatesInAllPhases) {
    Kinematics last = motion();
    const auto look = [&] {
        ASSERT_LT((motion().position - last.position - motion().velocity * step_s).norm(), 1e-9);
        ASSERT_LT((motion().velocity - last.velocity - motion().acceleration * step_s).norm(), 1e-9);
        ASSERT_LT(motion().attitude.angularDistance(integrate(last.attitude, motion().rates, step_s)), 1e-7);
        last = motion();
    };
    around.wind = {2, -3, 0};

    setpoint.steering = Steering::waypoint;
    setpoint.from = Vector3::Zero();
    setpoint.position = {300, 50, -60};
    run(40, look);
    setpoint.steering = Steering::circle;
    setpoint.radius = -60;
    run(40, look);
    setpoint.touch_down = true;
    run(80, look);

    EXPECT_TRUE(plane.touches_ground());
    EXPECT_EQ(motion().velocity.norm(), 0);
}

TEST_F(FixedWingTest, StandsStillInWindUntilItIsArmed) {
    armed = false;
    around.wind = {0, 14, 0};
    setpoint.steering = Steering::waypoint;
    setpoint.position = {100, 0, -50};

    run(10);

    EXPECT_EQ(motion().position, Vector3::Zero());
    EXPECT_EQ(motion().velocity, Vector3::Zero());
    EXPECT_EQ(euler().roll, 0);
    EXPECT_EQ(plane.load(), 0);
}

TEST_F(FixedWingTest, TakesOffAlongItsHeadingAndCapturesTheAltitude) {
    plane.place(Vector3::Zero(), to_radians(90));
    setpoint.steering = Steering::waypoint;
    setpoint.from = Vector3::Zero();
    setpoint.position = {0, 1000, -50};
    double lift_off_speed = 0, highest = 0, run_length = 0;

    run(45, [&] {
        if (plane.touches_ground()) {
            lift_off_speed = airspeed();
            run_length = motion().position.y();
        }
        highest = std::max(highest, -motion().position.z());
    });

    EXPECT_THAT(lift_off_speed, ::testing::AllOf(::testing::Ge(10), ::testing::Le(15)));
    EXPECT_THAT(run_length, ::testing::AllOf(::testing::Ge(8), ::testing::Le(40)));
    EXPECT_NEAR(-motion().position.z(), 50, 0.2);
    EXPECT_LT(highest, 50.5);
    EXPECT_NEAR(motion().position.x(), 0, 0.5);
}

TEST_F(FixedWingTest, ClimbsAndDescendsWithTheLimits) {
    climb_out();
    double fastest_up = 0, fastest_down = 0;
    const auto look = [&] {
        fastest_up = std::max(fastest_up, -motion().velocity.z());
        fastest_down = std::max(fastest_down, motion().velocity.z());
    };
    setpoint.position.z() = -140;
    run(40, look);
    EXPECT_NEAR(-motion().position.z(), 140, 0.2);
    setpoint.position.z() = -100;
    run(50, look);

    EXPECT_NEAR(fastest_up, setpoint.limits.up, 0.3);
    EXPECT_NEAR(fastest_down, setpoint.limits.down, 0.3);
    EXPECT_NEAR(-motion().position.z(), 100, 0.2);
}

// Wind moves the plane over the ground: 15 m/s through air that moves at (3, 5) leave sqrt(15^2 - 5^2) + 3 northwards.
TEST_F(FixedWingTest, KeepsItsLineAndAirspeedInAWindFromTheSide) {
    climb_out();
    around.wind = {3, 5, 0};
    run(20);

    EXPECT_NEAR(airspeed(), 15, 0.2);
    EXPECT_NEAR(ground_speed(), 17.14, 0.2);
    EXPECT_NEAR(motion().position.y(), 0, 0.3);
    EXPECT_NEAR(to_degrees(euler().yaw), -19.5, 0.5);
    EXPECT_NEAR(euler().roll, 0, 0.02);
}

TEST_F(FixedWingTest, DriftsWithTheWindWhileItHoldsItsHeadingByAttitude) {
    climb_out();
    setpoint.steering = Steering::attitude;
    setpoint.attitude = to_quaternion({0, to_radians(2), 0});
    setpoint.thrust = 0.5;
    around.wind = {4, 0, 0};

    run(30);

    EXPECT_NEAR(airspeed(), 15, 0.5);
    EXPECT_NEAR(motion().velocity.x(), 19, 0.5);
}

TEST_F(FixedWingTest, BanksInATurnAsTheLawOfCircularMotionDemands) {
    climb_out();
    for (const double radius : {60.0, -100.0}) {
        fly_circle(radius);
        double error = 0;
        run(30, [&] { error = std::max(error, std::abs(distance_to_center() - std::abs(radius))); });

        EXPECT_LT(error, 0.5);
        EXPECT_NEAR(std::tan(euler().roll), ground_speed() * ground_speed() / (gravity * radius), 0.02);
        EXPECT_NEAR(plane.motion().rates.z(), 15 / radius * std::cos(euler().roll), 0.02);
        EXPECT_NEAR(-motion().position.z(), 100, 0.3);
    }
}

TEST_F(FixedWingTest, CirclesInWindWithoutLeavingTheCircle) {
    climb_out();
    around.wind = {5, 0, 0};
    fly_circle(80);
    double error = 0;

    run(60, [&] { error = std::max(error, std::abs(distance_to_center() - 80)); });

    EXPECT_LT(error, 1.5);
}

// A circle tighter than the bank limit allows: v^2 / (g tan 30 degrees) = 39.7 m.
TEST_F(FixedWingTest, TurnsNoTighterThanTheBankLimitAllows) {
    climb_out();
    setpoint.limits.tilt = to_radians(30);
    fly_circle(20);
    double steepest = 0;

    run(30, [&] { steepest = std::max(steepest, std::abs(euler().roll)); });

    EXPECT_LT(to_degrees(steepest), 31);
    EXPECT_GT(distance_to_center(), 25);
}

TEST_F(FixedWingTest, AirspeedStaysWithinItsLimits) {
    climb_out();
    for (const auto& [asked, kept] : {std::pair{2.0, 12.0}, {20.0, 20.0}, {80.0, 25.0}}) {
        setpoint.limits.horizontal = asked;
        run(30);
        EXPECT_NEAR(airspeed(), kept, 1.0) << asked;
        EXPECT_NEAR(-motion().position.z(), 100, 0.5) << asked;
    }
}

// A climb that the motor cannot provide must not stall the wings.
TEST_F(FixedWingTest, NeverStallsByAnAltitudeThatIsAskedOfIt) {
    climb_out();
    setpoint.limits.up = 10;
    setpoint.position.z() = -600;
    double slowest = 100;

    run(60, [&] { slowest = std::min(slowest, airspeed()); });

    EXPECT_GT(slowest, 10);
    EXPECT_LT(motion().velocity.z(), -2);
}

// By hand nothing protects the plane: with its nose up and no power, it stalls, drops the nose and sinks.
TEST_F(FixedWingTest, StallsWhenThePilotHoldsTheNoseUpWithoutPower) {
    climb_out();
    setpoint.steering = Steering::rates;
    setpoint.rates = {0, 0.3, 0};
    setpoint.thrust = 0;
    double slowest = 100, fastest_sink = 0;

    run(8, [&] {
        slowest = std::min(slowest, airspeed());
        fastest_sink = std::max(fastest_sink, motion().velocity.z());
    });

    EXPECT_LT(slowest, 7.2);  // stall speed: sqrt(2 m g / (density * area * 1.17))
    EXPECT_GT(fastest_sink, 4);
}

TEST_F(FixedWingTest, LandsFromALegFlaresAndStopsNearTheEnd) {
    climb_out();
    const double north = motion().position.x();
    setpoint.from = {north, 0, -100};
    setpoint.position = {north + 1200, 0, 0};
    setpoint.limits.down = 2;
    setpoint.touch_down = true;
    double sink_at_touch = -1, touch = 0, hardest = 0;

    run(110, [&] {
        if (plane.touches_ground() && sink_at_touch < 0) {
            sink_at_touch = motion().velocity.z();
            touch = motion().position.x();
        }
        hardest = std::max(hardest, motion().acceleration.norm());
    });

    EXPECT_THAT(sink_at_touch, ::testing::AllOf(::testing::Ge(0), ::testing::Le(0.7)));
    EXPECT_NEAR(touch, north + 1200, 25);
    EXPECT_LT(hardest, 2.5 * gravity);
    EXPECT_EQ(motion().velocity, Vector3::Zero());
    EXPECT_NEAR(motion().position.z(), 0, 1e-3);
    EXPECT_LT(motion().position.x() - touch, 60);
}

TEST_F(FixedWingTest, FollowsVelocityCourseAndClimbOfATrajectory) {
    climb_out();
    setpoint.steering = Steering::trajectory;
    setpoint.position = no_vector;
    setpoint.velocity = {0, 17, -1};

    run(20);

    EXPECT_NEAR(motion().velocity.y(), 17, 0.3);
    EXPECT_NEAR(motion().velocity.x(), 0, 0.3);
    EXPECT_NEAR(motion().velocity.z(), -1, 0.1);
}

TEST_F(FixedWingTest, HoldsItsAltitudeWhenATrajectoryGivesNone) {
    climb_out();
    setpoint.steering = Steering::trajectory;
    setpoint.position = setpoint.velocity = no_vector;
    setpoint.yaw_rate = 0.2;

    run(40);

    EXPECT_NEAR(-motion().position.z(), 100, 0.5);
    EXPECT_NEAR(motion().rates.z() / std::cos(euler().roll), 0.2, 0.02);
}

TEST_F(FixedWingTest, AMixerWithoutDeflectionLeavesTheAttitudeAlone) {
    climb_out();
    setpoint.steering = Steering::actuators;
    setpoint.mixer = {0, 0, 0, 0.5};
    run(5);
    EXPECT_NEAR(euler().roll, 0, 0.05);
    setpoint.mixer[0] = 0.2;
    run(0.5);

    EXPECT_GT(euler().roll, 0.1);
    EXPECT_NEAR(plane.outputs()[0], 0.2, 1e-9);
    EXPECT_TRUE(plane.channels().is_motor[2]);
}

TEST_F(FixedWingTest, WithoutMotorItGlidesDownAndComesToRest) {
    climb_out();
    armed = false;

    run(150);

    EXPECT_TRUE(plane.touches_ground());
    EXPECT_EQ(motion().velocity.norm(), 0);
    EXPECT_NEAR(euler().roll, 0, 1e-3);
}

// Any number may come from a client.
TEST_F(FixedWingTest, StaysFiniteUnderSenselessSetpoints) {
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        setpoint = test::any_setpoint(random);
        run(0.2);
        ASSERT_TRUE(test::is_finite(motion())) << i;
        ASSERT_LT(motion().velocity.norm(), 100) << i;
        ASSERT_LT(motion().position.z(), 1) << i;
    }
}

}  // namespace
}  // namespace mavloom::flight
