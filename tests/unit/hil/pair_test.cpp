// SPDX-License-Identifier: MIT
// A vehicle with an autopilot of the test: the messages that PX4 reads, and what becomes of its answers.
#include "mavloom/hil/pair.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/hil_gps.hpp"
#include "mavloom/msg/hil_sensor.hpp"
#include "mavloom/msg/hil_state_quaternion.hpp"
#include "unit/hil/support/pair_rig.hpp"

namespace mavloom::hil {
namespace {

using namespace std::chrono_literals;
using test::inertial;
using test::magnetic;
using test::pressure;
using test::Step;
using ::testing::Each;
using ::testing::Ge;
using ::testing::SizeIs;

class PairTest : public test::PairRig {
public:
    // Lets a vehicle without noise and drag rise. Returns its speed northwards, m/s.
    double rise_without_drag() {
        options.vehicle.has_noise = false;
        options.vehicle.body.copter.drag = 0;
        begin();
        fly(500, four(0.6f));
        return pair->status().north_m_s;
    }
};

TEST_F(PairTest, EachGroupOfSensorsHasItsOwnRateAndAllBits) {
    begin();
    std::map<std::uint32_t, int> updated;
    int fixes = 0;
    for (const Step& step : fly(2500)) {  // 10 s
        ASSERT_EQ(step.ids.front(), msg::HilSensor::id.value);
        ASSERT_EQ(step.sensor.id_, 0);
        for (const auto group : {inertial, magnetic, pressure}) {
            const auto bits = step.sensor.fields_updated & group;
            ASSERT_TRUE(bits == 0 || bits == group);
            updated[group] += bits == group ? 1 : 0;
        }
        ASSERT_EQ(step.sensor.fields_updated & 0x8000'0000, 0u);
        fixes += step.gps ? 1 : 0;
    }
    EXPECT_EQ(updated[inertial], 2500);
    EXPECT_EQ(updated[magnetic], 500);
    EXPECT_EQ(updated[pressure], 500);
    EXPECT_EQ(fixes, 100);
}

// 125 / 50 is not a whole number of steps, and neither is 125 / 10.
TEST_F(PairTest, RatesAreExactAlsoBetweenSteps) {
    options.rates.imu_hz = 125;
    begin();
    int magnetometer = 0, barometer = 0, fixes = 0;
    for (const Step& step : fly(1250)) {
        magnetometer += (step.sensor.fields_updated & magnetic) != 0 ? 1 : 0;
        barometer += (step.sensor.fields_updated & pressure) != 0 ? 1 : 0;
        fixes += step.gps ? 1 : 0;
    }
    EXPECT_EQ(magnetometer, 500);
    EXPECT_EQ(barometer, 500);
    EXPECT_EQ(fixes, 100);
}

TEST_F(PairTest, AnInfiniteMotionPutsTheVehicleBackAtItsStart) {
    begin();
    fly(250, {0.8f, 0.8f, 0.8f, 0.8f});
    ASSERT_GT(pair->status().height_m, 1);
    pair->push({.down_m_s = -std::numeric_limits<double>::max()});
    for (const Step& step : fly(250)) ASSERT_TRUE(std::isfinite(step.sensor.xacc) && std::isfinite(step.sensor.xgyro));
    EXPECT_GT(pair->counters().not_finite, 0u);
    EXPECT_EQ(pair->status().height_m, 0);
}

TEST_F(PairTest, AResetEndsAPush) {
    begin();
    fly(250, four(0.6f));
    pair->push({.north_m_s = std::numeric_limits<double>::max()});  // an infinite acceleration
    pair->reset();
    pair->push({.north_m_s = 3});
    fly(10, four(0.6f));
    EXPECT_EQ(pair->counters().not_finite, 0u);
}

// Rates grow over many steps before they are infinite, and the messages have 32-bit numbers.
TEST_F(PairTest, AMotionThatGrowsWithoutLimitGivesNoInfiniteMessages) {
    options.vehicle.kind = flight::Kind::plane;
    begin();
    pair->set_mass(0.05);
    pair->set_wind({.speed_m_s = 60, .gust_m_s = 60});
    std::mt19937 random(1);
    std::uniform_real_distribution<float> output(-1, 1);
    for (int i = 0; i < 5000; ++i) {
        if (i % 250 == 0) pair->push({100, 100, -100, 2000, 2000, 2000});
        std::array<float, 16> controls{};
        for (float& control : controls) control = output(random);
        for (const Step& step : fly(1, controls)) {
            const msg::HilSensor& s = step.sensor;
            for (const float value : {s.xacc, s.yacc, s.zacc, s.xgyro, s.ygyro, s.zgyro, s.diff_pressure})
                ASSERT_TRUE(std::isfinite(value)) << i;
        }
    }
    EXPECT_GT(pair->counters().not_finite, 0u);
}

TEST_F(PairTest, TimesAreThoseOfTheStepsAndGpsHasUtc) {
    begin();
    const auto steps = fly(250);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        EXPECT_EQ(steps[i].sensor.time_usec, 4000 * (i + 1));
        if (steps[i].gps) {
            EXPECT_EQ(steps[i].gps->time_usec, 1'790'000'000'000'000 + 4000 * (i + 1));
        }
    }
}

TEST_F(PairTest, SpeaksAsComponent51OfTheAutopilotsSystem) {
    options.vehicle.system = SystemId{3};
    begin();
    EXPECT_THAT(step().sources, Each(Source{SystemId{3}, ComponentId{51}}));
    EXPECT_EQ(pair->status().system, SystemId{3});
    send(msg::Heartbeat{.autopilot = 12, .mavlink_version = 3});
    EXPECT_THAT(step().sources, Each(Source{SystemId{7}, ComponentId{51}}));
    EXPECT_EQ(pair->status().system, SystemId{7});
}

TEST_F(PairTest, NumbersItsFramesInSequence) {
    begin();
    std::uint8_t next = 0;
    for (const Step& step : fly(300))
        for (const auto sequence : step.sequence) ASSERT_EQ(sequence, next++);
}

TEST_F(PairTest, AtRestItMeasuresGravityTheFieldAndThePressureOfItsPlace) {
    options.vehicle.has_noise = false;
    begin();
    const Step last = fly(250).back();
    EXPECT_FLOAT_EQ(last.sensor.zacc, -9.80665f);
    EXPECT_FLOAT_EQ(last.sensor.xacc, 0);
    EXPECT_FLOAT_EQ(last.sensor.xgyro, 0);
    EXPECT_NEAR(last.sensor.abs_pressure, 955.82, 0.01);  // ISO 2533 at 489.4 m
    // PX4's model of 2020: 0.482 gauss, inclination 63.16 degrees.
    const double field = std::hypot(last.sensor.xmag, last.sensor.ymag, last.sensor.zmag);
    EXPECT_NEAR(field, 0.482, 0.01);
    EXPECT_NEAR(std::asin(last.sensor.zmag / field) * 180 / 3.14159265, 63.16, 1);
}

// PX4 declares a sensor stale after 100 equal values.
TEST_F(PairTest, WithoutNoiseCompassAndBarometerStillChange) {
    options.vehicle.has_noise = false;
    begin();
    std::vector<float> field, pressures;
    for (const Step& step : fly(500)) {
        if ((step.sensor.fields_updated & magnetic) != 0) field.push_back(step.sensor.xmag);
        if ((step.sensor.fields_updated & pressure) != 0) pressures.push_back(step.sensor.abs_pressure);
    }
    ASSERT_THAT(field, SizeIs(Ge(90u)));
    for (std::size_t i = 1; i < field.size(); ++i) EXPECT_NE(field[i], field[i - 1]);
    for (std::size_t i = 1; i < pressures.size(); ++i) EXPECT_NE(pressures[i], pressures[i - 1]);
}

TEST_F(PairTest, SendsTheTrueStateAsOftenAsAsked) {
    begin();
    for (const Step& step : fly(50)) EXPECT_FALSE(step.truth);
    const auto ask = [&](float message, float interval) {
        return send(msg::CommandLong{.command = 511, .param1 = message, .param2 = interval});
    };
    EXPECT_EQ(ask(115, 5000), Heard::request);
    EXPECT_EQ(ask(30, 1000), Heard::nothing);
    int count = 0;
    for (const Step& step : fly(2500)) count += step.truth ? 1 : 0;
    EXPECT_NEAR(count, 2000, 1);
    ask(115, std::numeric_limits<float>::quiet_NaN());
    for (const Step& step : fly(50)) EXPECT_FALSE(step.truth);
    ask(115, 1);
    for (const Step& step : fly(50)) EXPECT_TRUE(step.truth);
    ask(115, -1);
    for (const Step& step : fly(50)) EXPECT_FALSE(step.truth);
}

TEST_F(PairTest, MotorsLiftItAndAllSensorsAgree) {
    options.vehicle.has_noise = false;
    options.rates.distance_hz = 250;
    begin();
    send(msg::CommandLong{.command = 511, .param1 = 115, .param2 = 1});
    fly(250);
    const Step last = fly(500, four(0.6f)).back();

    const double height = -489.4 + last.truth->alt / 1e3;
    EXPECT_GT(height, 1);
    EXPECT_NEAR(pair->status().height_m, height, 0.01);
    EXPECT_NEAR(last.distance->current_distance, height * 100, 1);
    EXPECT_EQ(last.distance->orientation, 25);
    EXPECT_NEAR(last.sensor.pressure_alt, last.truth->alt / 1e3, 0.2);
    EXPECT_LT(last.truth->vz, -100);
    EXPECT_LT(last.sensor.zacc, -9.80665f);
    EXPECT_TRUE(pair->status().is_armed);
}

TEST_F(PairTest, ALateGpsReportsWhereTheVehicleWas) {
    options.rates.gps_delay = 200ms;
    options.vehicle.has_noise = false;
    begin();
    std::vector<Step> steps = fly(250);
    std::uint64_t fixes = 0;
    for (const Step& step : steps) {
        if (!step.gps) continue;
        ++fixes;
        EXPECT_EQ(step.gps->time_usec + 200'000, 1'790'000'000'000'000 + step.sensor.time_usec);
    }
    EXPECT_EQ(fixes, 8u);
}

TEST_F(PairTest, ControlsBeyondTheirRangeAreClampedAndCounted) {
    begin();
    fly(250, four(0.5f));
    EXPECT_EQ(pair->counters().clamped, 0u);
    fly(1, {1.5f, 0.5f, 0.5f, 0.5f});
    fly(1, {0.5f, -0.1f, 0.5f, 0.5f});
    EXPECT_EQ(pair->counters().clamped, 2u);
    fly(1, {0, 0, 0, 0, 9, -9});  // nothing is connected there
    EXPECT_EQ(pair->counters().clamped, 2u);
}

TEST_F(PairTest, ControlsThatAreNoNumbersStopTheMotorAndAreCounted) {
    begin();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    for (const Step& step : fly(250, {nan, infinite, -infinite, nan})) {
        ASSERT_TRUE(std::isfinite(step.sensor.xacc));
        ASSERT_TRUE(std::isfinite(step.sensor.zgyro));
    }
    EXPECT_EQ(pair->counters().not_numbers, 250u);
    EXPECT_TRUE(pair->status().touches_ground);
}

TEST_F(PairTest, ANewAutopilotFindsTheVehicleAtItsStartAndALaterClock) {
    begin();
    fly(750, four(0.7f));
    ASSERT_GT(pair->status().height_m, 1);
    const auto before = pair->status().time;
    pair->end();
    EXPECT_EQ(pair->status().state, State::waiting);
    EXPECT_EQ(pair->status().height_m, 0);
    EXPECT_FALSE(pair->status().is_armed);

    pair->begin(now);
    const auto steps = fly(250);
    EXPECT_GT(steps.front().sensor.time_usec, wire_time(before));
    EXPECT_NEAR(pair->status().height_m, 0, 0.01);
    EXPECT_EQ(pair->counters().restarts, 1u);
}

TEST_F(PairTest, PeersThatAreNoAutopilotAreNoRestarts) {
    begin();
    fly(10);
    pair->end();
    pair->begin(now);
    EXPECT_EQ(send(msg::Heartbeat{.type = 6, .autopilot = 8}), Heard::stranger);
    pair->end();
    EXPECT_EQ(pair->counters().restarts, 0u);
}

TEST_F(PairTest, KnowsAutopilotsFromStrangers) {
    begin();
    EXPECT_EQ(send(msg::Heartbeat{.type = 6, .autopilot = 8}), Heard::stranger);
    EXPECT_EQ(send(msg::Heartbeat{.type = 2, .autopilot = 3}), Heard::stranger);
    EXPECT_FALSE(pair->is_known());
    EXPECT_EQ(send(msg::Heartbeat{.type = 0, .autopilot = 12}), Heard::autopilot);
    EXPECT_TRUE(pair->is_known());
}

TEST_F(PairTest, ABoardGetsHeartbeatsAndNoTrueState) {
    options.has_own_clock = true;
    options.speed = 1;
    begin();
    send(msg::CommandLong{.command = 511, .param1 = 115, .param2 = 1});
    int heartbeats = 0;
    for (int i = 0; i < 1000; ++i) {
        const Step now_sent = step();
        heartbeats += static_cast<int>(std::ranges::count(now_sent.ids, msg::Heartbeat::id.value));
        EXPECT_FALSE(now_sent.truth);
    }
    EXPECT_EQ(heartbeats, 5);  // within 4 s, the first one at once
}

TEST_F(PairTest, APushMovesItByItsVelocity) {
    const double before = rise_without_drag();
    pair->push({.north_m_s = 3});
    fly(125, four(0.5f));
    EXPECT_NEAR(pair->status().north_m_s - before, 3, 0.05);
    fly(125, four(0.5f));
    EXPECT_NEAR(pair->status().north_m_s - before, 3, 0.05);
    pair->push({.yaw_deg_s = 90});
    const Step last = fly(126, four(0.5f)).back();
    EXPECT_NEAR(last.sensor.zgyro * 180 / 3.14159265, 90, 1);
}

TEST_F(PairTest, APushThatFollowsAnotherAddsToIt) {
    const double before = rise_without_drag();
    pair->push({.north_m_s = 3});
    fly(50, four(0.5f));
    pair->push({.yaw_deg_s = 90});
    const Step last = fly(125, four(0.5f)).back();
    EXPECT_NEAR(pair->status().north_m_s - before, 3, 0.05);
    EXPECT_NEAR(last.sensor.zgyro * 180 / 3.14159265, 90, 1);
}

TEST_F(PairTest, APushIsWholeWithStepsThatDoNotDivideItsTime) {
    options.vehicle.has_noise = false;
    options.vehicle.body.copter.drag = 0;
    options.rates.imu_hz = 125;
    begin();
    fly(250, four(0.6f));
    const double before = pair->status().north_m_s;
    pair->push({.north_m_s = 50});
    fly(125, four(0.5f));
    EXPECT_NEAR(pair->status().north_m_s - before, 50, 0.1);
}

TEST_F(PairTest, APushUpwardsLiftsAVehicleThatStands) {
    for (const auto kind : {flight::Kind::quad, flight::Kind::plane}) {
        options.vehicle.kind = kind;
        begin();
        fly(250);
        pair->push({.north_m_s = 3});
        fly(250);
        EXPECT_NEAR(pair->status().north_m_s, 0, 0.01);  // its legs and brakes hold it
        pair->push({.down_m_s = -10});
        fly(125);
        EXPECT_GT(pair->status().height_m, 0.5);
    }
}

TEST_F(PairTest, MoreMassNeedsMoreThrust) {
    options.vehicle.has_noise = false;
    begin();
    fly(250, four(0.6f));
    pair->set_mass(3);
    fly(500, four(0.6f));
    EXPECT_NEAR(pair->status().height_m, 0, 0.05);
}

TEST_F(PairTest, AStepOfOneMillisecondFliesTheSame) {
    options.vehicle.has_noise = false;
    begin();
    fly(250);
    fly(500, four(0.6f));
    const double height = pair->status().height_m;
    options.rates.imu_hz = 1000;
    begin();
    fly(1000);
    const auto steps = fly(2000, four(0.6f));
    EXPECT_EQ(steps[1].sensor.time_usec - steps[0].sensor.time_usec, 1000u);
    EXPECT_NEAR(pair->status().height_m, height, 0.02 * height);
}

}  // namespace
}  // namespace mavloom::hil
