// SPDX-License-Identifier: MIT
// The multicopter and its pilot, without a flight around them.
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "flight/physics/noise.hpp"
#include "unit/flight/support/any_setpoint.hpp"
#include "unit/flight/support/piloted.hpp"

namespace mavloom::flight {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

class MulticopterTest : public ::testing::Test {
protected:
    MulticopterTest() {
        copter.place(Vector3::Zero(), 0);
        setpoint.steering = Steering::trajectory;
    }

    void run(double seconds, const std::function<void()>& look = {}) {
        for (long i = std::lround(seconds / step_s); i > 0; --i) {
            copter.step(setpoint, armed, around);
            if (look) look();
        }
    }
    void hover_at(const Vector3& place) {
        setpoint.position = place;
        run(15);
        ASSERT_LT((motion().position - place).norm(), 0.1);
    }
    [[nodiscard]] const Kinematics& motion() const { return copter.motion(); }
    [[nodiscard]] double tilt() const { return std::acos((motion().attitude * Vector3::UnitZ()).z()); }

    test::Piloted copter{Kind::quad};
    Setpoint setpoint;
    Surroundings around;
    bool armed = true;
};

TEST_F(MulticopterTest, MotionIsTheSumOfItsDerivatives) {
    Kinematics last = motion();
    Random random(5);
    for (int i = 0; i < 60; ++i) {
        setpoint.position = {random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-20, 1)};
        setpoint.yaw = random.uniform(-3, 3);
        around.wind = {random.uniform(-8, 8), random.uniform(-8, 8), random.uniform(-2, 2)};
        run(3, [&] {
            ASSERT_LT((motion().position - last.position - motion().velocity * step_s).norm(), 1e-9);
            ASSERT_LT((motion().velocity - last.velocity - motion().acceleration * step_s).norm(), 1e-9);
            ASSERT_LT(motion().attitude.angularDistance(integrate(last.attitude, motion().rates, step_s)), 1e-7);
            last = motion();
        });
    }
}

TEST_F(MulticopterTest, ParkedItDoesNotMoveInAStorm) {
    armed = false;
    around.wind = {12, -9, 0};

    run(20, [&] {
        ASSERT_EQ(motion().velocity, Vector3::Zero());
        ASSERT_EQ(motion().position, Vector3::Zero());
    });
    EXPECT_EQ(copter.load(), 0);
}

TEST_F(MulticopterTest, LiftsSlowlyOnceTheThrustSuffices) {
    setpoint.position = {0, 0, -10};
    double strongest = 0, lift_off = 0, t = 0;
    run(12, [&] {
        t += step_s;
        if (lift_off == 0 && motion().position.z() < -0.05) lift_off = t;
        strongest = std::max(strongest, std::abs(motion().acceleration.z()));
    });

    EXPECT_THAT(lift_off, AllOf(Ge(1.2), Le(3)));
    EXPECT_LT(strongest, 4.5);
    EXPECT_NEAR(motion().position.z(), -10, 0.1);
}

TEST_F(MulticopterTest, FliesToAPointWithinItsLimits) {
    hover_at({0, 0, -20});
    setpoint.position = {60, 0, -20};
    double fastest = 0, steepest = 0, farthest = 0, hardest = 0;
    Vector3 last = copter.targets().acceleration;
    run(25, [&] {
        fastest = std::max(fastest, motion().velocity.norm());
        steepest = std::max(steepest, tilt());
        farthest = std::max(farthest, motion().position.x());
        hardest = std::max(hardest, motion().acceleration.head<2>().norm());
        last = copter.targets().acceleration;
    });

    EXPECT_THAT(fastest, AllOf(Ge(4.8), Le(5.3)));
    EXPECT_THAT(hardest, AllOf(Ge(2), Le(4)));
    EXPECT_LT(steepest, to_radians(30));
    EXPECT_LT(farthest, 60.6);
    EXPECT_NEAR(motion().position.x(), 60, 0.1);
    EXPECT_NEAR(motion().position.z(), -20, 0.05);
}

// In level flight the thrust carries the weight, so the tilt alone accelerates: g tan(tilt).
TEST_F(MulticopterTest, AcceleratesByTilting) {
    hover_at({0, 0, -20});
    setpoint.position = {60, 0, -20};
    run(1);

    const double pitch = to_euler(motion().attitude).pitch;
    EXPECT_LT(pitch, to_radians(-5));
    EXPECT_NEAR(motion().acceleration.x(), gravity * std::tan(-pitch), 0.8);
}

TEST_F(MulticopterTest, ClimbsAndDescendsAtTheirLimits) {
    hover_at({0, 0, -20});
    setpoint.limits.up = 3;
    setpoint.limits.down = 1.5;
    double up = 0, down = 0;
    setpoint.position.z() = -50;
    run(15, [&] { up = std::min(up, motion().velocity.z()); });
    setpoint.position.z() = -20;
    run(25, [&] { down = std::max(down, motion().velocity.z()); });

    EXPECT_NEAR(up, -3, 0.2);
    EXPECT_NEAR(down, 1.5, 0.15);
}

TEST_F(MulticopterTest, HoldsItsPlaceInGusts) {
    hover_at({0, 0, -20});
    Random random(1);
    SmoothWander gust(2, 2, step_s);
    run(20, [&] {
        gust.next(random);
        around.wind = {8 + gust.value(), gust.value(), 0};
    });
    double worst = 0;
    run(60, [&] {
        gust.next(random);
        around.wind = {8 + gust.value(), gust.value(), 0};
        worst = std::max(worst, (motion().position - setpoint.position).norm());
    });

    EXPECT_LT(worst, 0.7);
    EXPECT_GT(tilt(), to_radians(3));  // against the wind
}

TEST_F(MulticopterTest, TurnsTheShortWayAtALimitedRate) {
    copter.place({0, 0, 0}, to_radians(170));
    hover_at({0, 0, -20});
    setpoint.yaw = to_radians(-100);
    double fastest = 0;
    run(10, [&] { fastest = std::max(fastest, motion().rates.z()); });

    EXPECT_NEAR(wrap_pi(yaw_of(motion().attitude) - setpoint.yaw), 0, 0.01);
    EXPECT_THAT(fastest, AllOf(Ge(to_radians(50)), Le(to_radians(66))));
}

TEST_F(MulticopterTest, FliesACircleInTheDirectionOfItsSign) {
    for (const double radius : {15.0, -15.0}) {
        setpoint.steering = Steering::circle;
        setpoint.position = {0, 0, -20};
        setpoint.radius = radius;
        run(30);
        double worst = 0;
        run(20, [&] { worst = std::max(worst, std::abs(motion().position.head<2>().norm() - 15)); });
        const auto& p = motion().position;
        const auto& v = motion().velocity;
        // Clockwise seen from above: north turns to east.
        EXPECT_EQ(std::signbit(p.x() * v.y() - p.y() * v.x()), radius < 0);
        EXPECT_LT(worst, 0.6);
        EXPECT_NEAR(v.head<2>().norm(), 5, 0.3);
    }
}

TEST_F(MulticopterTest, LandsSoftlyAndStandsStill) {
    hover_at({3, 2, -4});
    setpoint.position = {3, 2, nan};
    setpoint.velocity = {nan, nan, 0.7};
    setpoint.touch_down = true;
    double touch_down = 0, hardest = 0, lowest = 0;
    run(12, [&] {
        if (touch_down == 0 && copter.touches_ground()) touch_down = motion().velocity.z();
        hardest = std::max(hardest, motion().acceleration.norm());
        lowest = std::max(lowest, motion().position.z());
    });

    EXPECT_THAT(touch_down, AllOf(Ge(0.4), Le(0.8)));
    EXPECT_LT(hardest, 5 * gravity);
    EXPECT_LT(lowest, 0.03);
    EXPECT_EQ(motion().velocity, Vector3::Zero());
    EXPECT_NEAR(copter.thrust(), 0, 1e-6);
}

TEST_F(MulticopterTest, FallsWithoutMotorsAndComesToRest) {
    hover_at({0, 0, -20});
    armed = false;
    run(1.5);
    EXPECT_GT(motion().velocity.z(), 8);
    run(6);
    EXPECT_EQ(motion().velocity, Vector3::Zero());
    EXPECT_NEAR(motion().position.z(), 0, 1e-3);
}

TEST_F(MulticopterTest, AWeakBatteryStillHoversAnEmptyOneDoesNot) {
    hover_at({0, 0, -20});
    around.supply = 0.8;
    run(10);
    EXPECT_NEAR(motion().position.z(), -20, 0.1);
    EXPECT_NEAR(copter.thrust(), 0.5 / 0.8, 0.01);
    around.supply = 0;
    run(10);
    EXPECT_TRUE(copter.touches_ground());
}

// The mixer of PX4's quadrotor in X form: motors front right, rear left, front left, rear right; the first two turn
// counter-clockwise, so that their torque turns the vehicle clockwise.
TEST_F(MulticopterTest, MixesMomentsIntoMotors) {
    hover_at({0, 0, -20});
    setpoint.steering = Steering::actuators;
    const auto outputs = [&](std::array<double, 4> mixer) {
        setpoint.mixer = mixer;
        copter.step(setpoint, true, around);
        const auto& o = copter.outputs();
        return std::array{o[0], o[1], o[2], o[3]};
    };

    const auto right = outputs({0.2, 0, 0, 0.5}), up = outputs({0, 0.2, 0, 0.5}), clockwise = outputs({0, 0, 0.2, 0.5});
    EXPECT_THAT(right, ::testing::ElementsAre(0.4, 0.6, 0.6, 0.4));
    EXPECT_THAT(up, ::testing::ElementsAre(0.6, 0.4, 0.6, 0.4));
    EXPECT_THAT(clockwise, ::testing::ElementsAre(0.6, 0.6, 0.4, 0.4));
}

TEST_F(MulticopterTest, FollowsAttitudeAndRates) {
    hover_at({0, 0, -25});
    setpoint.steering = Steering::attitude;
    setpoint.attitude = to_quaternion({0.2, -0.1, 0.5});
    setpoint.thrust = 0.5;
    run(2);
    EXPECT_LT(motion().attitude.angularDistance(setpoint.attitude), 0.02);

    setpoint.steering = Steering::rates;
    setpoint.rates = {0, 0, 1};
    run(1);
    EXPECT_NEAR(motion().rates.z(), 1, 0.02);
}

// An external controller makes its own ramps.
TEST_F(MulticopterTest, WithoutJerkLimitItFollowsAtOnce) {
    hover_at({0, 0, -20});
    setpoint.position = {nan, nan, -20};
    setpoint.velocity = {4, 0, nan};
    setpoint.limits.jerk = 0;
    run(1.2);
    EXPECT_GT(motion().velocity.x(), 2.8);
    run(4);
    EXPECT_NEAR(motion().velocity.x(), 4, 0.1);
    EXPECT_NEAR(motion().position.z(), -20, 0.1);
}

TEST_F(MulticopterTest, AMovedOriginDoesNotMoveTheVehicle) {
    hover_at({0, 0, -20});
    const Vector3 by{1000, -500, 30};
    copter.move_origin(by);
    around.ground += by.z();
    setpoint.position += by;

    run(5, [&] { ASSERT_LT((motion().position - setpoint.position).norm(), 0.1); });
}

TEST_F(MulticopterTest, AnySetpointLeavesFiniteMotion) {
    Random random(11);
    for (int i = 0; i < 20'000; ++i) {
        setpoint = test::any_setpoint(random);
        if (i % 50 == 0) copter.place({0, 0, -100}, 0);
        run(0.02);
        ASSERT_TRUE(test::is_finite(motion())) << "set-point " << i;
        ASSERT_LT(motion().velocity.norm(), 200) << "set-point " << i;
    }
}

}  // namespace
}  // namespace mavloom::flight
