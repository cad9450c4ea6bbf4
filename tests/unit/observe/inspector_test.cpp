// SPDX-License-Identifier: MIT
// Expected values of recordings: pymavlink's decoder (dialect common), and the differences of the records' times.
#include "mavloom/observe/inspector.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/ekf_status_report.hpp"
#include "mavloom/msg/estimator_status.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/statustext.hpp"
#include "mavloom/msg/system_time.hpp"
#include "mavloom/msg/timesync.hpp"
#include "unit/observe/fixture.hpp"

namespace mavloom::observe {
namespace {

using namespace testing;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

double ms(Nanoseconds time) { return std::chrono::duration<double, std::milli>(time).count(); }

msg::Statustext text(std::uint8_t severity, std::string_view words, std::uint16_t id = 0, std::uint8_t chunk = 0) {
    msg::Statustext message{.severity = severity, .id_ = id, .chunk_seq = chunk};
    std::ranges::copy(words, message.text.begin());
    return message;
}

TEST_F(InspectorTest, KnowsTheVehicleOfAFlight) {
    hear_recording("px4_gcs_flight.tlog");
    const auto its = the_vehicle();
    EXPECT_EQ(its.type, 2);
    EXPECT_EQ(its.autopilot, 12);
    EXPECT_EQ(its.mode, "Hold");  // 50593792
    EXPECT_EQ(its.status, 3);
    EXPECT_FALSE(its.is_armed);
    ASSERT_TRUE(its.battery && its.gps && its.position);
    EXPECT_EQ(its.battery->percent, 100);
    EXPECT_DOUBLE_EQ(*its.battery->voltage_v, 16.2);
    EXPECT_EQ(its.battery->current_a, std::nullopt);  // -1
    EXPECT_EQ(its.gps->fix, 3);
    EXPECT_EQ(its.gps->satellites, 10);
    EXPECT_DOUBLE_EQ(its.position->lat_deg, 47.3977438);
    EXPECT_DOUBLE_EQ(its.position->lon_deg, 8.5455939);
    EXPECT_DOUBLE_EQ(its.position->alt_m, 489.339);
    EXPECT_DOUBLE_EQ(its.position->relative_alt_m, -0.085);
    EXPECT_DOUBLE_EQ(*its.position->heading_deg, 359.8);
    EXPECT_NEAR(its.position->ground_speed_m_s, 0.028284, 1e-6);  // 2 and -2 cm/s
    EXPECT_NEAR(its.hz, 369.2, 4);                                // 39,974 frames in 108.27 s
    EXPECT_EQ(the_vehicle(station).type, 6);
    EXPECT_EQ(the_vehicle(station).mode, "");
    EXPECT_EQ(inspector.vehicles(last).size(), 2u);
}

// hdg: "0.0..359.99 degrees"; some vehicles send 36000 for north.
TEST_F(InspectorTest, AHeadingIsBelow360) {
    hear(msg::Heartbeat{});
    for (const auto& [sent, shown] : {std::pair(0, 0.0), std::pair(35'999, 359.99), std::pair(36'000, 0.0)}) {
        hear(msg::GlobalPositionInt{.lat = 1, .lon = 1, .hdg = static_cast<std::uint16_t>(sent)});
        EXPECT_DOUBLE_EQ(the_vehicle().position->heading_deg.value(), shown);
    }
}

TEST_F(InspectorTest, VehiclesAreInTheOrderOfTheirIds) {
    const std::array<Source, 4> ids{Source{SystemId{1}, ComponentId{1}}, Source{SystemId{1}, ComponentId{191}},
                                    Source{SystemId{2}, ComponentId{1}}, Source{SystemId{10}, ComponentId{1}}};
    for (const auto i : {2u, 0u, 3u, 1u}) hear(msg::Heartbeat{}, 0s, ids[i]);
    EXPECT_TRUE(std::ranges::equal(inspector.vehicles(wall(0s)), ids, {}, &Vehicle::source));
}

TEST_F(InspectorTest, AGoodFlightHasNoAlarms) {
    hear_recording("px4_gcs_flight.tlog");
    EXPECT_THAT(alarms(), IsEmpty());
}

TEST_F(InspectorTest, CommandsOfAFlight) {
    hear_recording("px4_gcs_flight.tlog");
    const auto& its = the_vehicle().command;
    EXPECT_EQ(its.count, 5u);
    EXPECT_NEAR(ms(its.last), 3.322, 0.001);
    EXPECT_NEAR(ms(its.least), 2.262, 0.001);
    EXPECT_NEAR(ms(its.mean()), (11.768 + 3.683 + 2.262 + 11.851 + 3.322) / 5, 0.001);
}

TEST_F(InspectorTest, RoundTripsOfASession) {
    hear_recording("px4_gcs_session.tlog");
    const auto its = the_vehicle();
    EXPECT_EQ(its.command.count, 13u);
    EXPECT_EQ(its.timesync.count, 1u);
    EXPECT_NEAR(ms(its.timesync.last), 0.122, 0.001);
    EXPECT_EQ(its.ping.count, 1u);
}

TEST_F(InspectorTest, AnAnswerBelongsToTheRequestThatItRepeats) {
    hear(msg::Heartbeat{});
    hear(msg::Timesync{.tc1 = 0, .ts1 = 7}, 1s, station);
    hear(msg::Timesync{.tc1 = 0, .ts1 = 8}, 2s, station);
    hear(msg::Timesync{.tc1 = 5, .ts1 = 7}, 2500ms);
    hear(msg::Timesync{.tc1 = 5, .ts1 = 7}, 2600ms);  // again
    hear(msg::Timesync{.tc1 = 5, .ts1 = 9}, 2600ms);  // of a request that was not heard
    hear(msg::Ping{.time_usec = 3, .seq = 1}, 3s, station);
    hear(msg::Ping{.time_usec = 3, .seq = 1, .target_system = 255, .target_component = 190}, 3004ms);
    EXPECT_EQ(the_vehicle().timesync.count, 1u);
    EXPECT_EQ(the_vehicle().timesync.last, 1500ms);
    EXPECT_EQ(the_vehicle().ping.last, 4ms);
}

TEST_F(InspectorTest, ACommandThatIsSentAgainBeginsAgain) {
    hear(msg::Heartbeat{});
    hear(msg::CommandLong{.target_system = 1, .command = 400}, 1s, station);
    hear(msg::CommandLong{.target_system = 1, .command = 400, .confirmation = 1}, 2s, station);
    hear(msg::CommandAck{.command = 400}, 2100ms);
    hear(msg::CommandAck{.command = 400}, 2200ms);
    EXPECT_EQ(the_vehicle().command.count, 1u);
    EXPECT_EQ(the_vehicle().command.last, 100ms);
    hear(msg::CommandInt{.target_system = 1, .command = 192}, 3s, station);
    hear(msg::CommandAck{.command = 192, .target_system = 250}, 3100ms);  // to somebody else
    EXPECT_EQ(the_vehicle().command.count, 1u);
    hear(msg::CommandAck{.command = 192, .target_system = 255}, 14s);  // too late to be its answer
    EXPECT_EQ(the_vehicle().command.count, 1u);
}

TEST_F(InspectorTest, UnansweredRequestsDoNotFillTheMemory) {
    hear(msg::Heartbeat{});
    for (int i = 1; i < 5000; ++i) hear(msg::Timesync{.tc1 = 0, .ts1 = i}, 1s, station);
    hear(msg::Timesync{.tc1 = 1, .ts1 = 1}, 1001ms);
    hear(msg::Timesync{.tc1 = 1, .ts1 = 4999}, 1002ms);
    EXPECT_EQ(the_vehicle().timesync.count, 1u);
}

TEST_F(InspectorTest, ASourceFallsSilent) {
    for (int i = 0; i < 3; ++i) hear(msg::Heartbeat{}, 0s);
    hear(msg::Timesync{}, 0s, {SystemId{9}, ComponentId{1}});   // sends no HEARTBEAT
    hear(msg::Heartbeat{}, 0s, {SystemId{8}, ComponentId{1}});  // only once, as invented ones do
    tick(4s);
    EXPECT_THAT(alarms(), IsEmpty());
    tick(6s);
    tick(7s);
    EXPECT_THAT(alarms(), ElementsAre("silent error 1/1: nothing is heard of it"));
    EXPECT_EQ(inspector.alarms().front().since, wall(0s)) << "silent since its last frame";
    hear(msg::Heartbeat{}, 8s);
    tick(8s);
    EXPECT_THAT(alarms(), ElementsAre("silent error 1/1: nothing is heard of it (ended)"));
    EXPECT_EQ(inspector.alarms().front().ended, wall(8s));
    tick(8s + 9min);
    EXPECT_EQ(alarms().size(), 2u) << "it is silent again";
    tick(8s + 11min);
    EXPECT_EQ(alarms().size(), 1u) << "the first one ended 11 minutes ago";
}

TEST_F(InspectorTest, SendersOfARecordingThatEndedAreNotSilent) {
    for (const auto link : {LinkId{1}, LinkId{2}})
        for (const auto at : {0s, 1s, 2s}) hear(msg::Heartbeat{}, at, {SystemId{9}, ComponentId{1}}, link);
    for (const auto at : {0s, 1s, 2s}) hear(msg::Heartbeat{}, at);
    inspector.note_end(LinkId{2});
    tick(10s);
    EXPECT_THAT(alarms(), ElementsAre("silent error 1/1: nothing is heard of it"));
    EXPECT_TRUE(the_vehicle({SystemId{9}, ComponentId{1}}).has_ended);
    EXPECT_FALSE(the_vehicle().has_ended);
    inspector.note_end(LinkId{1});
    tick(11s);
    EXPECT_THAT(alarms(), ElementsAre("silent error 1/1: nothing is heard of it (ended)"));
}

TEST_F(InspectorTest, InventedSendersLeaveRoomForOtherAlarms) {
    for (int i = 0; i < 3; ++i)
        for (int id = 0; id < 5000; ++id)
            hear(msg::Heartbeat{}, 0s,
                 {SystemId{static_cast<std::uint8_t>(1 + id % 250)},
                  ComponentId{static_cast<std::uint8_t>(1 + id / 250)}});
    hear(text(2, "Crash"), 1s);
    tick(6s);
    tick(7s);
    EXPECT_EQ(alarms().size(), Inspector::max_silent + 2);
    EXPECT_THAT(alarms(), Contains("silent error 0/0: 4032 more are silent"));
    EXPECT_THAT(alarms(), Contains("text error 1/1: Crash"));
    EXPECT_EQ(inspector.vehicles(wall(7s)).size(), VehicleTable::max_senders);
}

TEST_F(InspectorTest, SilentVehiclesLeaveTheirPlaceToNewOnes) {
    const auto source = [](int id) {
        return Source{SystemId{static_cast<std::uint8_t>(1 + id % 250)},
                      ComponentId{static_cast<std::uint8_t>(1 + id / 250)}};
    };
    for (int id = 0; id < 4096; ++id) hear(msg::Heartbeat{.type = 2}, id == 7 ? 0s : 10s, source(id));
    hear(msg::Heartbeat{.type = 3}, 59s, source(5000));
    EXPECT_EQ(the_vehicle(source(5000)).type, 0) << "no room";
    hear(msg::Heartbeat{.type = 3}, 61s, source(5000));
    EXPECT_EQ(the_vehicle(source(5000)).type, 3);
    EXPECT_EQ(the_vehicle(source(7)).type, 0);
    EXPECT_EQ(the_vehicle(source(8)).type, 2);
}

TEST_F(InspectorTest, TheBatteryIsLow) {
    hear(msg::SysStatus{.battery_remaining = 16});
    EXPECT_THAT(alarms(), IsEmpty());
    hear(msg::SysStatus{.battery_remaining = 15}, 1s);
    EXPECT_THAT(alarms(), ElementsAre("battery warning 1/1: battery at 15 %"));
    hear(msg::SysStatus{.battery_remaining = 16}, 2s);
    hear(msg::SysStatus{.battery_remaining = 7}, 3s);
    EXPECT_THAT(alarms(), ElementsAre("battery error 1/1: battery at 7 %"));
    EXPECT_EQ(inspector.alarms().front().since, wall(1s));
    hear(msg::SysStatus{.battery_remaining = 100}, 4s);
    EXPECT_THAT(alarms(), ElementsAre("battery error 1/1: battery at 7 % (ended)"));
    hear(msg::SysStatus{.battery_remaining = -1}, 5s);  // not known
    EXPECT_EQ(alarms().size(), 1u);
}

TEST_F(InspectorTest, ABatteryJudgesItself) {
    hear(msg::Heartbeat{});
    hear(msg::BatteryStatus{.battery_remaining = 10, .charge_state = 1});
    hear(msg::SysStatus{.battery_remaining = 10});
    EXPECT_THAT(alarms(), IsEmpty());
    hear(msg::BatteryStatus{.battery_remaining = 30, .charge_state = 2});
    hear(msg::BatteryStatus{.id_ = 1, .battery_remaining = 5, .charge_state = 3});
    EXPECT_THAT(alarms(), UnorderedElementsAre("battery warning 1/1: battery is low, at 30 %",
                                               "battery error 1/1: battery 1 is critical, at 5 %"));
    hear(msg::BatteryStatus{.id_ = 2, .battery_remaining = -1, .charge_state = 5});
    EXPECT_THAT(alarms(), Contains("battery error 1/1: battery 2 is failed"));
    hear(msg::BatteryStatus{.battery_remaining = 30, .charge_state = 7});  // charging
    EXPECT_THAT(alarms(), Contains("battery warning 1/1: battery is low, at 30 % (ended)"));
}

TEST_F(InspectorTest, TheBatteryIsThatWithTheLowestNumber) {
    hear(msg::Heartbeat{});
    hear(msg::SysStatus{.voltage_battery = 9000, .battery_remaining = 90});
    EXPECT_EQ(the_vehicle().battery->percent, 90);
    hear(msg::BatteryStatus{.id_ = 2, .battery_remaining = 60});
    hear(msg::BatteryStatus{.id_ = 1, .voltages = {4200, 4100, UINT16_MAX}, .battery_remaining = 50});
    hear(msg::BatteryStatus{.id_ = 2, .battery_remaining = 60});
    hear(msg::SysStatus{.battery_remaining = 90});
    EXPECT_EQ(the_vehicle().battery->percent, 50);
    EXPECT_DOUBLE_EQ(*the_vehicle().battery->voltage_v, 8.3);
}

// MAV_SYS_STATUS_SENSOR
constexpr std::uint32_t gyro = 1, gps = 32, prearm = 1u << 28, battery = 1u << 25,
                        sensors = gyro | gps | prearm | battery;

msg::SysStatus health(std::uint32_t healthy, std::uint32_t enabled = sensors) {
    return {.onboard_control_sensors_present = sensors,
            .onboard_control_sensors_enabled = enabled,
            .onboard_control_sensors_health = healthy,
            .battery_remaining = -1};
}

TEST_F(InspectorTest, ASensorIsNotHealthy) {
    hear(health(sensors));
    hear(health(battery, sensors & ~gyro), 1s);
    EXPECT_THAT(alarms(), ElementsAre("health warning 1/1: not healthy: GPS")) << "the gyro is off, the check is none";
    hear(health(sensors), 2s);
    EXPECT_THAT(alarms(), ElementsAre("health warning 1/1: not healthy: GPS (ended)"));
}

TEST_F(InspectorTest, SensorsOfAVehicleThatBootsHaveTime) {
    constexpr Source other{SystemId{2}, ComponentId{1}};
    hear(health(gyro | battery));
    hear(health(battery), 5s);
    EXPECT_THAT(alarms(), ElementsAre("health warning 1/1: not healthy: 3D_GYRO")) << "it was healthy before";
    hear(health(sensors), 6s);
    hear(health(gyro | battery), 6s, other);
    hear(health(gyro | battery), 35s, other);
    EXPECT_EQ(alarms().size(), 1u);
    hear(health(gyro | battery), 36s, other);
    EXPECT_THAT(alarms(), Contains("health warning 2/1: not healthy: GPS"));
}

TEST_F(InspectorTest, ArduPilotsEkfDoubts) {
    hear(msg::EkfStatusReport{.flags = 831, .velocity_variance = 0.4F, .compass_variance = 0.49F});
    EXPECT_THAT(alarms(), IsEmpty());
    hear(msg::EkfStatusReport{.flags = 831, .velocity_variance = 0.4F, .compass_variance = 0.6F});
    EXPECT_THAT(alarms(), ElementsAre("ekf warning 1/1: EKF variance: compass 0.60"));
    hear(msg::EkfStatusReport{.flags = 831, .velocity_variance = 0.9F, .compass_variance = 0.6F});
    EXPECT_THAT(alarms(), ElementsAre("ekf error 1/1: EKF variance: velocity 0.90, compass 0.60"));
    hear(msg::EkfStatusReport{.flags = 830});
    EXPECT_THAT(alarms(), ElementsAre("ekf error 1/1: EKF has no good attitude"));
    hear(msg::EkfStatusReport{.flags = 1024});  // it has not begun
    EXPECT_THAT(alarms(), ElementsAre("ekf error 1/1: EKF has no good attitude (ended)"));
}

TEST_F(InspectorTest, Px4sEstimatorRejects) {
    hear(msg::EstimatorStatus{.flags = 895, .vel_ratio = 0.9F, .tas_ratio = std::nanf("")});
    EXPECT_THAT(alarms(), IsEmpty());
    hear(msg::EstimatorStatus{.flags = 895, .vel_ratio = 0.9F, .mag_ratio = 1.25F});
    EXPECT_THAT(alarms(), ElementsAre("ekf warning 1/1: estimator rejects: magnetometer 1.25"));
    hear(msg::EstimatorStatus{.flags = 895 | 1024});
    EXPECT_THAT(alarms(), ElementsAre("ekf warning 1/1: estimator: GPS glitch"));
    hear(msg::EstimatorStatus{.flags = 895 | 2048});
    EXPECT_THAT(alarms(), ElementsAre("ekf error 1/1: estimator: bad accelerometer"));
}

TEST_F(InspectorTest, AVehicleIsInFailSafe) {
    hear(msg::Heartbeat{.system_status = 4});
    hear(msg::Heartbeat{.system_status = 5}, 1s);
    EXPECT_THAT(alarms(), ElementsAre("failsafe error 1/1: fail-safe: the vehicle is in a critical state"));
    hear(msg::Heartbeat{.system_status = 6}, 2s);
    EXPECT_THAT(alarms(), ElementsAre("failsafe error 1/1: emergency: the vehicle has lost control"));
    hear(msg::Heartbeat{.system_status = 4}, 3s);
    EXPECT_THAT(alarms(), ElementsAre(HasSubstr("(ended)")));
    hear(msg::Heartbeat{.system_status = 5}, 8s);
    EXPECT_EQ(alarms().size(), 1u) << "it continues after a short pause";
}

// tests/data/README.md: QGroundControl connects.
TEST_F(InspectorTest, TextsOfARecording) {
    hear_recording("qgc_px4_flight_requests.tlog");
    EXPECT_THAT(alarms(), Contains(HasSubstr("text error 1/1: Preflight Fail: no heading reference")));
    EXPECT_THAT(alarms(), ::testing::Not(Contains(HasSubstr("Armed by external command")))) << "severity 6";
}

TEST_F(InspectorTest, TextsInPiecesAreOne) {
    hear(text(4, "Low battery, ", 3, 0));
    hear(text(4, "return home", 3, 1));
    hear(text(4, "another", 4, 1));  // its beginning was lost
    EXPECT_THAT(alarms(),
                UnorderedElementsAre("text warning 1/1: Low battery, return home", "text warning 1/1: another"));
}

TEST_F(InspectorTest, TextsEndByThemselves) {
    hear(text(2, "Crash"));
    tick(9s);
    EXPECT_THAT(alarms(), ElementsAre("text error 1/1: Crash"));
    hear(text(2, "Crash"), 9s);
    tick(18s);
    EXPECT_THAT(alarms(), ElementsAre("text error 1/1: Crash"));
    tick(20s);
    EXPECT_THAT(alarms(), ElementsAre("text error 1/1: Crash (ended)"));
}

TEST_F(InspectorTest, ManyTextsLeaveRoomForTheLatest) {
    hear(msg::Heartbeat{.system_status = 5});
    for (int i = 0; i < 10'000; ++i) hear(text(4, fmt::format("text {}", i)), 1s);
    EXPECT_EQ(alarms().size(), Alarms::max_alarms);
    EXPECT_EQ(inspector.evicted_alarms(), 10'001 - Alarms::max_alarms);
    EXPECT_THAT(alarms(), Contains("text warning 1/1: text 9999"));
    EXPECT_THAT(alarms(), Contains(HasSubstr("failsafe"))) << "texts push out texts only";
}

TEST_F(InspectorTest, AVehicleRestarts) {
    for (int i = 0; i < 5; ++i) hear(msg::SystemTime{.time_boot_ms = 60'000u + i * 1000u}, i * 1s);
    EXPECT_THAT(alarms(), IsEmpty());
    hear(msg::SystemTime{.time_boot_ms = 0}, 9s);  // its clock does not run yet
    hear(msg::SystemTime{.time_boot_ms = 1000}, 10s);
    hear(msg::SystemTime{.time_boot_ms = 2000}, 11s);
    EXPECT_THAT(alarms(), ElementsAre("restart info 1/1: the vehicle has restarted"));
}

TEST_F(InspectorTest, AClockJumps) {
    hear(msg::SystemTime{.time_boot_ms = 60'000}, 0s);
    hear(msg::SystemTime{.time_boot_ms = 161'000}, 1s);
    hear(msg::SystemTime{.time_boot_ms = 162'000}, 2s);
    EXPECT_THAT(alarms(), ElementsAre("clock warning 1/1: the clock of its messages jumped by +100.0 s"));
}

TEST_F(InspectorTest, AReaderThatStoodStillIsNoJump) {
    for (int i = 0; i < 40; ++i) {
        const Nanoseconds arrival = i * 500ms,
                          read = std::max<Nanoseconds>(arrival, 15s);  // all of the first 15 s at once
        const auto bytes = frame_of(msg::SystemTime{.time_unix_usec = static_cast<std::uint64_t>(unix_us(wall(arrival))),
                                                    .time_boot_ms = static_cast<std::uint32_t>(60'000 + i * 500)});
        inspector.add({.frame = view(bytes),
                       .link = LinkId{1},
                       .link_name = "link",
                       .time = wall(arrival),
                       .now = mono(i == 0 ? 0s : read),
                       .waited = i == 0 ? 0s : waited_since(wall(arrival), wall(read))});
    }
    EXPECT_THAT(alarms(), IsEmpty());
    EXPECT_EQ(waited_since(wall(0s), wall(61s)), 0s) << "of a recording";
    EXPECT_EQ(waited_since(wall(1s), wall(0s)), 0s) << "the clock was set back";
}

TEST_F(InspectorTest, TimesOfDayThatCannotBeAreIgnored) {
    for (const std::uint64_t time : {std::uint64_t{4'102'444'800'000'000}, std::uint64_t{4'102'444'800'000'001},
                                     std::uint64_t{9'300'000'000'000'000}, ~std::uint64_t{0}})
        hear(msg::SystemTime{.time_unix_usec = time}, 1s);
    EXPECT_THAT(alarms(), IsEmpty());
}

TEST_F(InspectorTest, ATimeOfDayJumps) {
    const std::uint64_t now = 1'700'000'000'000'000;
    hear(msg::SystemTime{.time_unix_usec = 5'000'000}, 0s);  // it has none yet
    hear(msg::SystemTime{.time_unix_usec = now + 1'000'000}, 1s);
    hear(msg::SystemTime{.time_unix_usec = now + 2'000'000}, 2s);
    EXPECT_THAT(alarms(), IsEmpty());
    hear(msg::SystemTime{.time_unix_usec = now - 57'000'000}, 3s);
    EXPECT_THAT(alarms(), ElementsAre("clock warning 1/1: its time of day (SYSTEM_TIME) jumped by -60.0 s"));
}

TEST_F(InspectorTest, ThisMachinesClockJumps) {
    tick(1s);
    tick(2s);
    EXPECT_THAT(alarms(), IsEmpty());
    inspector.tick(wall(3603s), mono(3s));
    EXPECT_THAT(alarms(), ElementsAre("clock warning 0/0: the clock of this machine was set by +3600.0 s"));
}

TEST_F(InspectorTest, TwoVehiclesHaveOneId) {
    for (int i = 0; i < 10; ++i) {
        hear(msg::SystemTime{.time_boot_ms = 60'000u + i * 1000u}, i * 1s, vehicle, LinkId{1});
        hear(msg::SystemTime{.time_boot_ms = 9'000u + i * 1000u}, i * 1s + 500ms, vehicle, LinkId{2});
    }
    EXPECT_THAT(alarms(), Contains("two_senders error 1/1: two vehicles have this id: their clocks differ"));
}

struct LossTest : InspectorTest {
    // The receiver has counted this until now.
    void note(Nanoseconds at, SenderLoss loss) {
        loss.link = LinkId{1};
        loss.link_name = "radio";
        loss.source = vehicle;
        inspector.note_losses({&loss, 1}, wall(at), mono(at));
    }
};

TEST_F(LossTest, ALinkLosesFrames) {
    note(0s, {.received = 1000, .lost = 500});  // before
    note(5s, {.received = 1050, .lost = 550});
    EXPECT_THAT(alarms(), IsEmpty()) << "not yet 10 s";
    note(10s, {.received = 1091, .lost = 509});
    EXPECT_THAT(alarms(), IsEmpty()) << "9 frames may be chance";
    note(20s, {.received = 1181, .lost = 519});
    EXPECT_THAT(alarms(), ElementsAre("loss warning 1/1: 10.0 % of its frames are lost (10 of 100 in 10 s)"));
    EXPECT_EQ(inspector.alarms().front().link, "radio");
    note(30s, {.received = 1281, .lost = 511});  // some were only late
    EXPECT_THAT(alarms(), ElementsAre(HasSubstr("(ended)")));
}

TEST_F(LossTest, AnAlarmEndsWithItsLink) {
    note(0s, {});
    note(10s, {.received = 100, .lost = 50});
    EXPECT_EQ(alarms().size(), 1u);
    inspector.note_losses({}, wall(11s), mono(11s));
    EXPECT_THAT(alarms(), ElementsAre(HasSubstr("(ended)")));
}

TEST_F(LossTest, TwoSendersMixTheirNumbers) {
    note(0s, {.received = 1000, .late = 3, .resync = 1});
    note(10s, {.received = 1100, .late = 8, .resync = 4});
    EXPECT_THAT(alarms(), IsEmpty());
    note(20s, {.received = 1200, .late = 28, .resync = 34});
    EXPECT_THAT(alarms(), ElementsAre("two_senders error 1/1: two senders have this id: their sequence numbers mix"));
    note(30s, {.received = 1300, .late = 28, .resync = 34});
    EXPECT_THAT(alarms(), ElementsAre(HasSubstr("(ended)")));
}

struct HopTest : InspectorTest {
    void set(Nanoseconds at, std::uint64_t frames, std::uint64_t dropped) {
        inspector.set_hops(
            {{.name = "router",
              .kind = Hop::Kind::router,
              .frames_in = frames,
              .links = {{.name = "radio", .losses = {{"tx_dropped", dropped, "queue full"}, {"lost", dropped}}}}}},
            wall(at), mono(at));
        tick(at);
    }
};

TEST_F(HopTest, AQueueDrops) {
    set(0s, 0, 7);
    set(1s, 0, 7);
    EXPECT_THAT(alarms(), IsEmpty()) << "what was lost before is no news";
    set(2s, 0, 10);
    set(3s, 0, 12);
    EXPECT_THAT(alarms(), ElementsAre("drop warning 0/0: router: radio lost 5, 12 in all: tx_dropped, queue full"));
    set(14s, 0, 12);
    EXPECT_THAT(alarms(),
                ElementsAre("drop warning 0/0: router: radio lost 5, 12 in all: tx_dropped, queue full (ended)"));
    set(60s, 0, 13);
    EXPECT_THAT(alarms(), Contains("drop warning 0/0: router: radio lost 1, 13 in all: tx_dropped, queue full"));
}

// Programs report no losses that are 0.
TEST_F(HopTest, AnAlarmCountsFromTheFirstLoss) {
    const auto report = [&](Nanoseconds at, std::vector<NamedCount> losses) {
        inspector.set_hops({{.name = "relay", .losses = std::move(losses)}}, wall(at), mono(at));
        tick(at);
    };
    report(0s, {});
    report(1s, {{"stopped", 64}});
    EXPECT_THAT(alarms(), ElementsAre("drop warning 0/0: relay lost 64: stopped"));
    report(2s, {{"stopped", 608}});
    EXPECT_THAT(alarms(), ElementsAre("drop warning 0/0: relay lost 608: stopped"));
}

TEST_F(HopTest, FaultsThatDamageFramesLoseNone) {
    const auto report = [&](Nanoseconds at, std::vector<NamedCount> losses) {
        inspector.set_hops({{.name = "router", .links = {{.name = "radio", .losses = std::move(losses)}}}}, wall(at),
                           mono(at));
        tick(at);
    };
    report(0s, {});
    report(1s, {{"fault_corrupted", 4, "inverted a bit"}, {"fault_cut", 3}, {"fault_lost", 2}, {"held_dropped", 1}});
    EXPECT_THAT(alarms(), ::testing::UnorderedElementsAre(
                              "drop warning 0/0: router: radio damaged 4: fault_corrupted, inverted a bit",
                              "drop warning 0/0: router: radio damaged 3: fault_cut",
                              "drop warning 0/0: router: radio lost 2: fault_lost",
                              "drop warning 0/0: router: radio lost 1: held_dropped"));
}

TEST_F(HopTest, AClosedLinkRaisesNoSecondAlarm) {
    const std::string sum = "all other links";
    const auto report = [&](Nanoseconds at, std::vector<HopLink> links) {
        inspector.set_hops({{.name = "router", .links = std::move(links)}}, wall(at), mono(at));
        tick(at);
    };
    report(0s, {{.name = "b"}, {.name = sum, .is_sum = true, .frames_in = 9}});
    report(1s, {{.name = "b", .losses = {{"queue_bytes", 500}}}, {.name = sum, .is_sum = true, .frames_in = 9}});
    EXPECT_THAT(alarms(), ElementsAre("drop warning 0/0: router: b lost 500: queue_bytes"));
    report(20s, {{.name = sum, .is_sum = true, .frames_in = 9, .losses = {{"queue_bytes", 500}}}});
    EXPECT_THAT(alarms(), ElementsAre("drop warning 0/0: router: b lost 500: queue_bytes (ended)"));
}

TEST_F(HopTest, RatesComeFromCounts) {
    const auto hz_at = [&](Nanoseconds at, std::uint64_t frames) {
        set(at, frames, 0);
        return inspector.hops().front().hz_in;
    };
    EXPECT_EQ(hz_at(0s, 1000), std::nullopt);
    EXPECT_EQ(hz_at(500ms, 9999), std::nullopt) << "over a second at least";
    EXPECT_EQ(hz_at(2s, 9999), 8999 / 2.0);
    EXPECT_EQ(hz_at(5s, 10'999), 9999 / 5.0);
    EXPECT_EQ(hz_at(7s, 11'000), 1001 / 5.0) << "the last five seconds";
    EXPECT_EQ(hz_at(8s, 0), std::nullopt) << "it was started again";
    EXPECT_EQ(hz_at(9s, 50), 50);
}

}  // namespace
}  // namespace mavloom::observe
