// SPDX-License-Identifier: MIT
// Scenarios as values: places, ids, seeds, precedence. tests/system/program/test_sim.py has the errors.
#include "mavloom/simserve/scenario.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <tuple>

#include "simserve/scenario/body.hpp"
#include "simserve/scenario/noise.hpp"
#include "simserve/scenario/values.hpp"

namespace mavloom::simserve {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

Scenario read(std::string_view text, const config::Environment& environment = {}, std::vector<Override> overrides = {}) {
    const auto document = config::parse_document(text, "x.toml");
    EXPECT_TRUE(document) << document.error().text;
    auto scenario = read_scenario(*document, environment, overrides);
    EXPECT_TRUE(scenario) << scenario.error().text;
    return scenario ? std::move(*scenario) : Scenario{};
}

TEST(Scenario, WithoutAFileIsOneQuadOfPx4) {
    const auto sut = read("");

    ASSERT_EQ(sut.vehicles.size(), 1u);
    const auto& o = sut.vehicles[0].options;
    EXPECT_EQ(o.kind, sim::Kind::quad);
    EXPECT_EQ(o.autopilot, sim::Autopilot::px4);
    EXPECT_EQ(o.system, SystemId{1});
    EXPECT_DOUBLE_EQ(o.home.latitude_deg, 47.397742);
    EXPECT_EQ(o.ready_after, 2500ms);
    EXPECT_EQ(sut.control_name(), "sim");
}

TEST(Scenario, OptionsComeBeforeTheEnvironmentAndThatBeforeTheFile) {
    const std::string_view file = "[sim]\nseed = 1\nspeed = 2\nfor = \"3s\"\n[[vehicle]]\nkind = \"plane\"\n";
    const auto sut = read(file, {{"MAVLOOM_SIM_SPEED", "4"}, {"MAVLOOM_SIM_FOR", "5s"}},
                          {{"--for", "sim", "for", "6s"}, {"--vehicle", "vehicle", "kind", "rover"}});

    EXPECT_EQ(sut.seed, 1u);
    EXPECT_EQ(sut.speed, 4);
    EXPECT_EQ(sut.duration, 6s);
    EXPECT_EQ(sut.vehicles[0].options.kind, sim::Kind::rover);
}

TEST(Scenario, SetsTheNoiseByNameAndFigure) {
    const auto noise_in = [](std::string_view text) {
        return read(fmt::format("[[vehicle]]\nnoise = {}\n", text)).vehicles[0].options;
    };
    EXPECT_TRUE(noise_in("true").has_noise);
    EXPECT_FALSE(noise_in("false").has_noise);
    EXPECT_EQ(noise_in("\"jmavsim\"").noise.accelerometer, 0.05);
    const auto own = noise_in("{preset = \"gazebo\", gps = 1.5}");
    EXPECT_TRUE(own.has_noise);
    EXPECT_EQ(own.noise.gps, 1.5);
    EXPECT_EQ(own.noise.gps_down, 0.006);
    sim::VehicleOptions options;
    EXPECT_THAT(set_noise("gazeb", options).error().text, HasSubstr("did you mean 'gazebo'"));
    EXPECT_THAT(set_noise("preset:sih,gsp:1", options).error().text, HasSubstr("did you mean 'gps'"));
    EXPECT_THAT(set_noise("gps:-1", options).error().text, HasSubstr("gps"));
}

// `mavloom check` passed it, and the simulator did not start.
TEST(Scenario, ServesMetricsAtANumericAddress) {
    const auto document = config::parse_document("[sim]\nmetrics = \"localhost:9090\"\n", "x.toml");
    ASSERT_TRUE(document) << document.error().text;
    const auto refused = read_scenario(*document, {}, {});
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().text, HasSubstr("'localhost' is not a numeric address of this machine; for example, "
                                                "type 127.0.0.1:9090"));
    EXPECT_EQ(read("[sim]\nmetrics = \"[::1]:0\"\n").metrics->host, "::1");
}

TEST(Scenario, HomeNeedsOnlyAPlace) {
    const auto home_of = [](std::string_view text) {
        return read(fmt::format("[[vehicle]]\nhome = \"{}\"\n", text)).vehicles[0].options.home;
    };
    const auto place = home_of("47, -8.5"), high = home_of("47,-8.5, 600");
    EXPECT_EQ(std::tuple(place.latitude_deg, place.longitude_deg, place.altitude_m, place.heading_deg),
              std::tuple(47.0, -8.5, 489.4, 0.0));
    EXPECT_EQ(std::tuple(high.altitude_m, high.heading_deg), std::tuple(600.0, 0.0));
}

TEST(Scenario, IdsCountUpAcrossVehicles) {
    const auto sut = read("[[vehicle]]\ncount = 2\n[[vehicle]]\nsystem = 40\n[[vehicle]]\n");
    std::vector<int> systems;
    for (const auto& vehicle : sut.each_vehicle()) systems.push_back(vehicle.options.system.value);

    EXPECT_THAT(systems, ElementsAre(1, 2, 40, 41));
}

// The grid is of 5 m, north and east of home, and vehicles without a home of their own share one.
TEST(Scenario, VehiclesStandApart) {
    const auto sut = read("[[vehicle]]\ncount = 3\n[[vehicle]]\n[[vehicle]]\nhome = [60, 10, 5, 0]\ncount = 2\n");
    const auto all = sut.each_vehicle();
    ASSERT_EQ(all.size(), 6u);
    const auto metres = [&](std::size_t a, std::size_t b) {
        const auto &p = all[a].options.home, &q = all[b].options.home;
        constexpr double degree_m = 6'371'000 * 3.14159265358979 / 180;
        const double north = (p.latitude_deg - q.latitude_deg) * degree_m;
        const double east = (p.longitude_deg - q.longitude_deg) * degree_m * std::cos(p.latitude_deg / 57.29577951);
        return std::hypot(north, east);
    };

    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < a; ++b) EXPECT_GE(metres(a, b), 4.97) << a << " " << b;
    EXPECT_NEAR(metres(0, 1), 5, 0.03);
    EXPECT_NEAR(metres(4, 5), 5, 0.03);
    EXPECT_DOUBLE_EQ(all[4].options.home.latitude_deg, 60);
}

TEST(Scenario, EachVehicleHasASeedOfItsOwn) {
    const auto one = read("[sim]\nseed = 1\n[[vehicle]]\ncount = 2\n").each_vehicle();
    const auto again = read("[sim]\nseed = 1\n[[vehicle]]\ncount = 2\n").each_vehicle();
    const auto two = read("[sim]\nseed = 2\n[[vehicle]]\ncount = 2\n").each_vehicle();

    EXPECT_NE(one[0].options.seed, one[1].options.seed);
    EXPECT_EQ(one[1].options.seed, again[1].options.seed);
    EXPECT_NE(one[0].options.seed, two[0].options.seed);
}

TEST(Scenario, KnowsItselfFromARoutersConfiguration) {
    EXPECT_TRUE(is_scenario(*config::parse_document("[sim]\n", "x")));
    EXPECT_TRUE(is_scenario(*config::parse_document("[[vehicle]]\n", "x")));
    EXPECT_FALSE(is_scenario(*config::parse_document("[router]\n[[endpoint]]\nurl = 'udpin://0.0.0.0:1'\n", "x")));
}

TEST(Scenario, OrdersAreRequestsOfTheControlSocket) {
    const auto sut = read(R"(
[[vehicle]]
count = 3
[[event]]
at = "1.5s"
do = "goto 47.5 -8 30"
system = 3
[[event]]
at = "1m"
do = "land"
)");

    ASSERT_EQ(sut.orders.size(), 2u);
    EXPECT_EQ(sut.orders[0].at, 1500ms);
    EXPECT_EQ(sut.orders[0].request, R"({"cmd":"goto","system":3,"latitude":47.5,"longitude":-8.0,"altitude":30.0})");
    EXPECT_EQ(sut.orders[1].request, R"({"cmd":"mode","mode":"Land"})");
}

TEST(Scenario, OrdersThatNoVehicleCanFollowAreErrors) {
    const auto error = [](const std::string& order) {
        const auto text = fmt::format("[[event]]\nat = \"1s\"\ndo = \"{}\"\n", order);
        const auto scenario = read_scenario(*config::parse_document(text, "x"), {}, {});
        return scenario ? std::string() : scenario.error().text;
    };
    EXPECT_THAT(error("goto 99 8 10"), HasSubstr("latitude: '99' is not a number from -90 to 90"));
    EXPECT_THAT(error("goto 47 181"), HasSubstr("longitude: '181' is not a number from -180 to 180"));
    EXPECT_THAT(error("takeoff 0.4"), HasSubstr("altitude: '0.4' is not a number from 0.5 to 10000"));
    EXPECT_EQ(error("goto -90 180"), "");
}

TEST(ScenarioValues, TimesAreInUtc) {
    EXPECT_EQ(parse_utc("2026-11-29T12:00:00Z").value(), WallTime{std::chrono::seconds{1'795'953'600}});
    for (const auto* const text :
         {"", "2026-11-29", "2026-11-29T12:00:00", "2026-11-29T12:00:00Z ", "2026-13-29T12:00:00Z",
          "2026-02-30T12:00:00Z", "2026-11-29T12:00:60Z", "2300-01-01T00:00:00Z", "1969-01-01T00:00:00Z"})
        EXPECT_FALSE(parse_utc(text)) << text;
}

TEST(Scenario, ItsNameIsThatOfItsRing) {
    EXPECT_EQ(read("[sim]\nring = \"fleet\"\n").control_name(), "fleet");
    EXPECT_EQ(read("[sim]\nring = \"fleet\"\nname = \"other\"\n").control_name(), "other");
}

TEST(ScenarioValues, WindComesFromWhereItIsSetTo) {
    const auto wind = parse_wind("5,270,1.5");
    ASSERT_TRUE(wind);
    EXPECT_EQ(wind->speed_m_s, 5);
    EXPECT_EQ(wind->direction_deg, 90);  // the air moves to the east
    EXPECT_EQ(wind->gust_m_s, 1.5);
}

TEST(ScenarioValues, NumbersAreFiniteAndWhole) {
    for (const auto text : {"", "1 ", " 1", "1x", "nan", "inf", "-inf", "1e999", "0x10", "1,2"})
        EXPECT_FALSE(parse_number(text, {-1e9, 1e9})) << text;
    EXPECT_EQ(parse_number("-1.5e3", {-1e9, 1e9}), -1500);
    EXPECT_FALSE(parse_pairs("A:1,,B:2"));
    EXPECT_FALSE(parse_pairs("A"));
    EXPECT_FALSE(parse_pairs(":1"));
    EXPECT_FALSE(parse_battery("cells:15"));
    EXPECT_THAT(parse_battery("cells:15").error().text, HasSubstr("cells: 15 is not a number from 1 to 14"));
}

TEST(ScenarioValues, ABodyIsAPresetWithChanges) {
    const auto iris = parse_copter("iris");
    ASSERT_TRUE(iris);
    EXPECT_EQ(iris->mass_kg, 1.55);
    EXPECT_EQ(iris->rotors[1].right_m, -0.2);

    const auto heavy = parse_copter("iris,mass:2");
    ASSERT_TRUE(heavy);
    EXPECT_EQ(heavy->mass_kg, 2);
    EXPECT_EQ(heavy->rotors[1].right_m, -0.2);

    const auto hexa = parse_copter("arm:0.3,frame:hexa-x,inertia_z:0.2,preset:jmavsim,thrust:6");
    ASSERT_TRUE(hexa);
    EXPECT_EQ(hexa->rotor_count, 6);
    EXPECT_NEAR(hexa->rotors[0].right_m, 0.3, 1e-12);
    EXPECT_EQ(hexa->inertia_kg_m2[2], 0.2);
    EXPECT_EQ(hexa->mass_kg, 0.8);
    EXPECT_EQ(hexa->thrust_n, 6);
}

TEST(ScenarioValues, ABodyThatCannotFlyIsRefused) {
    const auto error = [](std::string_view text) {
        const auto body = parse_copter(text);
        return body ? "" : body.error().text;
    };
    EXPECT_THAT(error("mass:3"), HasSubstr("its 4 motors lift 29.4 N, and it weighs 29.4 N"));
    EXPECT_THAT(error("thrust:100"), HasSubstr("27.2 times its weight"));
    EXPECT_THAT(error("inertia_x:1"), HasSubstr("its motors tilt it by at most 3.12 rad/s^2"));
    EXPECT_THAT(error("turn_drag:5"), HasSubstr("drag is too large"));
    EXPECT_THAT(error("mass:0"), HasSubstr("mass: '0' is not a number from 0.05 to 500"));
    EXPECT_THAT(error("irs"), HasSubstr("preset: 'irs' is none of standard, iris, jmavsim, did you mean 'iris'?"));
    EXPECT_THAT(error("frame:hexa"), HasSubstr("frame: 'hexa' is none of quad-x"));
    EXPECT_THAT(error("mas:2"), HasSubstr("did you mean 'mass'?"));
    EXPECT_THAT(error("mass:2,iris"), HasSubstr("'iris' is not NAME:VALUE"));
    EXPECT_THAT(error("mass:2,mass:3"), HasSubstr("'mass' stands twice"));
}

TEST(ScenarioValues, TheBodyOfAPlaneIsAPresetWithChanges) {
    const auto plane = parse_plane("mass:2,thrust:20,inertia_y:0.1,stall:15,elevator:0.4");
    ASSERT_TRUE(plane) << plane.error().text;
    EXPECT_EQ(plane->mass_kg, 2);
    EXPECT_EQ(plane->thrust_n, 20);
    EXPECT_EQ(plane->inertia_kg_m2[1], 0.1);
    EXPECT_EQ(plane->stall_deg, 15);
    EXPECT_EQ(plane->full_elevator, 0.4);
    EXPECT_EQ(plane->area_m2, sim::PlaneBody{}.area_m2);

    const auto aerosonde = parse_plane("aerosonde,mass:13.5");
    ASSERT_TRUE(aerosonde) << aerosonde.error().text;
    EXPECT_EQ(aerosonde->mass_kg, 13.5);
    EXPECT_EQ(aerosonde->span_m, 2.9);
}

TEST(ScenarioValues, ThePresetsOfEveryKindAreGood) {
    for (const auto name : sim::body_names) EXPECT_TRUE(parse_copter(name)) << name;
    for (const auto name : sim::plane_names) EXPECT_TRUE(parse_plane(name)) << name;
    for (const auto name : sim::rover_names) EXPECT_TRUE(parse_rover(name)) << name;
}

TEST(ScenarioValues, APlaneThatCannotFlyIsRefused) {
    const auto error = [](std::string_view text) {
        const auto body = parse_plane(text);
        return body ? "" : body.error().text;
    };
    // sqrt(2 * 100 * 9.80665 / (1.225 * 0.4 * 1.171)) = 58.5 m/s.
    EXPECT_THAT(error("mass:100,thrust:1000"), HasSubstr("it stalls at 58.5 m/s"));
    EXPECT_THAT(error("lift_zero:-0.5,lift_slope:1"), HasSubstr("its greatest lift coefficient is -0.27"));
    // At 1.3 times the stall speed, 9.3 m/s.
    EXPECT_THAT(error("thrust:2"), HasSubstr("at 9.3 m/s its motor pulls 1.5 N, and its drag is 1."));
    EXPECT_THAT(error("pitch_speed:9"), HasSubstr("its motor pulls 0.0 N"));
    EXPECT_THAT(error("ailerons:0.001"), HasSubstr("its ailerons roll it by at most 0.3"));
    EXPECT_THAT(error("pitch_stiffness:5,elevator:0.01"), HasSubstr("its elevator cannot hold it"));
    EXPECT_THAT(error("roll_damping:30"), HasSubstr("damping or its stiffness is too large"));
    EXPECT_THAT(error("inertia_z:0.0001"), HasSubstr("damping or its stiffness is too large"));
    EXPECT_THAT(error("mass:0"), HasSubstr("mass: '0' is not a number from 0.05 to 500"));
    EXPECT_THAT(error("trim:nan"), HasSubstr("trim: 'nan' is not a number from -5 to 10"));
    EXPECT_THAT(error("iris"), HasSubstr("preset: 'iris' is none of standard, aerosonde, gazebo"));
    EXPECT_THAT(error("elevater:1"), HasSubstr("did you mean 'elevator'?"));
}

TEST(ScenarioValues, TheBodyOfARoverIsAPresetWithChanges) {
    const auto rover = parse_rover("sih,mass:25,grip:6");
    ASSERT_TRUE(rover) << rover.error().text;
    EXPECT_EQ(rover->mass_kg, 25);
    EXPECT_EQ(rover->grip_m_s2, 6);
    EXPECT_NEAR(rover->turn_radius_m, 0.556, 1e-3);  // 0.321 m / tan(30 degrees)
    const auto long_one = parse_rover("wheel_base:2,steering:45");
    ASSERT_TRUE(long_one) << long_one.error().text;
    EXPECT_NEAR(long_one->turn_radius_m, 2, 1e-9);
}

TEST(ScenarioValues, ARoverThatCannotDriveIsRefused) {
    const auto error = [](std::string_view text) {
        const auto body = parse_rover(text);
        return body ? "" : body.error().text;
    };
    EXPECT_THAT(error("thrust:1"), HasSubstr("accelerates it by 0.20 m/s^2"));
    EXPECT_THAT(error("thrust:10000"), HasSubstr("accelerates it by 2000 m/s^2, too much for its top speed of 10"));
    EXPECT_THAT(error("wheel_base:1"), HasSubstr("wheel_base and steering come together"));
    EXPECT_THAT(error("wheel_base:1,steering:30,turn_radius:2"), HasSubstr("in the place of turn_radius"));
    EXPECT_THAT(error("wheel_base:20,steering:2"), HasSubstr("its turn radius is 572.73 m"));
    EXPECT_THAT(error("steering:90,wheel_base:1"), HasSubstr("steering: '90' is not a number from 2 to 70"));
    EXPECT_THAT(error("area:1"), HasSubstr("'area' is none of preset, wheel_base"));
}

TEST(Scenario, ABodyIsOneOfTheVehiclesKind) {
    const auto vehicles = read(
                              "[[vehicle]]\nkind = \"plane\"\nbody = \"aerosonde\"\n[[vehicle]]\nkind = \"rover\"\n"
                              "[vehicle.body]\nmass = 10\n[[vehicle]]\nbody = \"iris\"\n")
                              .each_vehicle();
    EXPECT_EQ(vehicles[0].options.body.plane.mass_kg, 11);
    EXPECT_EQ(vehicles[1].options.body.rover.mass_kg, 10);
    EXPECT_EQ(vehicles[2].options.body.copter.mass_kg, 1.55);
    const auto document = config::parse_document(
        "[[vehicle]]\nkind = \"plane\"\n[vehicle.body]\nmass = 2\nrotor_drag = 1\n", "x.toml");
    ASSERT_TRUE(document);
    const auto wrong = read_scenario(*document, {}, {});
    ASSERT_FALSE(wrong);
    EXPECT_THAT(wrong.error().text, HasSubstr(":5: body: 'rotor_drag' is none of preset, mass"));
}

}  // namespace
}  // namespace mavloom::simserve
