// SPDX-License-Identifier: MIT
// Sensors, the estimate, the battery and the wind: magnitudes of PX4's built-in simulator (docs/design/simulator.md).
#include "flight/physics/sensors.hpp"

#include <gmock/gmock.h>

#include <vector>

#include "flight/physics/battery.hpp"
#include "flight/physics/wind.hpp"

namespace mavloom::flight {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;

struct Statistics {
    double sum = 0, squares = 0;
    long count = 0;

    void add(double value) {
        sum += value;
        squares += value * value;
        ++count;
    }
    [[nodiscard]] double mean() const { return sum / static_cast<double>(count); }
    [[nodiscard]] double deviation() const { return std::sqrt(squares / static_cast<double>(count) - mean() * mean()); }
};

constexpr double zurich = 489.4;        // m
const Vector3 field{0.21, 0.01, 0.43};  // gauss, near there

class SensorsTest : public ::testing::Test {
protected:
    void run(double seconds, const std::function<void()>& look = {}) {
        for (long i = std::lround(seconds / step_s); i > 0; --i) {
            sensors.step(truth, air, at_rest, zurich, 1.2);
            if (look) look();
        }
    }

    Sensors sensors{NoiseOptions{}, 7, field};
    Kinematics truth;
    Vector3 air = Vector3::Zero();
    bool at_rest = false;
};

TEST_F(SensorsTest, AccelerometersOfALevelVehicleShowGravityUpwards) {
    Statistics x, z, gyroscope;
    run(60, [&] {
        x.add(sensors.imu().acceleration.x());
        z.add(sensors.imu().acceleration.z());
        gyroscope.add(sensors.imu().rates.y());
    });

    EXPECT_NEAR(z.mean(), -9.80665, 0.01);
    EXPECT_NEAR(x.mean(), 0, 0.01);
    EXPECT_NEAR(z.deviation(), 0.1, 0.01);
    EXPECT_NEAR(gyroscope.deviation(), 0.005, 0.0005);
}

TEST_F(SensorsTest, AccelerometersShowTheSpecificForceInTheBodyFrame) {
    Sensors quiet(std::nullopt, 1, field);
    truth.attitude = to_quaternion({0, 0, pi / 2});
    truth.acceleration = {0, 3, 0};  // east, which is ahead
    quiet.step(truth, air, false, zurich, 1.2);

    EXPECT_LT((quiet.imu().acceleration - Vector3(3, 0, -9.80665)).norm(), 1e-9);
}

TEST_F(SensorsTest, TheMagnetometerTurnsWithTheVehicle) {
    Sensors quiet(std::nullopt, 1, field);
    truth.attitude = to_quaternion({0, 0, pi / 2});
    quiet.step(truth, air, false, zurich, 1.2);

    // Nose to the east: the field's north lies to the left.
    EXPECT_LT((quiet.imu().magnetic - Vector3(0.01, -0.21, 0.43)).norm(), 1e-9);
}

TEST_F(SensorsTest, TheBarometerFollowsTheStandardAtmosphere) {
    Statistics pressure;
    run(60, [&] { pressure.add(sensors.imu().pressure_hpa); });
    EXPECT_NEAR(pressure.mean(), 955.822, 0.003);
    EXPECT_NEAR(pressure.deviation(), 0.01, 0.002);

    Sensors quiet(std::nullopt, 1, field);
    truth.position.z() = -100;
    quiet.step(truth, air, false, zurich, 1.2);
    EXPECT_NEAR(quiet.imu().pressure_altitude, 589.4, 1e-6);
}

TEST_F(SensorsTest, TheEstimateWandersByCentimetresAndItsVelocityAgrees) {
    Statistics position, velocity, roll, yaw, rate;
    Vector3 last = sensors.estimate().position;
    run(2);
    last = sensors.estimate().position;
    run(600, [&] {
        const Estimate& now = sensors.estimate();
        ASSERT_LT((now.position - last - now.velocity * step_s).norm(), 1e-9);
        last = now.position;
        position.add(now.position.x());
        velocity.add(now.velocity.x());
        roll.add(now.euler.roll);
        yaw.add(now.euler.yaw);
        rate.add(now.rates.x());
    });

    EXPECT_THAT(position.deviation(), AllOf(Ge(0.02), Le(0.05)));
    EXPECT_THAT(velocity.deviation(), AllOf(Ge(0.005), Le(0.02)));
    EXPECT_THAT(to_degrees(roll.deviation()), AllOf(Ge(0.1), Le(0.3)));
    EXPECT_THAT(to_degrees(yaw.deviation()), AllOf(Ge(0.2), Le(0.5)));
    EXPECT_NEAR(to_degrees(rate.deviation()), 0.2, 0.05);
}

TEST_F(SensorsTest, AParkedVehiclesEstimateIsNearlyStill) {
    at_rest = true;
    run(60);
    double farthest = 0, fastest = 0;
    run(300, [&] {
        farthest = std::max(farthest, sensors.estimate().position.norm());
        fastest = std::max(fastest, sensors.estimate().velocity.norm());
    });

    EXPECT_LT(farthest, 0.05);
    EXPECT_LT(fastest, 0.015);
}

TEST_F(SensorsTest, GpsSamplesEightTimesASecond) {
    run(1);
    EXPECT_EQ(sensors.gps().fix_type, 1);
    EXPECT_FALSE(sensors.has_position());
    sensors.acquire_gps(true);
    run(1);
    ASSERT_EQ(sensors.gps().fix_type, 3);

    int samples = 0;
    Statistics north, down, speed;
    Vector3 last = sensors.gps().position;
    run(200, [&] {
        if (sensors.gps().position == last) return;
        last = sensors.gps().position;
        ++samples;
        north.add(last.x());
        down.add(last.z());
        speed.add(sensors.gps().velocity.y());
    });
    EXPECT_NEAR(samples / 200.0, 8, 0.1);
    EXPECT_NEAR(north.deviation(), 0.025, 0.005);
    EXPECT_NEAR(down.deviation(), 0.037, 0.007);
    EXPECT_NEAR(speed.deviation(), 0.024, 0.003);
}

TEST_F(SensorsTest, FailuresRemoveTheSensor) {
    sensors.acquire_gps(true);
    run(1);
    const Vector3 magnetic = sensors.imu().magnetic;
    sensors.set_failures({.magnetometer = Failure::off, .gps = Failure::off});
    run(1);
    EXPECT_EQ(sensors.gps().fix_type, 0);
    EXPECT_EQ(sensors.gps().satellites, 0);
    EXPECT_FALSE(sensors.has_position());
    EXPECT_EQ(sensors.imu().magnetic, magnetic);

    sensors.set_failures({});
    run(1);
    EXPECT_EQ(sensors.gps().fix_type, 3);
    EXPECT_NE(sensors.imu().magnetic, magnetic);
}

TEST_F(SensorsTest, NoiseHasThePresetsFigures) {
    Sensors jmavsim(noise_of(NoisePreset::jmavsim), 7, field);
    jmavsim.acquire_gps(true);
    Statistics force, magnetic, pressure, position, velocity;
    for (int i = 0; i < 250 * 120; ++i) {
        jmavsim.step(truth, air, false, zurich, 1.2);
        force.add(jmavsim.imu().acceleration.x());
        magnetic.add(jmavsim.imu().magnetic.z());
        pressure.add(jmavsim.imu().pressure_hpa);
        position.add(jmavsim.gps().position.x());
        velocity.add(jmavsim.gps().velocity.x());
    }
    EXPECT_NEAR(force.deviation(), 0.05, 0.002);
    EXPECT_NEAR(magnetic.deviation(), 0.005, 0.0003);
    EXPECT_NEAR(pressure.deviation(), 0.0115, 0.0008);
    EXPECT_NEAR(position.deviation(), 0.01, 0.002);
    EXPECT_NEAR(velocity.deviation(), 0, 1e-12);
}

TEST_F(SensorsTest, AWrongReceiverKeepsItsPositionAndLosesItsFix) {
    sensors.acquire_gps(true);
    truth.position = {30, 0, 0};
    sensors.set_failures({.gps = Failure::wrong, .wrong_fix = 2});
    run(1);
    EXPECT_EQ(sensors.gps().fix_type, 2);
    EXPECT_NEAR(sensors.gps().position.x(), 30, 0.2);
    EXPECT_FALSE(sensors.has_position());
    sensors.set_failures({.gps = Failure::wrong, .wrong_fix = 6});
    run(1);
    EXPECT_EQ(sensors.gps().fix_type, 6);
    EXPECT_TRUE(sensors.has_position());
}

// 0.5 * 1.2 kg/m^3 * (20 m/s)^2 = 240 Pa. A blocked pitot tube passes 30 %.
TEST_F(SensorsTest, ABlockedPitotTubePassesLessWithinASecond) {
    Sensors exact(std::nullopt, 7, field);
    air = {20, 0, 0};
    const auto fly = [&](double seconds) {
        for (long i = std::lround(seconds / step_s); i > 0; --i) exact.step(truth, air, false, zurich, 1.2);
        return exact.imu().differential_hpa;
    };
    EXPECT_NEAR(fly(1), 2.40, 1e-6);
    exact.set_failures({.airspeed = Failure::wrong});
    EXPECT_NEAR(fly(0.5), 2.40 * 0.65, 0.1);
    EXPECT_NEAR(fly(1), 0.72, 1e-6);
    exact.set_failures({.airspeed = Failure::stuck});
    air = {10, 0, 0};
    EXPECT_NEAR(fly(1), 0.72, 1e-6);
    exact.set_failures({});
    EXPECT_NEAR(fly(1), 0.60, 1e-6);
}

TEST_F(SensorsTest, TheEstimateFollowsADriftAtOnceAndAJumpLater) {
    sensors.acquire_gps(true);
    run(1);
    sensors.set_deceptions({.gps_drift = {0, 2, 0}});
    run(10);
    EXPECT_NEAR(sensors.gps().position.y(), 20, 1);
    EXPECT_NEAR(sensors.gps().velocity.y(), 2, 0.2);
    EXPECT_NEAR(sensors.estimate().position.y(), 19, 0.3) << "half a second behind";
    EXPECT_NEAR(sensors.estimate().velocity.y(), 2, 0.1);
    sensors.set_deceptions({});
    run(6);
    EXPECT_NEAR(sensors.gps().position.y(), 0, 0.2);
    EXPECT_NEAR(sensors.estimate().position.y(), 19, 0.3) << "the jump is rejected";
    run(2);
    EXPECT_NEAR(sensors.estimate().position.y(), 0, 0.2);

    sensors.set_deceptions({.gps_jump = {100, 0, 0}});
    run(6.5);
    EXPECT_NEAR(sensors.gps().position.x(), 100, 0.2);
    EXPECT_NEAR(sensors.estimate().position.x(), 0, 0.2);
    run(1);
    EXPECT_NEAR(sensors.estimate().position.x(), 100, 0.2);
}

// A pressure of 10 m more: 1.17 hPa less at this height, by the standard atmosphere. PX4 counts heights downwards.
TEST_F(SensorsTest, ABarometerThatReadsTooHighLiftsTheEstimate) {
    run(1);
    const double before = sensors.imu().pressure_hpa;
    sensors.set_deceptions({.barometer_offset = 3});
    run(4);
    EXPECT_NEAR(before - sensors.imu().pressure_hpa, 0.34, 0.05);
    EXPECT_NEAR(sensors.estimate().position.z(), -3, 0.2);
}

TEST_F(SensorsTest, ATurnedCompassShowsAnotherHeading) {
    Sensors exact(std::nullopt, 7, {0.2, 0, 0.4});
    exact.set_deceptions({.compass_turn = to_radians(30)});
    exact.step(truth, air, false, zurich, 1.2);
    const Vector3& measured = exact.imu().magnetic;
    EXPECT_NEAR(to_degrees(std::atan2(-measured.y(), measured.x())), 30, 1e-6) << "the heading by a level compass";
    EXPECT_NEAR(measured.norm(), std::hypot(0.2, 0.4), 1e-9);
}

TEST_F(SensorsTest, TheSameSeedGivesTheSameNoise) {
    Sensors same(NoiseOptions{}, 7, field), other(NoiseOptions{}, 8, field);
    for (int i = 0; i < 1000; ++i) {
        sensors.step(truth, air, false, zurich, 1.2);
        same.step(truth, air, false, zurich, 1.2);
        other.step(truth, air, false, zurich, 1.2);
    }
    EXPECT_EQ(same.imu().acceleration, sensors.imu().acceleration);
    EXPECT_EQ(same.estimate().position, sensors.estimate().position);
    EXPECT_NE(other.imu().acceleration, sensors.imu().acceleration);
}

TEST(BatteryTest, ConsumptionIsTheIntegralOfTheCurrent) {
    Battery battery({.capacity_mah = 5000, .cells = 4, .hover_minutes = 20}, true);
    double milliampere_hours = 0, last = battery.remaining();
    for (int i = 0; i < 250 * 600; ++i) {
        battery.step(i % 500 < 250 ? 1 : 1.5, step_s);
        milliampere_hours += battery.current() * step_s / 3.6;
        ASSERT_LT(battery.remaining(), last);
        last = battery.remaining();
    }

    EXPECT_NEAR(battery.used_mah(), milliampere_hours, 0.01);
    EXPECT_NEAR(battery.remaining(), 1 - milliampere_hours / 5000, 1e-6);
}

TEST(BatteryTest, VoltageFallsWithLoadAndCharge) {
    Battery battery({.cells = 4}, true);
    battery.step(0, step_s);
    const double at_rest = battery.voltage();
    battery.step(1, step_s);
    const double loaded = battery.voltage();
    battery.set_remaining(0.2);
    EXPECT_GT(at_rest, loaded + 0.1);
    EXPECT_GT(loaded, battery.voltage() + 1);
    EXPECT_GT(battery.supply(), 0.8);
    battery.set_remaining(0);
    EXPECT_EQ(battery.supply(), 0);
}

TEST(BatteryTest, ChargesUpToWhereItStarted) {
    Battery battery({.start_percent = 60}, true);
    for (int i = 0; i < 250 * 300; ++i) battery.step(1, step_s);
    EXPECT_LT(battery.remaining(), 0.4);
    for (int i = 0; i < 250 * 30; ++i) battery.rest(step_s);
    EXPECT_NEAR(battery.remaining(), 0.6, 1e-9);
    battery.set_remaining(0.1);
    battery.rest(10);
    EXPECT_NEAR(battery.remaining(), 0.1, 1e-9);
}

// As in ArduPilot's simulation, which draws the motors' current only.
TEST(BatteryTest, ArduPilotsKeepsItsChargeAtRest) {
    Battery battery({}, false);
    for (int i = 0; i < 250 * 60; ++i) battery.step(1, step_s);
    const double left = battery.remaining();
    for (int i = 0; i < 250 * 60; ++i) {
        battery.step(0, step_s);
        battery.rest(step_s);
    }
    EXPECT_EQ(battery.remaining(), left);
    EXPECT_EQ(battery.current(), 0);
    battery.replace();
    EXPECT_EQ(battery.remaining(), 1);
}

TEST(WindTest, GustsSpreadAroundTheSteadyWind) {
    WindField wind({.speed_m_s = 8, .direction_deg = 90, .gust_m_s = 2}, 3);
    Statistics north, east, down;
    for (int i = 0; i < 250 * 1200; ++i) {
        wind.step();
        north.add(wind.velocity().x());
        east.add(wind.velocity().y());
        down.add(wind.velocity().z());
    }
    EXPECT_NEAR(east.mean(), 8, 0.6);
    EXPECT_NEAR(north.mean(), 0, 0.6);
    EXPECT_NEAR(east.deviation(), 2, 0.4);
    EXPECT_NEAR(down.deviation(), 2 / 3.0, 0.15);
}

}  // namespace
}  // namespace mavloom::flight
