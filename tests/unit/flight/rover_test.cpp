// SPDX-License-Identifier: MIT
// The rover and its pilot, without a flight around them.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "unit/flight/support/any_setpoint.hpp"
#include "unit/flight/support/piloted.hpp"

namespace mavloom::flight {
namespace {

class RoverTest : public ::testing::Test {
protected:
    RoverTest() { rover.place(Vector3::Zero(), 0); }

    void run(double seconds, const std::function<void()>& look = {}) {
        for (double t = 0; t < seconds; t += step_s) {
            rover.step(setpoint, true, around);
            if (look) look();
        }
    }
    void drive_straight() {
        setpoint.steering = Steering::trajectory;
        setpoint.velocity = {5, 0, nan};
        run(5);
    }
    [[nodiscard]] const Kinematics& motion() const { return rover.motion(); }
    [[nodiscard]] double yaw() const { return yaw_of(motion().attitude); }
    [[nodiscard]] double speed() const { return motion().velocity.norm(); }

    test::Piloted rover{Kind::rover};
    Setpoint setpoint;
    Surroundings around;
};

TEST_F(RoverTest, MotionIsTheIntegralOfItsRatesAndStaysOnTheGround) {
    Kinematics last = motion();
    Random random(3);
    setpoint.steering = Steering::trajectory;
    for (int i = 0; i < 40; ++i) {
        setpoint.position = {random.uniform(-30, 30), random.uniform(-30, 30), 0};
        run(3, [&] {
            ASSERT_LT((motion().position - last.position - motion().velocity * step_s).norm(), 1e-9);
            ASSERT_LT((motion().velocity - last.velocity - motion().acceleration * step_s).norm(), 1e-9);
            ASSERT_LT(motion().attitude.angularDistance(integrate(last.attitude, motion().rates, step_s)), 1e-7);
            ASSERT_EQ(motion().position.z(), 0);
            const Euler euler = to_euler(motion().attitude);
            ASSERT_NEAR(euler.roll, 0, 1e-9);
            ASSERT_NEAR(euler.pitch, 0, 1e-9);
            last = motion();
        });
    }
}

TEST_F(RoverTest, AcceleratesAndBrakesWithinItsLimit) {
    double hardest = 0;
    const auto look = [&] { hardest = std::max(hardest, motion().acceleration.norm()); };
    setpoint.steering = Steering::trajectory;
    setpoint.velocity = {5, 0, nan};
    run(4, look);
    EXPECT_NEAR(speed(), 5, 0.01);
    const double north = motion().position.x();
    setpoint.velocity = {0, 0, 0};
    run(4, look);

    EXPECT_LE(hardest, 3.001);
    EXPECT_EQ(speed(), 0);
    // v^2 / (2 a) = 4.2 m at the limit, and a little more for the lag.
    EXPECT_THAT(motion().position.x() - north, ::testing::AllOf(::testing::Ge(4.1), ::testing::Le(5.2)));
}

TEST_F(RoverTest, TurnsNoTighterThanItsFrontWheelsAllow) {
    setpoint.steering = Steering::actuators;
    setpoint.mixer = {0, 0, 1, 0.3};
    run(5);
    double west = 0, east = 0;

    run(20, [&] {
        west = std::min(west, motion().position.y());
        east = std::max(east, motion().position.y());
    });

    EXPECT_NEAR(speed() / motion().rates.z(), 1.5, 0.01);
    EXPECT_NEAR(east - west, 3, 0.3);
}

TEST_F(RoverTest, TyresLimitTheTurnAtSpeed) {
    drive_straight();
    setpoint.steering = Steering::actuators;
    setpoint.mixer = {0, 0, 1, 1};

    run(3);

    EXPECT_NEAR(speed(), 5, 0.05);
    EXPECT_LT(std::abs(motion().rates.z()) * speed(), 4.1);
}

TEST_F(RoverTest, StopsAtTheEndOfALegOnTheLine) {
    setpoint.steering = Steering::waypoint;
    setpoint.from = {0, 4, 0};
    setpoint.position = {50, 4, 0};
    double farthest = 0;

    run(25, [&] { farthest = std::max(farthest, motion().position.x()); });

    EXPECT_EQ(speed(), 0);
    EXPECT_NEAR(motion().position.x(), 50, 0.3);
    EXPECT_NEAR(motion().position.y(), 4, 0.1);
    EXPECT_LT(farthest, 50.3);
}

TEST_F(RoverTest, ComesToRestNearAnyPlaceAroundIt) {
    setpoint.steering = Steering::trajectory;
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        setpoint.position = motion().position + Vector3{random.uniform(-12, 12), random.uniform(-12, 12), 0};
        run(15);
        ASSERT_EQ(speed(), 0) << i;
        ASSERT_LT((motion().position - setpoint.position).head<2>().norm(), 1.51) << i;
    }
}

TEST_F(RoverTest, CirclesWithItsRadiusBothWays) {
    for (const double radius : {6.0, -9.0}) {
        setpoint.steering = Steering::circle;
        setpoint.position = {10, 10, 0};
        setpoint.radius = radius;
        run(20);
        double error = 0;
        run(20, [&] {
            error = std::max(error, std::abs((motion().position - setpoint.position).norm() - std::abs(radius)));
        });
        EXPECT_LT(error, 0.3);
        EXPECT_GT(motion().rates.z() * radius, 0);
    }
}

TEST_F(RoverTest, ReversesWhenTheVelocityPointsBackwardsAndTheHeadingIsGiven) {
    setpoint.steering = Steering::trajectory;
    setpoint.velocity = {-1, 0, nan};
    setpoint.yaw = 0;

    run(5);

    EXPECT_NEAR(motion().velocity.x(), -1, 0.01);
    EXPECT_NEAR(yaw(), 0, 0.01);
}

TEST_F(RoverTest, TurnsRoundWhenOnlyABackwardsVelocityIsGiven) {
    setpoint.steering = Steering::trajectory;
    setpoint.velocity = {-2, 0, nan};

    run(10);

    EXPECT_NEAR(motion().velocity.x(), -2, 0.01);
    EXPECT_NEAR(std::abs(yaw()), pi, 0.01);
}

TEST_F(RoverTest, FollowsHeadingAndThrustByHand) {
    setpoint.steering = Steering::attitude;
    setpoint.attitude = to_quaternion({0, 0, to_radians(-120)});
    setpoint.thrust = 0.4;

    run(10);

    EXPECT_NEAR(yaw(), to_radians(-120), 0.01);
    EXPECT_NEAR(speed(), 2, 0.01);
}

TEST_F(RoverTest, StaysFiniteUnderSenselessSetpoints) {
    Random random(7);
    for (int i = 0; i < 1000; ++i) {
        setpoint = test::any_setpoint(random);
        run(0.2);
        ASSERT_TRUE(test::is_finite(motion())) << i;
        ASSERT_LT(speed(), 21) << i;
    }
}

}  // namespace
}  // namespace mavloom::flight
