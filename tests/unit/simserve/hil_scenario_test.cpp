// SPDX-License-Identifier: MIT
// Scenarios whose vehicles are flown by a PX4 outside: values, PX4's own variables, and what is refused.
#include <gmock/gmock.h>

#include "mavloom/simserve/scenario.hpp"

namespace mavloom::simserve {
namespace {

using namespace std::chrono_literals;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

SetupResult<Scenario> scenario_of(std::string_view text, const config::Environment& px4 = {},
                                  std::vector<Override> overrides = {}) {
    const auto document = config::parse_document(text, "x.toml");
    EXPECT_TRUE(document) << document.error().text;
    auto scenario = read_scenario(*document, {}, overrides);
    if (!scenario) return scenario;
    if (auto done = complete_hil(*scenario, *document, px4); !done) return tl::unexpected(done.error());
    return scenario;
}

std::string error_in(std::string_view text, const config::Environment& px4 = {}, std::vector<Override> overrides = {}) {
    const auto scenario = scenario_of(text, px4, std::move(overrides));
    return scenario ? "no error" : scenario.error().text;
}

TEST(HilScenario, EachVehicleHasThePortAfterTheOneBefore) {
    const auto sut = scenario_of("[sim]\nhil = \"px4\"\n[[vehicle]]\ncount = 3\n[[vehicle]]\n");
    ASSERT_TRUE(sut) << sut.error().text;
    const auto endpoints = sut->hil_endpoints();
    ASSERT_EQ(endpoints.size(), 4u);
    for (std::size_t i = 0; i < endpoints.size(); ++i)
        EXPECT_EQ(endpoints[i].label(), "tcpin://127.0.0.1:" + std::to_string(4560 + i));
}

TEST(HilScenario, VehiclesAreOfAnyKind) {
    for (const auto* const kind : {"quad", "plane", "rover"})
        EXPECT_EQ(error_in("[sim]\nhil = \"px4\"\n[[vehicle]]\nkind = \"" + std::string(kind) + "\"\n"), "no error");
}

TEST(HilScenario, SensorsHaveRatesAndKeepTheUsualOnes) {
    const auto sut = scenario_of("[sim]\nhil = \"px4\"\nhil_sensors = \"imu:125,gps_delay:0.2,distance:20\"\n");
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut->hil_rates.step(), 8ms);
    EXPECT_EQ(sut->hil_rates.magnetometer_hz, 50);
    EXPECT_EQ(sut->hil_rates.gps_delay, 200ms);
    EXPECT_EQ(sut->hil_rates.distance_hz, 20);
}

TEST(HilScenario, Px4sVariablesCountUnlessTheScenarioSetsThem) {
    const config::Environment px4{
        {"PX4_HOME_LAT", "-35.36"}, {"PX4_HOME_LON", "149.16"}, {"PX4_HOME_ALT", "584"}, {"PX4_SIM_SPEED_FACTOR", "5"}};
    const auto sut = scenario_of("[sim]\nhil = \"px4\"\n", px4);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut->speed, 5);
    EXPECT_NEAR(sut->each_vehicle()[0].options.home.latitude_deg, -35.36, 1e-9);
    EXPECT_NEAR(sut->each_vehicle()[0].options.home.longitude_deg, 149.16, 1e-9);
    EXPECT_EQ(sut->each_vehicle()[0].options.home.altitude_m, 584);

    const auto own = scenario_of("[sim]\nhil = \"px4\"\nspeed = 2\n[[vehicle]]\nhome = \"10,20,30\"\n", px4);
    ASSERT_TRUE(own) << own.error().text;
    EXPECT_EQ(own->speed, 2);
    EXPECT_NEAR(own->each_vehicle()[0].options.home.latitude_deg, 10, 1e-9);

    EXPECT_EQ(scenario_of("[sim]\n", px4)->speed, 1);
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\n", {{"PX4_HOME_LAT", "north"}}), HasSubstr("PX4_HOME_LAT"));
}

// PX4's airframe 1030 limits the motor to 0.6 of its output and climbs at 8 m/s.
TEST(HilScenario, APlaneHasTheMotorThatPx4sAirframeExpects) {
    const auto plane = [](std::string_view text) { return scenario_of(text)->vehicles[0].options.body.plane; };
    EXPECT_NEAR(plane("[sim]\nhil = \"px4\"\n[[vehicle]]\nkind = \"plane\"\n").thrust_n, 104.7, 0.1);
    EXPECT_EQ(plane("[sim]\nhil = \"px4\"\n[[vehicle]]\nkind = \"plane\"\nbody = \"standard\"\n").thrust_n, 12);
    EXPECT_EQ(plane("[[vehicle]]\nkind = \"plane\"\n").thrust_n, 12);
}

TEST(HilScenario, SensorsComeNoMoreOftenThanPx4IntegratesThem) {
    constexpr std::string_view fast = "[sim]\nhil = \"px4\"\nhil_sensors = \"imu:500\"\n";
    EXPECT_THAT(error_in(fast), HasSubstr("PX4_PARAM_IMU_INTEG_RATE=500"));
    EXPECT_EQ(error_in(fast, {{"PX4_PARAM_IMU_INTEG_RATE", "500"}}), "no error");
    EXPECT_NE(error_in(fast, {{"PX4_PARAM_IMU_INTEG_RATE", "400"}}), "no error");
}

TEST(HilScenario, RefusesAutopilotsEndpointsAndRatesThatCannotBe) {
    EXPECT_THAT(error_in("[sim]\nhil = \"px5\"\n"), HasSubstr("did you mean 'px4'?"));
    EXPECT_THAT(error_in("[sim]\nhil = \"ardupilot\"\n"), HasSubstr("is not px4 or px4=ENDPOINT"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4=wsin://127.0.0.1:4560\"\n"), HasSubstr("tcpin://"));
    for (const auto* const scheme : {"udpin", "udpout", "tcpout"})
        EXPECT_THAT(error_in("[sim]\nhil = \"px4=" + std::string(scheme) + "://127.0.0.1:4560\"\n"),
                    HasSubstr("PX4 connects to a tcpin:// address"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4=tcpin://127.0.0.1:65534\"\n[[vehicle]]\ncount = 3\n"),
                HasSubstr("there are not 3 ports"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\nhil_sensors = \"imu:300\"\n"), HasSubstr("whole microseconds"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\nhil_sensors = \"imu:100,mag:200\"\n"), HasSubstr("imu:100"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\nhil_sensors = \"magnet:50\"\n"), HasSubstr("mag"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\nhil_sensors = \"imus:4\"\n"), HasSubstr("imus: 4 is not from 1 to 3"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\nhil_sensors = \"imus:2.5\"\n"), HasSubstr("not a whole number"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\nhil_sensors = \"gps:\"\n"), EndsWith("gps: '' is not a number"));
    EXPECT_THAT(error_in("[sim]\nhil_sensors = \"imu:100\"\n"), HasSubstr("it is for hil"));
}

TEST(HilScenario, AFlightControllerFliesOneVehicleInRealTime) {
    constexpr std::string_view board = "[sim]\nhil = \"px4=serial:///dev/ttyACM0\"\n";
    EXPECT_EQ(error_in(board), "no error");
    EXPECT_THAT(error_in(board, {}, {{"--speed", "sim", "speed", "max"}}), HasSubstr("flies in real time"));
    EXPECT_THAT(error_in(board, {{"PX4_SIM_SPEED_FACTOR", "2"}}), HasSubstr("PX4_SIM_SPEED_FACTOR"));
    EXPECT_THAT(error_in(board, {}, {{"--vehicles", "vehicle", "count", "2"}}), HasSubstr("one vehicle, not 2"));
}

TEST(HilScenario, EachVehicleHasItsFaultsByTheirTimes) {
    const auto scenario = scenario_of(
        "[sim]\nhil = \"px4\"\nspeed = \"max\"\nfor = \"1s\"\n[[vehicle]]\ncount = 2\n"
        "[[event]]\nat = \"9s\"\ndo = \"fail gps off\"\n"
        "[[event]]\nat = \"5s\"\ndo = \"fail motor off 2\"\nsystem = 2\n");
    ASSERT_TRUE(scenario) << scenario.error().text;
    ASSERT_EQ(scenario->hil_faults(SystemId{1}).size(), 1u);
    EXPECT_EQ(scenario->hil_faults(SystemId{1})[0].at, std::chrono::seconds{9});
    const auto second = scenario->hil_faults(SystemId{2});
    ASSERT_EQ(second.size(), 2u);
    EXPECT_EQ(second[0].at, std::chrono::seconds{5});
    EXPECT_EQ(second[0].fault.part, flight::FaultPart::motor);
    EXPECT_EQ(second[0].fault.numbers[0], 2);
    EXPECT_EQ(second[1].fault.part, flight::FaultPart::gps);
}

TEST(HilScenario, RefusesWhatPx4DoesItselfAtItsPlace) {
    const auto refused = [](std::string_view more) {
        return error_in(std::string("[sim]\nhil = \"px4\"\n") + std::string(more));
    };
    EXPECT_THAT(refused("ring = \"a\"\n"), StartsWith("x.toml:3: ring: not with hil"));
    EXPECT_THAT(refused("record = \"a.tlog\"\n"), StartsWith("x.toml:3: record: not with hil"));
    EXPECT_THAT(refused("[[vehicle]]\nautopilot = \"ardupilot\"\n"), StartsWith("x.toml:4: autopilot: not with hil"));
    EXPECT_EQ(refused("[[vehicle]]\nautopilot = \"px4\"\nbody = \"iris\"\nnoise = false\n"), "no error");
    EXPECT_THAT(refused("[[vehicle]]\ntraffic = 3\n"), StartsWith("x.toml:4: traffic: not with hil"));
    EXPECT_THAT(refused("[[event]]\nat = \"5s\"\ndo = \"arm\"\n"),
                StartsWith("x.toml:5: do: with hil, only fail PART FAULT: PX4 flies"));
    EXPECT_THAT(refused("[[event]]\nat = \"5s\"\ndo = \"fail battery off\"\n"),
                StartsWith("x.toml:5: do: not with hil: PX4 has its own"));
    EXPECT_THAT(refused("[[endpoint]]\nurl = \"udpout://127.0.0.1:9\"\n"), StartsWith("x.toml:3: no [endpoint]"));
    EXPECT_THAT(error_in("[sim]\nhil = \"px4\"\n", {}, {{"--traffic", "vehicle", "traffic", "2"}}),
                StartsWith("--traffic: not with hil"));
}

}  // namespace
}  // namespace mavloom::simserve
