// SPDX-License-Identifier: MIT
// Expected values: pymavlink's px4_map and mode_mapping tables, QGroundControl's FirmwarePlugins (the names that its
// list of modes shows), mavros' uas_stringify.cpp, the words of PX4's `commander mode`, and MAVSDK's FlightMode.
// tests/python/mavutil compares all of ArduPilot's names with the installed pymavlink.
#include "mavloom/message/modes.hpp"

#include <gtest/gtest.h>

#include <set>

#include "unit/message/sample_messages.hpp"

namespace mavloom::message {
namespace {

using namespace mavloom::testing;  // NOLINT: the sample definitions

constexpr std::uint8_t px4 = 12, ardupilot = 3, no_autopilot = 8;
constexpr std::uint8_t fixed_wing = 1, quadrotor = 2, ground_station = 6, rover = 10, boat = 11, submarine = 12,
                       vtol = 20, hexarotor = 13;

struct Case {
    std::string_view name;
    std::uint32_t number;
};

void expect_numbers(std::uint8_t autopilot, std::uint8_t type, std::initializer_list<Case> cases) {
    for (const auto& [name, number] : cases)
        EXPECT_EQ(mode_number(flight_modes(autopilot, type), name), number) << name;
}

TEST(Modes, Px4sHaveTheNamesOfFivePrograms) {
    constexpr std::uint32_t hold = 50593792, mission = 67371008, returning = 84148224;  // sub mode 3, 4, 5 of main 4
    expect_numbers(px4, quadrotor,
                   {{"Hold", hold},
                    {"LOITER", hold},
                    {"AUTO.LOITER", hold},
                    {"auto:loiter", hold},
                    {"AUTO_LOITER", hold},
                    {"hold", hold},
                    {"Mission", mission},
                    {"AUTO.MISSION", mission},
                    {"Return", returning},
                    {"RTL", returning},
                    {"rtl", returning},
                    {"AUTO.RTL", returning},
                    {"ReturnToLaunch", returning}});
    expect_numbers(px4, fixed_wing,
                   {{"Manual", 1u << 16},
                    {"ALTCTL", 2u << 16},
                    {"Altitude", 2u << 16},
                    {"POSCTL", 3u << 16},
                    {"Position", 3u << 16},
                    {"Position Hold", 3u << 16},
                    {"ALT_HOLD", 2u << 16},
                    {"STABILIZE", 7u << 16},
                    {"AUTO", 4u << 16 | 4u << 24},
                    {"Orbit", 3u << 16 | 1u << 24},
                    {"Acro", 5u << 16},
                    {"OFFBOARD", 6u << 16},
                    {"Stabilized", 7u << 16},
                    {"STAB", 7u << 16},
                    {"RATTITUDE", 8u << 16},
                    {"Takeoff", 4u << 16 | 2u << 24},
                    {"Land", 4u << 16 | 6u << 24},
                    {"RTGS", 4u << 16 | 7u << 24},
                    {"FOLLOWME", 4u << 16 | 8u << 24},
                    {"Follow Me", 4u << 16 | 8u << 24},
                    {"AUTO.FOLLOW_TARGET", 4u << 16 | 8u << 24},
                    {"Precision Land", 4u << 16 | 9u << 24},
                    {"AUTO.PRECLAND", 4u << 16 | 9u << 24},
                    {"AUTO.READY", 4u << 16 | 1u << 24},
                    {"ext1", 4u << 16 | 11u << 24}});
    EXPECT_EQ(mode_number(flight_modes(px4, quadrotor), "GUIDED"), std::nullopt);
    EXPECT_EQ(mode_number(flight_modes(px4, quadrotor), ""), std::nullopt);
    EXPECT_EQ(mode_number(flight_modes(px4, quadrotor), "Hol"), std::nullopt);
}

TEST(Modes, ArduPilotsHaveItsNamesAndThoseOfQGroundControl) {
    expect_numbers(
        ardupilot, quadrotor,
        {{"STABILIZE", 0},      {"Altitude Hold", 2}, {"ALT_HOLD", 2},       {"althold", 2},     {"Auto", 3},
         {"Guided", 4},         {"Loiter", 5},        {"Hold", 5},           {"AUTO.LOITER", 5}, {"RTL", 6},
         {"POSCTL", 16},        {"Altitude", 2},      {"Position Hold", 16}, {"POSHOLD", 16},    {"Avoid ADSB", 19},
         {"Guided No GPS", 20}, {"Smart RTL", 21},    {"SMARTRTL", 21},      {"Flow Hold", 22},  {"ZigZag", 24},
         {"SystemID", 25},      {"AutoRotate", 26},   {"AutoRTL", 27}});
    expect_numbers(ardupilot, vtol,
                   {{"FBW A", 5},
                    {"FBWA", 5},
                    {"FLY_BY_WIRE_B", 6},
                    {"Hold", 12},
                    {"Takeoff", 13},
                    {"Initializing", 16},
                    {"QuadPlane Stabilize", 17},
                    {"QuadPlane Hover", 18},
                    {"QuadPlane Loiter", 19},
                    {"QuadPlane Land", 20},
                    {"QuadPlane RTL", 21},
                    {"QuadPlane AutoTune", 22},
                    {"QuadPlane Acro", 23},
                    {"Loiter to QLand", 25},
                    {"Loiter to QLAND", 25}});
    expect_numbers(ardupilot, rover, {{"Hold", 4}, {"Steering", 3}, {"Dock", 8}, {"Smart RTL", 12}, {"Guided", 15}});
    expect_numbers(ardupilot, submarine,
                   {{"Depth Hold", 2},
                    {"Surface", 9},
                    {"Position Hold", 16},
                    {"Manual", 19},
                    {"Motor Detection", 20},
                    {"MOTORDETECT", 20},
                    {"Surftrak", 21}});
}

TEST(Modes, NameTheModeOfAHeartbeat) {
    const auto mode_of = [](std::uint8_t autopilot, std::uint8_t type, std::uint32_t custom_mode,
                            std::uint8_t base_mode = 1) {
        return heartbeat_mode(bytes_of(custom_mode, type, autopilot, base_mode, std::uint8_t{4}, std::uint8_t{3}));
    };
    EXPECT_EQ(mode_of(px4, quadrotor, 50593792), "Hold");
    EXPECT_EQ(mode_of(ardupilot, hexarotor, 5), "LOITER");
    EXPECT_EQ(mode_of(ardupilot, fixed_wing, 5), "FBWA");
    EXPECT_EQ(mode_of(ardupilot, boat, 5), "LOITER");
    EXPECT_EQ(mode_of(ardupilot, quadrotor, 12), "");
    EXPECT_EQ(mode_of(ardupilot, quadrotor, 5, 0x80), "");  // no custom mode
    EXPECT_EQ(mode_of(no_autopilot, ground_station, 0), "");
    EXPECT_EQ(mode_of(ardupilot, ground_station, 0), "");
    EXPECT_EQ(mode_of(px4, quadrotor, 0), "");
    EXPECT_EQ(heartbeat_mode({}), "");
}

TEST(Modes, EveryNameStandsForOneMode) {
    for (const std::uint8_t type : {fixed_wing, quadrotor, std::uint8_t{5}, std::uint8_t{7}, rover, submarine}) {
        for (const std::uint8_t autopilot : {px4, ardupilot}) {
            const auto modes = flight_modes(autopilot, type);
            ASSERT_FALSE(modes.empty());
            std::set<std::uint32_t> numbers;
            for (const auto& mode : modes) {
                EXPECT_EQ(mode_number(modes, mode.name), mode.number) << mode.name;
                EXPECT_TRUE(numbers.insert(mode.number).second) << mode.number;
            }
        }
    }
}

// The three forms of a message.
TEST(Modes, StandBesideTheFieldsOfAHeartbeat) {
    const SampleFrame hold(heartbeat, bytes_of(std::uint32_t{50593792}, quadrotor, px4, std::uint8_t{29},
                                               std::uint8_t{4}, std::uint8_t{3}));
    const SampleFrame station(heartbeat, bytes_of(std::uint32_t{0}, ground_station, no_autopilot, std::uint8_t{0},
                                                  std::uint8_t{4}, std::uint8_t{3}));
    const auto csv_of = [](const Received& received) {
        TextBuffer out;
        append_csv_header(out, heartbeat);
        append_csv_row(out, received);
        return fmt::to_string(out);
    };

    EXPECT_NE(text_of(hold.received()).find("  custom_mode=50593792 (Hold)  system_status=4"), std::string::npos);
    EXPECT_NE(text_of(station.received()).find("  custom_mode=0  system_status=4"), std::string::npos);
    EXPECT_TRUE(json_of(hold.received()).ends_with("\"mavlink_version\":3},\"mode\":\"Hold\"}\n"));
    EXPECT_TRUE(json_of(station.received()).ends_with("\"mavlink_version\":3},\"mode\":null}\n"));
    EXPECT_EQ(csv_of(hold.received()),
              "time_us,link,sys,comp,seq,type,autopilot,base_mode,custom_mode,system_status,mavlink_version,mode\n"
              "1700000000123456,\"px4\",1,191,7,2,12,29,50593792,4,3,\"Hold\"\n");
    EXPECT_TRUE(csv_of(station.received()).ends_with(",1,191,7,6,8,0,0,4,3,\n"));
}

// Another definition with the id of HEARTBEAT has other fields.
TEST(Modes, AreNotReadFromAnotherDefinition) {
    Message other = heartbeat;
    other.wire.crc_extra = 51;
    const SampleFrame frame(
        other, bytes_of(std::uint32_t{50593792}, quadrotor, px4, std::uint8_t{29}, std::uint8_t{4}, std::uint8_t{3}));

    EXPECT_EQ(json_of(frame.received()).find("\"mode\""), std::string::npos);
    EXPECT_EQ(text_of(frame.received()).find("Hold"), std::string::npos);
}

}  // namespace
}  // namespace mavloom::message
