// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <set>
#include <sstream>

#include "flight/firmware/firmware.hpp"
#include "flight/firmware/param_tables/table.hpp"

namespace mavloom::flight {
namespace {

constexpr Kind all_kinds[] = {Kind::quad, Kind::plane, Kind::rover};
constexpr Autopilot all_autopilots[] = {Autopilot::px4, Autopilot::ardupilot};

const Firmware& px4_quad() { return Firmware::of(Autopilot::px4, Kind::quad); }
const Firmware& ardupilot_copter() { return Firmware::of(Autopilot::ardupilot, Kind::quad); }

// As PX4 lists its modes: custom mode, standard mode, properties.
TEST(Firmware, ListsTheModesOfPx4InItsOrder) {
    struct Row {
        std::uint32_t custom_mode;
        std::uint8_t standard_mode;
        std::uint32_t properties;
    };
    constexpr Row recorded[] = {{65536, 0, 1},     {131072, 4, 0},    {196608, 1, 0},    {67371008, 6, 1},
                                {50593792, 0, 1},  {84148224, 5, 1},  {33751040, 0, 1},  {319029248, 0, 1},
                                {720896, 0, 1},    {327680, 0, 1},    {335806464, 0, 3}, {655360, 0, 3},
                                {393216, 0, 1},    {458752, 0, 1},    {33816576, 8, 1},  {100925440, 7, 1},
                                {134479872, 0, 1}, {151257088, 0, 1}, {16973824, 2, 1},  {168034304, 0, 1},
                                {184811520, 0, 2}, {201588736, 0, 2}, {218365952, 0, 2}, {235143168, 0, 2},
                                {251920384, 0, 2}, {268697600, 0, 2}, {285474816, 0, 2}, {302252032, 0, 2}};
    for (const Kind kind : all_kinds) {
        const auto modes = Firmware::of(Autopilot::px4, kind).modes();
        ASSERT_EQ(modes.size(), std::size(recorded));
        for (std::size_t i = 0; i < modes.size(); ++i) {
            EXPECT_EQ(modes[i].custom_mode, recorded[i].custom_mode) << i;
            EXPECT_EQ(modes[i].standard_mode, recorded[i].standard_mode) << i;
            EXPECT_EQ(modes[i].properties, recorded[i].properties) << i;
        }
    }
}

TEST(Firmware, ReportsTheBaseModesOfPx4) {
    const auto base = [](std::string_view name) { return int{px4_quad().find_mode(name)->base_mode}; };
    EXPECT_EQ(base("Hold"), 29);
    EXPECT_EQ(base("Mission"), 29);
    EXPECT_EQ(base("Return"), 29);
    EXPECT_EQ(base("Land"), 29);
    EXPECT_EQ(base("Position"), 81);
    EXPECT_EQ(base("Altitude"), 81);
    EXPECT_EQ(base("Stabilized"), 81);
    EXPECT_EQ(base("Manual"), 81);
    EXPECT_EQ(base("Acro"), 65);
    EXPECT_EQ(base("Offboard"), 17);
    EXPECT_EQ(int{Firmware::of(Autopilot::px4, Kind::plane).find_mode("Manual")->base_mode}, 65);
    EXPECT_EQ(int{ardupilot_copter().find_mode("STABILIZE")->base_mode}, 81);
    EXPECT_EQ(int{ardupilot_copter().find_mode("GUIDED")->base_mode}, 89);
}

std::uint32_t requested(const Firmware& firmware, int base, std::uint32_t main, std::uint32_t sub) {
    const ModeInfo* const mode = firmware.requested_mode(static_cast<std::uint8_t>(base), main, sub);
    return mode == nullptr ? 0xffffffff : mode->custom_mode;
}
constexpr std::uint32_t refused = 0xffffffff;

TEST(Firmware, FindsTheModeThatAClientOfPx4AsksFor) {
    EXPECT_EQ(requested(px4_quad(), 1, 4, 4), 0x04040000u);
    EXPECT_EQ(requested(px4_quad(), 29, 4, 3), 0x03040000u);
    EXPECT_EQ(requested(px4_quad(), 1, 4, 0), 0x04040000u) << "auto without a sub mode is the mission";
    EXPECT_EQ(requested(px4_quad(), 1, 3, 1), 0x01030000u);
    EXPECT_EQ(requested(px4_quad(), 1, 0x06040000, 0), 0x06040000u) << "the packed mode in one parameter";
    EXPECT_EQ(requested(px4_quad(), 1, 4, 99), refused);
    EXPECT_EQ(requested(px4_quad(), 1, 0, 0), refused);
    EXPECT_EQ(requested(px4_quad(), 1, 4, 11), refused) << "no external mode is registered";
    EXPECT_EQ(requested(px4_quad(), 1, 4, 20), refused) << "Descend is not selectable";
    EXPECT_EQ(requested(px4_quad(), 1, 10, 0), refused) << "Termination is not selectable";
}

// Old clients set flags of the base mode only, such as pymavlink's set_mode_manual() and set_mode_fbwa().
TEST(Firmware, FindsTheModeOfPx4ByBaseModeAlone) {
    EXPECT_EQ(requested(px4_quad(), 4 | 8 | 16, 0, 0), 0x04040000u);
    EXPECT_EQ(requested(px4_quad(), 64 | 8 | 16, 0, 0), 0x00030000u);
    EXPECT_EQ(requested(px4_quad(), 64 | 16, 0, 0), 0x00070000u);
    EXPECT_EQ(requested(px4_quad(), 64, 0, 0), 0x00010000u);
    EXPECT_EQ(requested(px4_quad(), 0, 4, 3), refused);
}

TEST(Firmware, FindsTheModeThatAClientOfArduPilotAsksFor) {
    EXPECT_EQ(requested(ardupilot_copter(), 1, 4, 0), 4u);
    EXPECT_EQ(requested(ardupilot_copter(), 1, 6, 0), 6u);
    EXPECT_EQ(requested(ardupilot_copter(), 1, 8, 0), refused);
    EXPECT_EQ(requested(ardupilot_copter(), 1, 99, 0), refused);
    EXPECT_EQ(requested(ardupilot_copter(), 0, 4, 0), refused) << "only custom modes";
    EXPECT_EQ(requested(Firmware::of(Autopilot::ardupilot, Kind::plane), 1, 17, 0), refused) << "not a VTOL";
}

TEST(Firmware, HasAModeForItsOwnActions) {
    const auto name_for = [](const Firmware& firmware, Behaviour behaviour) {
        const ModeInfo* const mode = firmware.mode_for(behaviour);
        return mode == nullptr ? std::string_view{} : mode->name;
    };
    EXPECT_EQ(name_for(px4_quad(), Behaviour::hold), "Hold");
    EXPECT_EQ(name_for(px4_quad(), Behaviour::brake), "Hold");
    EXPECT_EQ(name_for(px4_quad(), Behaviour::land), "Land");
    EXPECT_EQ(name_for(px4_quad(), Behaviour::position), "Position");
    EXPECT_EQ(name_for(ardupilot_copter(), Behaviour::hold), "LOITER");
    EXPECT_EQ(name_for(ardupilot_copter(), Behaviour::offboard), "GUIDED");
    EXPECT_EQ(name_for(ardupilot_copter(), Behaviour::return_home), "RTL");
    EXPECT_EQ(name_for(Firmware::of(Autopilot::ardupilot, Kind::plane), Behaviour::hold), "LOITER");
    EXPECT_EQ(name_for(Firmware::of(Autopilot::ardupilot, Kind::rover), Behaviour::hold), "HOLD");
    EXPECT_EQ(name_for(Firmware::of(Autopilot::px4, Kind::rover), Behaviour::takeoff), "");
}

// Clients need dense, unique, sorted names; tables are written by hand.
void expect_well_formed(const ParamInfo& row, Autopilot autopilot) {
    SCOPED_TRACE(row.name);
    const auto [lowest, highest] = range_of(row.type);
    EXPECT_LE(row.name.size(), 16u);
    EXPECT_EQ(row.group.empty(), autopilot == Autopilot::ardupilot) << "only PX4 describes its parameters";
    EXPECT_LT(row.minimum, row.maximum);
    EXPECT_TRUE(row.initial >= row.minimum && row.initial <= row.maximum);
    EXPECT_TRUE(row.choices.empty() || row.bit_names.empty());
    EXPECT_TRUE(row.type == ParamType::real32 || row.initial == std::round(row.initial));
    EXPECT_TRUE(row.initial >= lowest && row.initial <= highest);
    EXPECT_TRUE(autopilot == Autopilot::ardupilot || row.type == ParamType::real32 || row.type == ParamType::int32);
}

TEST(Firmware, TablesOfParametersAreWellFormed) {
    for (const Autopilot autopilot : all_autopilots) {
        for (const Kind kind : all_kinds) {
            const auto rows = Firmware::of(autopilot, kind).parameters();
            EXPECT_GE(rows.size(), 800u);
            for (const ParamInfo& row : rows) expect_well_formed(row, autopilot);
            EXPECT_EQ(std::ranges::adjacent_find(rows, std::greater_equal{}, &ParamInfo::name), rows.end());
        }
    }
}

TEST(Firmware, NamesWithBracesStandForFamilies) {
    EXPECT_THAT(expanded("WP_SPEED"), testing::ElementsAre("WP_SPEED"));
    EXPECT_THAT(expanded("RC{9..11}_MIN"), testing::ElementsAre("RC9_MIN", "RC10_MIN", "RC11_MIN"));
    EXPECT_THAT(expanded("INS_ACC{,2}_{X,Y}"),
                testing::ElementsAre("INS_ACC_X", "INS_ACC_Y", "INS_ACC2_X", "INS_ACC2_Y"));
}

// Ground stations ask for these names; tests/data/client_parameters.tsv names its sources.
TEST(Firmware, HasTheParametersThatClientsAskFor) {
    std::ifstream file(MAVLOOM_TEST_DATA "/client_parameters.tsv");
    int names = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        std::istringstream columns(line);
        std::string firmware, name, kinds;
        columns >> firmware >> name >> kinds;
        const Autopilot autopilot = firmware == "px4" ? Autopilot::px4 : Autopilot::ardupilot;
        constexpr std::string_view kind_names[] = {"quad", "plane", "rover"};
        for (const Kind kind : all_kinds) {
            const std::string_view kind_name = kind_names[static_cast<std::size_t>(kind)];
            if (kinds.find(kind_name) == std::string::npos) continue;
            EXPECT_TRUE(Parameters(Firmware::of(autopilot, kind).parameters()).find(name)) << kind_name << " " << name;
        }
        ++names;
    }
    EXPECT_GT(names, 700);
}

// QGroundControl's own rules for what is set up (setupComplete of its pages).
TEST(Firmware, VehiclesAreSetUp) {
    for (const Kind kind : all_kinds) {
        const Parameters px4(Firmware::of(Autopilot::px4, kind).parameters());
        for (const char* const id : {"CAL_ACC0_ID", "CAL_GYRO0_ID", "CAL_MAG0_ID", "SYS_AUTOSTART", "BAT1_N_CELLS"})
            EXPECT_NE(px4.get(id), 0) << id;
        const Parameters ardupilot(Firmware::of(Autopilot::ardupilot, kind).parameters());
        for (const char* const id : {"COMPASS_OFS_X", "COMPASS_OFS2_Y", "COMPASS_OFS3_Z", "INS_ACCOFFS_X", "INS_ACC_ID",
                                     "COMPASS_DEV_ID3", "INS_ACC2_ID", "RCMAP_ROLL"})
            EXPECT_NE(ardupilot.get(id), 0) << id;
        EXPECT_TRUE(kind == Kind::plane || ardupilot.get("FRAME_CLASS") != 0);
        EXPECT_NE(ardupilot.get("RC1_MIN"), 1100) << "1100, 1500 and 1900 mean an uncalibrated remote control";
    }
}

// Defaults that a client or a flight depends on.
TEST(Firmware, DefaultsAreThoseOfTheSimulatedAirframes) {
    const Parameters parameters(px4_quad().parameters());
    EXPECT_EQ(parameters.get("MIS_TAKEOFF_ALT"), 2.5);
    EXPECT_EQ(parameters.get("RTL_RETURN_ALT"), 30);
    EXPECT_EQ(parameters.get("RTL_DESCEND_ALT"), 10);
    EXPECT_EQ(parameters.get("NAV_ACC_RAD"), 10);
    EXPECT_EQ(parameters.get("CAL_MAG0_ID"), 197388);
    EXPECT_EQ(parameters.get("SYS_AUTOSTART"), 10040);
    EXPECT_EQ(parameters.get("NO_SUCH_NAME", -7), -7);
}

TEST(Firmware, ParametersTuneTheVehicle) {
    Parameters parameters(px4_quad().parameters());
    EXPECT_EQ(px4_quad().tuning(parameters).cruise_speed, 5);
    EXPECT_EQ(px4_quad().tuning(parameters).on_gcs_loss, FailsafeAction::none);
    parameters.put("MPC_XY_CRUISE", 8);
    parameters.put("NAV_DLL_ACT", 3);
    parameters.put("GF_MAX_HOR_DIST", 120);
    parameters.put("COM_LOW_BAT_ACT", 0);
    const Tuning tuning = px4_quad().tuning(parameters);
    EXPECT_EQ(tuning.cruise_speed, 8);
    EXPECT_EQ(tuning.on_gcs_loss, FailsafeAction::land);
    EXPECT_EQ(tuning.fence_radius, 120);
    EXPECT_EQ(tuning.on_battery_critical, FailsafeAction::warn);
}

TEST(Firmware, ArduPilotCountsInCentimetres) {
    Parameters parameters(ardupilot_copter().parameters());
    parameters.put("WPNAV_SPEED", 700);
    parameters.put("RTL_ALT", 2000);
    parameters.put("FENCE_ENABLE", 1);
    const Tuning tuning = ardupilot_copter().tuning(parameters);
    EXPECT_EQ(tuning.cruise_speed, 7);
    EXPECT_EQ(tuning.return_altitude, 20);
    EXPECT_EQ(tuning.land_speed, 0.5);
    EXPECT_EQ(tuning.fence_radius, 300);
    EXPECT_EQ(tuning.fence_height, 100);
}

// A client may store any bits. No speed, time or distance may become NaN, infinite or negative by that.
TEST(Firmware, TuningSurvivesAnyValue) {
    constexpr float values[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                                -std::numeric_limits<float>::infinity(), -1e30f, 0.f};
    for (const Autopilot autopilot : all_autopilots) {
        for (const Kind kind : all_kinds) {
            const Firmware& firmware = Firmware::of(autopilot, kind);
            for (const float value : values) {
                Parameters parameters(firmware.parameters());
                for (ParamIndex i = 0; i < parameters.size(); ++i)
                    parameters.set_bits(i, std::bit_cast<std::uint32_t>(value));
                const Tuning t = firmware.tuning(parameters);
                for (const double number :
                     {t.cruise_speed, t.max_speed, t.climb_speed, t.descent_speed, t.takeoff_speed, t.land_speed,
                      t.acceleration, t.max_tilt, t.max_yaw_rate, t.acceptance_radius, t.takeoff_altitude, t.gcs_loss,
                      t.manual_loss, t.rover_turn_radius})
                    EXPECT_TRUE(std::isfinite(number) && number > 0) << number;
                for (const double number : {t.return_altitude, t.return_cone, t.fence_radius, t.spool_up,
                                            t.offboard_loss, t.battery_low, t.return_min_distance})
                    EXPECT_TRUE(std::isfinite(number) && number >= 0) << number;
            }
        }
    }
}

// Values by an independent program: CRC-32 without inversions over names and little-endian values.
TEST(Parameters, HashLeavesOutWhatTheVehicleChangesItself) {
    constexpr ParamInfo infos[] = {{.name = "BAT1_N_CELLS", .type = ParamType::int32, .initial = 4},
                                   {.name = "COM_FLIGHT_UUID", .type = ParamType::int32, .is_volatile = true},
                                   {.name = "MIS_TAKEOFF_ALT", .initial = 2.5},
                                   {.name = "NAV_DLL_ACT", .type = ParamType::int32, .initial = -1}};
    Parameters parameters(infos);
    EXPECT_EQ(parameters.hash(), 0x2507248bu);
    parameters.put("COM_FLIGHT_UUID", 12);
    EXPECT_EQ(parameters.hash(), 0x2507248bu);
    parameters.put("NAV_DLL_ACT", 0);
    EXPECT_NE(parameters.hash(), 0x2507248bu);
}

TEST(Parameters, HaveTheirShortestValue) {
    constexpr ParamInfo infos[] = {{.name = "A", .initial = 0.15}, {.name = "B", .type = ParamType::int32}};
    Parameters parameters(infos);
    EXPECT_EQ(parameters.value(0), double{0.15f});
    EXPECT_EQ(parameters.shortest_value(0), 0.15);
    parameters.set(0, 1.0 / 3);
    EXPECT_EQ(parameters.shortest_value(0), 0.33333334);
    parameters.set(0, std::numeric_limits<double>::infinity());
    EXPECT_EQ(parameters.shortest_value(0), std::numeric_limits<double>::infinity());
    parameters.set(1, -2147483648.0);
    EXPECT_EQ(parameters.shortest_value(1), -2147483648.0);
}

TEST(Parameters, KeepIntegersInTheRangeOfTheirType) {
    constexpr ParamInfo infos[] = {{.name = "A", .type = ParamType::int8}, {.name = "B", .type = ParamType::int16}};
    Parameters parameters(infos);
    parameters.set(0, 300);
    parameters.set(1, -1e9);
    EXPECT_EQ(parameters.value(0), 127);
    EXPECT_EQ(parameters.value(1), -32768);
    parameters.set(1, std::nan(""));
    EXPECT_EQ(parameters.value(1), 0);
}

}  // namespace
}  // namespace mavloom::flight
