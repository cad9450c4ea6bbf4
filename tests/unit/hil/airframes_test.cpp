// SPDX-License-Identifier: MIT
// Planes and rovers with the outputs of PX4's airframes 1030 and 1060. The indices and signs are those of PX4's files
// and of Gazebo classic's models for them: an output MAINn is control n - 1.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "hil/outputs.hpp"
#include "mavloom/msg/command_long.hpp"
#include "unit/hil/support/pair_rig.hpp"

namespace mavloom::hil {
namespace {

using flight::Kind;
using ::testing::ElementsAre;

// ---- the table ------------------------------------------------------------------------------------------------------

flight::Channels channels_of(Kind kind) { return flight::make_plant(kind, {})->channels(); }

// The first four channels of the plant while one control has this value.
std::vector<double> channels_with(Kind kind, std::size_t control, float value) {
    Controls controls{};
    controls[control] = value;
    const auto outputs = read_outputs(controls, kind, channels_of(kind)).outputs;
    return {outputs.begin(), outputs.begin() + 4};
}

TEST(OutputsOfPx4, OfAPlane) {
    // Aileron, elevator, motor, rudder.
    EXPECT_THAT(channels_with(Kind::plane, 6, 1), ElementsAre(0.5, 0, 0, 0));   // right aileron up: rolls right
    EXPECT_THAT(channels_with(Kind::plane, 5, 1), ElementsAre(-0.5, 0, 0, 0));  // left aileron up: rolls left
    EXPECT_THAT(channels_with(Kind::plane, 7, 0.5f), ElementsAre(0, 0.5, 0, 0));
    EXPECT_THAT(channels_with(Kind::plane, 4, 0.5f), ElementsAre(0, 0, 0.5, 0));
    EXPECT_THAT(channels_with(Kind::plane, 2, -0.5f), ElementsAre(0, 0, 0, -0.5));
    for (const std::size_t other : {0, 1, 3, 8, 9, 15})
        EXPECT_THAT(channels_with(Kind::plane, other, 1), ElementsAre(0, 0, 0, 0)) << other;
}

TEST(OutputsOfPx4, OfARover) {
    // Drive, steering.
    EXPECT_THAT(channels_with(Kind::rover, 5, -0.5f), ElementsAre(-0.5, 0, 0, 0));
    EXPECT_THAT(channels_with(Kind::rover, 0, 0.5f), ElementsAre(0, 0.5, 0, 0));
    for (const std::size_t other : {1, 2, 4, 6, 15})
        EXPECT_THAT(channels_with(Kind::rover, other, 1), ElementsAre(0, 0, 0, 0)) << other;
}

TEST(OutputsOfPx4, OfAMulticopterAreItsMotorsInTheirOrder) {
    const Controls controls{0.1f, 0.2f, 0.3f, 0.4f, 0.5f};
    const auto outputs = read_outputs(controls, Kind::quad, channels_of(Kind::quad)).outputs;
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(outputs[i], static_cast<double>(controls[i]));
    EXPECT_EQ(outputs[4], 0);
}

TEST(OutputsOfPx4, AMulticopterOfTwelveMotorsReadsTwelve) {
    flight::Body body;
    set_frame(body.copter, flight::Frame::dodeca_cox, 0.5);
    const auto channels = flight::make_plant(Kind::quad, body)->channels();
    Controls controls;
    for (std::size_t i = 0; i < controls.size(); ++i) controls[i] = 0.05f * static_cast<float>(i + 1);
    const auto outputs = read_outputs(controls, Kind::quad, channels).outputs;
    for (std::size_t i = 0; i < 12; ++i) EXPECT_EQ(outputs[i], static_cast<double>(controls[i]));
    for (std::size_t i = 12; i < 16; ++i) EXPECT_EQ(outputs[i], 0);
}

ReadOutputs read_one(Kind kind, std::size_t control, float value) {
    Controls controls{};
    controls[control] = value;
    return read_outputs(controls, kind, channels_of(kind));
}

TEST(OutputsOfPx4, CountValuesBeyondTheirRangeAsItsLimit) {
    EXPECT_TRUE(read_one(Kind::plane, 4, -0.1f).has_beyond);  // a motor that cannot reverse
    EXPECT_EQ(read_one(Kind::plane, 4, -0.1f).outputs[2], 0);
    EXPECT_FALSE(read_one(Kind::plane, 7, -1).has_beyond);
    EXPECT_TRUE(read_one(Kind::plane, 6, 7).has_beyond);
    EXPECT_EQ(read_one(Kind::plane, 6, 7).outputs[0], 0.5);  // and not 3.5
    EXPECT_FALSE(read_one(Kind::rover, 5, -1).has_beyond);
    EXPECT_TRUE(read_one(Kind::rover, 0, -1.5f).has_beyond);
    EXPECT_FALSE(read_one(Kind::rover, 9, 99).has_beyond);  // which moves nothing
}

TEST(OutputsOfPx4, WithoutANumberAreZero) {
    constexpr auto none = std::numeric_limits<float>::quiet_NaN(), endless = std::numeric_limits<float>::infinity();
    for (const auto value : {none, endless, -endless}) {
        const auto read = read_one(Kind::plane, 5, value);
        EXPECT_TRUE(read.has_no_number && !read.has_beyond);
        EXPECT_EQ(read.outputs[0], 0);
    }
    EXPECT_FALSE(read_one(Kind::plane, 8, none).has_no_number);
}

// ---- what the vehicles do -------------------------------------------------------------------------------------------

class AirframeTest : public test::PairRig {
protected:
    void begin(Kind kind) {
        options.vehicle.kind = kind;
        options.vehicle.has_noise = false;
        PairRig::begin();
        send(msg::CommandLong{.command = 511, .param1 = 115, .param2 = 4000});  // the true state with each step
    }
    // Full power and some elevator, until it is well above the ground.
    void take_off() {
        begin(Kind::plane);
        fly(750, with({{4, 1.0f}}));
        for (int i = 0; i < 5000 && pair->status().height_m < 20; ++i) fly(1, with({{4, 1.0f}, {7, 0.15f}}));
        ASSERT_GE(pair->status().height_m, 20);
    }
    static Controls with(std::initializer_list<std::pair<std::size_t, float>> given) {
        Controls controls{};
        for (const auto& [index, value] : given) controls[index] = value;
        return controls;
    }
};

TEST_F(AirframeTest, OutputsOfAPlaneTurnItAsTheirSignsSay) {
    take_off();
    const auto rates_with = [&](std::initializer_list<std::pair<std::size_t, float>> given) {
        return fly(50, with(given)).back().sensor;
    };
    EXPECT_GT(rates_with({{4, 0.6f}, {6, 0.3f}, {5, -0.3f}}).xgyro, 0.3);  // rolls right
    EXPECT_LT(rates_with({{4, 0.6f}, {6, -0.4f}, {5, 0.4f}}).xgyro, -0.3);
    const float pitch_rate = rates_with({{4, 0.6f}}).ygyro;
    EXPECT_GT(rates_with({{4, 0.6f}, {7, 0.4f}}).ygyro, pitch_rate + 0.1);  // nose up
    const float yaw_rate = rates_with({{4, 0.6f}}).zgyro;
    EXPECT_GT(rates_with({{4, 0.6f}, {2, 0.6f}}).zgyro, yaw_rate + 0.1);  // nose right
}

TEST_F(AirframeTest, TheRudderOfARollingPlaneSteersItsNoseWheel) {
    begin(Kind::plane);
    fly(500, with({{4, 0.5f}}));
    fly(250, with({{4, 0.3f}, {2, 0.3f}}));
    EXPECT_GT(pair->status().heading_deg, 3);
    EXPECT_LT(pair->status().heading_deg, 180);
}

// By the pressures, as PX4 computes it: true airspeed from the difference and the density of the air.
double true_airspeed_of(const msg::HilSensor& sensor) {
    const double density = 100 * static_cast<double>(sensor.abs_pressure) /
                           (287.05 * (static_cast<double>(sensor.temperature) + 273.15));
    return std::sqrt(2 * 100 * static_cast<double>(sensor.diff_pressure) / density);
}

TEST_F(AirframeTest, AirspeedAgreesWithPressuresAndWind) {
    options.vehicle.wind = {.speed_m_s = 6, .direction_deg = 180};  // the air moves south
    options.vehicle.home.altitude_m = 1500;
    take_off();
    const auto steps = fly(50, with({{4, 0.8f}}));
    const auto& truth = steps.back().truth;
    ASSERT_TRUE(truth);
    const double airspeed = truth->true_airspeed / 100.0;
    EXPECT_NEAR(airspeed, std::hypot(truth->vx / 100.0 + 6, truth->vy / 100.0, truth->vz / 100.0), 0.02);
    EXPECT_NEAR(true_airspeed_of(steps.back().sensor), airspeed, 0.03 * airspeed);
    // 1,500 m above the sea, the standard atmosphere has 1.058 kg/m^3.
    EXPECT_NEAR(truth->ind_airspeed / 100.0, airspeed * std::sqrt(1.058 / 1.225), 0.02 * airspeed);
}

TEST_F(AirframeTest, PressureOfTheAirspeedHasItsOwnBit) {
    begin(Kind::plane);
    int samples = 0;
    for (const auto& step : fly(2500)) samples += (step.sensor.fields_updated & 0x400) != 0 ? 1 : 0;
    EXPECT_EQ(samples, 500);
}

TEST_F(AirframeTest, OutputsOfARoverDriveAndSteerItAsTheirSignsSay) {
    begin(Kind::rover);
    fly(500, with({{5, 0.3f}}));
    EXPECT_GT(pair->status().north_m_s, 1);
    fly(125, with({{5, 0.3f}, {0, 0.2f}}));
    EXPECT_GT(pair->status().heading_deg, 10);
    EXPECT_LT(pair->status().heading_deg, 180);
    pair->reset();
    fly(500, with({{5, -0.3f}}));
    EXPECT_LT(pair->status().north_m_s, -1);  // reverse
    EXPECT_TRUE(pair->status().touches_ground);
}

TEST_F(AirframeTest, MoreMassMakesARoverSlower) {
    begin(Kind::rover);
    fly(125, with({{5, 0.5f}}));
    const double light = pair->status().north_m_s;
    pair->reset();
    pair->set_mass(15);  // three times the usual one
    fly(125, with({{5, 0.5f}}));
    // 10 u (1 - exp(-t a / 10)) after half a second, with 15 and 5 m/s^2.
    EXPECT_NEAR(light, 5 * (1 - std::exp(-0.75)), 0.1);
    EXPECT_NEAR(pair->status().north_m_s, 5 * (1 - std::exp(-0.25)), 0.1);
}

TEST_F(AirframeTest, APushMovesAPlaneInTheAirAndARoverAlongItsWheels) {
    take_off();
    const double before = pair->status().east_m_s;
    pair->push({.east_m_s = 5});
    fly(125, with({{4, 0.6f}}));
    EXPECT_GT(pair->status().east_m_s - before, 2);
    begin(Kind::rover);
    pair->push({.north_m_s = 2, .east_m_s = 2});
    fly(25);
    EXPECT_GT(pair->status().north_m_s, 0.1);
    EXPECT_NEAR(pair->status().east_m_s, 0, 1e-6);
}

}  // namespace
}  // namespace mavloom::hil
