// SPDX-License-Identifier: MIT
// Faults on purpose: what the autopilot then gets from the sensors, and what the motors do. And several IMUs.
#include <gmock/gmock.h>

#include "unit/hil/support/pair_rig.hpp"

namespace mavloom::hil {
namespace {

using enum flight::FaultPart;
using enum flight::FaultKind;
using test::inertial;
using test::magnetic;
using test::pressure;
using test::Step;
using testing::HasSubstr;

constexpr std::uint32_t force = 0x7, rates = 0x38, pitot = 0x400;  // more bits of HIL_SENSOR.fields_updated
constexpr double metres_a_degree = 111'180;                        // along the meridian of Zurich (WGS 84)

class HilFaults : public test::PairRig {
protected:
    HilFaults() { options.vehicle.has_noise = false; }

    void fail(flight::FaultPart part, flight::FaultKind kind, std::vector<double> numbers = {}) {
        flight::Fault fault{.part = part, .kind = kind, .count = numbers.size()};
        std::ranges::copy(numbers, fault.numbers.begin());
        const auto done = pair->fail(fault);
        EXPECT_TRUE(done) << done.error().text;
    }
    // All bits of a second of flight.
    std::uint32_t updated(std::array<float, 16> controls = {}) {
        std::uint32_t bits = 0;
        for (const Step& step : fly(250, controls)) bits |= step.sensor.fields_updated;
        return bits;
    }
    // The last one of a second of flight.
    std::optional<msg::HilGps> fix() {
        std::optional<msg::HilGps> last;
        for (const Step& step : fly(250))
            if (step.gps) last = step.gps;
        return last;
    }
};

TEST_F(HilFaults, AGpsThatIsOffSendsNothing) {
    begin();
    ASSERT_TRUE(fix());
    fail(gps, off);
    EXPECT_FALSE(fix());
    fail(gps, ok);
    EXPECT_EQ(fix()->fix_type, 3);
}

TEST_F(HilFaults, AGpsThatIsWrongHasNoThreeDimensions) {
    begin();
    const auto before = fix();
    fail(gps, wrong);
    EXPECT_EQ(fix()->fix_type, 2);
    EXPECT_EQ(fix()->lat, before->lat);
}

TEST_F(HilFaults, AGpsThatIsStuckRepeatsItsFix) {
    begin();
    const auto before = fix();
    fail(gps, stuck);
    fly(500, four(0.7f));
    ASSERT_GT(pair->status().height_m, 1);
    EXPECT_EQ(fix()->alt, before->alt);
    EXPECT_EQ(fix()->vd, before->vd);
}

TEST_F(HilFaults, AGpsJumps) {
    begin();
    const auto before = fix();
    fail(gps, jump, {100, -50});
    const auto after = fix();
    EXPECT_NEAR((after->lat - before->lat) / 1e7 * metres_a_degree, 100, 0.1);
    EXPECT_LT(after->lon, before->lon);
    EXPECT_EQ(after->vn, 0);
}

TEST_F(HilFaults, AGpsDriftsInPositionAndVelocity) {
    begin();
    const auto before = fix();
    fail(gps, drift, {2, 0});
    const auto later = fix();
    const auto last = fix();
    EXPECT_NEAR((last->lat - later->lat) / 1e7 * metres_a_degree, 2, 0.05);
    EXPECT_EQ(last->vn, 200);
    fail(gps, ok);
    EXPECT_EQ(fix()->lat, before->lat);
}

TEST_F(HilFaults, ASensorThatIsOffIsAbsentAndTheOthersContinue) {
    begin();
    EXPECT_EQ(updated(), inertial | magnetic | pressure | pitot);
    fail(compass, off);
    EXPECT_EQ(updated(), inertial | pressure | pitot);
    fail(barometer, off);
    EXPECT_EQ(updated(), inertial | pitot);
    fail(airspeed, off);
    EXPECT_EQ(updated(), inertial);
    fail(gyroscope, off);
    EXPECT_EQ(updated(), force);
    fail(accelerometer, off);
    fail(gyroscope, ok);
    EXPECT_EQ(updated(), rates);
    fail(all, ok);
    EXPECT_EQ(updated(), inertial | magnetic | pressure | pitot);
}

TEST_F(HilFaults, ASensorThatIsStuckRepeatsItsValue) {
    options.vehicle.has_noise = true;
    begin();
    fly(250);
    for (const auto part : {compass, barometer, gyroscope, accelerometer}) fail(part, stuck);
    const msg::HilSensor before = step().sensor;
    for (const Step& step : fly(500)) {
        ASSERT_EQ(step.sensor.xmag, before.xmag);
        ASSERT_EQ(step.sensor.abs_pressure, before.abs_pressure);
        ASSERT_EQ(step.sensor.zgyro, before.zgyro);
        ASSERT_EQ(step.sensor.xacc, before.xacc);
    }
}

// With a heading of 90 degrees, north is to the left.
TEST_F(HilFaults, ACompassTurns) {
    begin();
    const msg::HilSensor before = fly(250).back().sensor;
    fail(compass, turn, {90});
    const msg::HilSensor after = fly(250).back().sensor;
    EXPECT_NEAR(after.xmag, before.ymag, 2e-4);
    EXPECT_NEAR(after.ymag, -before.xmag, 2e-4);
    EXPECT_NEAR(after.zmag, before.zmag, 2e-4);
}

TEST_F(HilFaults, ABarometerJumpsAndDrifts) {
    begin();
    const float before = fly(250).back().sensor.pressure_alt;
    fail(barometer, jump, {50});
    EXPECT_NEAR(fly(250).back().sensor.pressure_alt, before + 50, 0.1);
    fail(barometer, drift, {3});
    EXPECT_NEAR(fly(500).back().sensor.pressure_alt, before + 6, 0.1);
}

TEST_F(HilFaults, ARangefinderIsStuckOrOff) {
    options.rates.distance_hz = 50;
    begin();
    fly(500, four(0.7f));
    fail(rangefinder, stuck);
    const auto distances = [&] {
        std::vector<std::uint16_t> all;
        for (const Step& step : fly(250, four(0.7f)))
            if (step.distance) all.push_back(step.distance->current_distance);
        return all;
    };
    const auto stuck_at = distances();
    EXPECT_EQ(stuck_at.size(), 50u);
    EXPECT_THAT(stuck_at, testing::Each(stuck_at.front()));
    fail(rangefinder, ok);
    EXPECT_GT(distances().back(), stuck_at.front() + 100);
    fail(rangefinder, off);
    EXPECT_TRUE(distances().empty());
}

// The first motor is the one at the front, on the right.
TEST_F(HilFaults, AMotorThatIsOffTurnsTheVehicleOver) {
    begin();
    fly(500, four(0.6f));
    fail(motor, off, {1});
    fly(50, four(0.6f));
    EXPECT_GT(pair->status().roll_deg, 3);
    EXPECT_LT(pair->status().pitch_deg, -3);
    fail(motor, off);
    const double before = pair->status().down_m_s;
    fly(125, four(0.6f));
    EXPECT_NEAR(pair->status().down_m_s - before, 9.80665 / 2, 0.5);
}

TEST_F(HilFaults, StayUntilTheyAreEnded) {
    begin();
    fail(gps, off);
    pair->reset();
    pair->end();
    pair->begin(now);
    EXPECT_FALSE(fix());
}

TEST_F(HilFaults, PartsOfPx4AndMotorsThatAreNotThereAreErrors) {
    begin();
    const auto refused = [&](const flight::Fault& fault) { return pair->fail(fault).error().text; };
    EXPECT_THAT(refused({.part = battery, .kind = off}), HasSubstr("the battery is PX4's own"));
    EXPECT_THAT(refused({.part = autopilot, .kind = restart}), HasSubstr("PX4's own"));
    EXPECT_EQ(refused({.part = motor, .kind = off, .numbers = {5}, .count = 1}), "the vehicle has 4 motors");
}

TEST_F(HilFaults, FurtherImusFollowTheFirstWithNoiseOfTheirOwn) {
    options.vehicle.has_noise = true;
    options.rates.imus = 3;
    begin();
    double sum = 0, difference = 0;
    for (const Step& step : fly(2500)) {
        ASSERT_EQ(step.sensor.id_, 0);
        ASSERT_EQ(step.ids[0], msg::HilSensor::id.value);
        ASSERT_EQ(step.further.size(), 2u);
        for (std::uint8_t i = 0; i < 2; ++i) {
            ASSERT_EQ(step.ids[i + 1u], msg::HilSensor::id.value);
            ASSERT_EQ(step.further[i].id_, i + 1);
            ASSERT_EQ(step.further[i].time_usec, step.sensor.time_usec);
            ASSERT_EQ(step.further[i].fields_updated, inertial);
        }
        sum += static_cast<double>(step.further[0].zacc);
        difference += static_cast<double>(std::abs(step.further[0].zacc - step.further[1].zacc));
    }
    EXPECT_NEAR(sum / 2500, -9.80665, 0.02);
    EXPECT_GT(difference / 2500, 0.01);
    EXPECT_EQ(pair->lock_step().counters().answered, 2500u);
}

}  // namespace
}  // namespace mavloom::hil
