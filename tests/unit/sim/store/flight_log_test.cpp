// SPDX-License-Identifier: MIT
// The logs of flights: that they agree with the telemetry of the flight, and that they stay bounded. pyulog and
// pymavlink read whole logs in tests/system/sim/test_sim_files.py.
#include <gmock/gmock.h>

#include <map>
#include <string>
#include <utility>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/global_position_int.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/log_data.hpp"
#include "mavloom/msg/log_entry.hpp"
#include "mavloom/msg/log_erase.hpp"
#include "mavloom/msg/log_request_data.hpp"
#include "mavloom/msg/log_request_list.hpp"
#include "mavloom/msg/mission_count.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::flight_log_tests {
namespace {

using namespace msg;
using test::Rig;
using Bytes = std::vector<std::uint8_t>;

VehicleOptions options_of(Autopilot autopilot = Autopilot::px4) {
    VehicleOptions options;
    options.autopilot = autopilot;
    options.logs = 0;
    options.utc_at_start = WallTime{std::chrono::seconds{1795222314}};
    return options;
}

std::vector<LogEntry> list(Rig& rig) {
    rig.forget();
    rig.send(LogRequestList{.target_system = rig.vehicle.system().value, .target_component = 1, .end = 0xffff});
    rig.run(0.1);
    return rig.all<LogEntry>();
}

Bytes read(Rig& rig, std::uint16_t id, std::uint32_t offset = 0, std::uint32_t count = 0xffffffff) {
    rig.forget();
    rig.send(LogRequestData{
        .target_system = rig.vehicle.system().value, .target_component = 1, .id_ = id, .ofs = offset, .count = count});
    rig.run(5.0);
    Bytes content;
    for (const auto& piece : rig.all<LogData>())
        content.insert(content.end(), piece.data.begin(), piece.data.begin() + piece.count);
    return content;
}

// Arms for so many seconds.
void stand_armed(Rig& rig, double seconds) {
    ASSERT_TRUE(rig.vehicle.arm(true));
    rig.run(seconds);
    ASSERT_TRUE(rig.vehicle.disarm(true));
    rig.run(1.0);
}

// The data messages of a topic of a ULog, without their heads.
std::vector<Bytes> topic_of(const Bytes& log, std::string_view name) {
    std::vector<Bytes> found;
    int id = -1;
    for (std::size_t at = 16; at + 3 <= log.size();) {
        const std::size_t size = load_le<std::uint16_t>(log.data() + at);
        const std::uint8_t* const body = log.data() + at + 3;
        const char type = static_cast<char>(log[at + 2]);
        if (type == 'A' && std::string(body + 3, body + size) == name) id = load_le<std::uint16_t>(body + 1);
        if (type == 'D' && load_le<std::uint16_t>(body) == id) found.emplace_back(body + 2, body + size);
        at += 3 + size;
    }
    return found;
}

TEST(FlightLog, AgreesWithTheTelemetryOfTheSameInstant) {
    Rig rig(options_of(), {.rates = {{GlobalPositionInt::id, 250}, {LocalPositionNed::id, 250}, {Attitude::id, 250}}});
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.take_off(8));
    rig.run(12.0);
    std::map<std::uint32_t, GlobalPositionInt> positions;
    std::map<std::uint32_t, LocalPositionNed> locals;
    std::map<std::uint32_t, Attitude> attitudes;
    for (const auto& message : rig.all<GlobalPositionInt>()) positions[message.time_boot_ms] = message;
    for (const auto& message : rig.all<LocalPositionNed>()) locals[message.time_boot_ms] = message;
    for (const auto& message : rig.all<Attitude>()) attitudes[message.time_boot_ms] = message;
    ASSERT_TRUE(rig.vehicle.disarm(true));
    rig.run(1.0);
    ASSERT_EQ(list(rig).size(), 1u);

    const Bytes log = read(rig, 0);
    std::size_t compared = 0;
    for (const Bytes& data : topic_of(log, "vehicle_global_position")) {
        const auto at = positions.find(static_cast<std::uint32_t>(load_le<std::uint64_t>(data.data()) / 1000));
        if (at == positions.end()) continue;
        ++compared;
        EXPECT_NEAR(load_le<double>(data.data() + 16) * 1e7, at->second.lat, 0.5);
        EXPECT_NEAR(load_le<double>(data.data() + 24) * 1e7, at->second.lon, 0.5);
        EXPECT_NEAR(load_le<float>(data.data() + 32), at->second.alt / 1e3, 1e-3);
    }
    EXPECT_GT(std::exchange(compared, 0), 55u);
    for (const Bytes& data : topic_of(log, "vehicle_local_position")) {
        const auto at = locals.find(static_cast<std::uint32_t>(load_le<std::uint64_t>(data.data()) / 1000));
        if (at == locals.end()) continue;
        ++compared;
        EXPECT_EQ(load_le<float>(data.data() + 40), at->second.x);
        EXPECT_EQ(load_le<float>(data.data() + 48), at->second.z);
        EXPECT_NEAR(load_le<float>(data.data() + 60), at->second.vz, 0.006);
    }
    EXPECT_GT(std::exchange(compared, 0), 55u);
    for (const Bytes& data : topic_of(log, "vehicle_attitude")) {
        const auto at = attitudes.find(static_cast<std::uint32_t>(load_le<std::uint64_t>(data.data()) / 1000));
        if (at == attitudes.end()) continue;
        ++compared;
        const auto q = [&](int i) { return double{load_le<float>(data.data() + 16 + 4 * i)}; };
        const double yaw = std::atan2(2 * (q(0) * q(3) + q(1) * q(2)), 1 - 2 * (q(2) * q(2) + q(3) * q(3)));
        EXPECT_NEAR(std::remainder(yaw - double{at->second.yaw}, 2 * std::numbers::pi), 0, 2e-4);
    }
    EXPECT_GT(compared, 55u);
    EXPECT_GT(topic_of(log, "battery_status").size(), 55u);
}

TEST(FlightLog, HasTheSameBytesHoweverItIsRead) {
    for (const Autopilot autopilot : {Autopilot::px4, Autopilot::ardupilot}) {
        Rig rig(options_of(autopilot)), twin(options_of(autopilot));
        for (Rig* const one : {&rig, &twin}) {
            one->run(4.0);
            stand_armed(*one, 5);
        }
        const std::uint16_t id = autopilot == Autopilot::px4 ? 0 : 1;
        const auto entries = list(rig);
        ASSERT_EQ(entries.size(), 1u);
        EXPECT_GE(entries[0].time_utc, 1795222318u);
        const Bytes whole = read(rig, id);
        ASSERT_EQ(whole.size(), entries[0].size);
        EXPECT_EQ(read(twin, id), whole) << "the same seed gives the same log";
        for (std::uint32_t offset = 17; offset < whole.size(); offset += static_cast<std::uint32_t>(whole.size() / 23)) {
            const Bytes part = read(rig, id, offset, 177);
            ASSERT_LE(offset + part.size(), whole.size());
            EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin() + offset)) << offset;
        }
    }
}

TEST(FlightLog, ParametersAreThoseAtTheArming) {
    Rig rig(options_of());
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.set_parameter("MIS_TAKEOFF_ALT", 7.5));
    stand_armed(rig, 2);
    const Bytes before = read(rig, 0);
    ASSERT_TRUE(rig.vehicle.set_parameter("MIS_TAKEOFF_ALT", 9));
    EXPECT_EQ(read(rig, 0), before);

    const std::string key = "float MIS_TAKEOFF_ALT";
    const auto at = std::search(before.begin(), before.end(), key.begin(), key.end());
    ASSERT_NE(at, before.end());
    EXPECT_EQ(load_le<float>(&*at + key.size()), 7.5f);
}

TEST(FlightLog, TheOldestFlightGoesFirst) {
    VehicleOptions options = options_of(Autopilot::ardupilot);
    options.limits.flight_logs = 3;
    Rig rig(options);
    rig.run(4.0);
    std::vector<std::uint32_t> began;
    for (int flight = 0; flight < 6; ++flight) {
        stand_armed(rig, 1);
        const auto entries = list(rig);
        ASSERT_EQ(entries.size(), std::min<std::size_t>(flight + 1, 3));
        began.push_back(entries.back().time_utc);
        EXPECT_EQ(entries.front().time_utc, began[began.size() - entries.size()]);
        EXPECT_EQ(read(rig, entries.back().id_).size(), entries.back().size);
    }
    rig.send(LogErase{.target_system = 1, .target_component = 1});
    EXPECT_EQ(list(rig).back().num_logs, 0);
    stand_armed(rig, 1);
    EXPECT_EQ(list(rig).size(), 1u);
}

TEST(FlightLog, AListThatWaitsEndsWithTheLogsThatAreLeft) {
    VehicleOptions options = options_of();
    options.limits.flight_logs = 3;
    Rig rig(options);
    rig.run(4.0);
    for (int flight = 0; flight < 3; ++flight) stand_armed(rig, 1);
    ASSERT_EQ(list(rig).size(), 3u);
    rig.forget();
    rig.sink.full = {1};
    rig.send(LogRequestList{.target_system = 1, .target_component = 1, .end = 0xffff});
    ASSERT_TRUE(rig.vehicle.arm(true));
    rig.run(0.1);
    rig.sink.full = {};
    rig.run(0.1);
    const auto entries = rig.all<LogEntry>();
    ASSERT_EQ(entries.size(), 2u) << "the flight that begins replaces the oldest one";
    EXPECT_EQ(entries[0].num_logs, 2);
}

TEST(FlightLog, ALongFlightHasFewerSamplesASecond) {
    VehicleOptions options = options_of();
    options.limits.log_records = 100;
    Rig rig(options);
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.set_parameter("COM_DISARM_PRFLT", -1));
    stand_armed(rig, 120);
    const auto samples = topic_of(read(rig, 0), "vehicle_attitude");
    EXPECT_LE(samples.size(), 100u);
    EXPECT_GE(samples.size(), 40u);
    const auto time = [](const Bytes& data) { return static_cast<double>(load_le<std::uint64_t>(data.data())) / 1e6; };
    EXPECT_NEAR(time(samples.back()) - time(samples.front()), 120, 0.1) << "the whole flight";
    for (std::size_t i = 1; i < samples.size(); ++i) EXPECT_LE(time(samples[i]) - time(samples[i - 1]), 3.3);
    stand_armed(rig, 1);
    EXPECT_EQ(list(rig).size(), 1u) << "the long one made room";
}

std::vector<double> seconds_of(const std::vector<Bytes>& samples) {
    std::vector<double> seconds;
    seconds.reserve(samples.size());
    for (const Bytes& data : samples) seconds.push_back(static_cast<double>(load_le<std::uint64_t>(data.data())) / 1e6);
    return seconds;
}

// When nothing can be thinned out any more, records are lost. When there is room again, samples are recorded as before.
TEST(FlightLog, AFlightOfManyModeChangesStaysBounded) {
    VehicleOptions options = options_of();
    options.limits.log_records = 50;
    Rig rig(options);
    rig.run(4.0);
    stand_armed(rig, 3);
    ASSERT_TRUE(rig.vehicle.arm(true));
    for (int i = 0; i < 200; ++i) {
        ASSERT_TRUE(rig.vehicle.set_mode(i % 2 == 0 ? "Land" : "Hold"));
        rig.run(0.02);
    }
    rig.send(LogErase{.target_system = 1, .target_component = 1});
    rig.run(5.0);
    ASSERT_TRUE(rig.vehicle.disarm(true));
    rig.run(1.0);

    const auto entries = list(rig);
    ASSERT_EQ(entries.size(), 1u);
    const Bytes log = read(rig, 0);
    EXPECT_EQ(log.size(), entries[0].size);
    const auto times = seconds_of(topic_of(log, "vehicle_attitude"));
    ASSERT_GE(times.size(), 2u);
    for (std::size_t i = 1; i + 1 < times.size(); ++i) EXPECT_GE(times[i] - times[i - 1], 0.199);
}

TEST(FlightLog, ChangedParametersStayBounded) {
    VehicleOptions options = options_of();
    options.limits.log_parameters = 1;
    Rig rig(options);
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.set_parameter("MIS_TAKEOFF_ALT", 7.5));
    for (int flight = 0; flight < 3; ++flight) {
        stand_armed(rig, 1);
        EXPECT_EQ(list(rig).size(), 1u);
    }
}

TEST(FlightLog, WithoutRoomForAFlightThereIsNone) {
    VehicleOptions options = options_of();
    options.limits.flight_logs = 0;
    Rig rig(options);
    rig.run(4.0);
    stand_armed(rig, 1);
    EXPECT_EQ(list(rig).back().num_logs, 0);
}

TEST(FlightLog, HasTheSystemIdOfItsFlight) {
    Rig rig(options_of());
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.set_parameter("MAV_SYS_ID", 7));
    stand_armed(rig, 1);
    rig.send(CommandLong{.target_system = 1, .target_component = 1, .command = 246, .param1 = 1});  // reboot
    rig.run(8.0);
    ASSERT_EQ(rig.vehicle.system(), SystemId{7});
    stand_armed(rig, 1);
    const auto system_of = [&](std::uint16_t id) {
        const Bytes status = topic_of(read(rig, id), "vehicle_status").at(0);
        return int{status.at(status.size() - 2)};
    };
    EXPECT_EQ(system_of(0), 1);
    EXPECT_EQ(system_of(1), 7);
}

// PX4's files have the second in their names.
TEST(FlightLog, BeginsInNoSecondInWhichAnotherLogBegins) {
    VehicleOptions options = options_of();
    options.logs = 2;
    Rig rig(options);
    rig.run(0.3);
    stand_armed(rig, 0.2);
    const auto entries = list(rig);
    ASSERT_EQ(entries.size(), 3u);
    EXPECT_EQ(entries[1].time_utc, 1795222314u);
    EXPECT_EQ(entries[2].time_utc, 1795222315u);
}

TEST(FlightLog, HasTheTextOfATransferThatTimesOut) {
    Rig rig(options_of());
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.set_parameter("COM_DISARM_PRFLT", -1));
    ASSERT_TRUE(rig.vehicle.arm(true));
    rig.send(MissionCount{.target_system = 1, .target_component = 1, .count = 2});
    rig.run(20.0);
    ASSERT_TRUE(rig.vehicle.disarm(true));
    rig.run(1.0);
    const Bytes log = read(rig, 0);
    EXPECT_THAT(std::string(log.begin(), log.end()), testing::HasSubstr("imeout"));
}

}  // namespace
}  // namespace mavloom::sim::flight_log_tests
