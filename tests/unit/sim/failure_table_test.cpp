// SPDX-License-Identifier: MIT
// The rules of PX4's failure injection: docs/debug/failure_injection.md of PX4, and what its failure_injection_manager
// answers.
#include "sim/command/failure_table.hpp"

#include <gmock/gmock.h>

#include <map>

#include "mavloom/msg/battery_status.hpp"
#include "mavloom/msg/distance_sensor.hpp"
#include "mavloom/msg/esc_status.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/servo_output_raw.hpp"
#include "mavloom/msg/statustext.hpp"
#include "unit/sim/bench.hpp"

namespace mavloom::sim::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr int inject = 420;  // MAV_CMD_INJECT_FAILURE
enum Unit : int {
    gyro = 0,
    accel,
    mag,
    baro,
    gps,
    flow,
    vio,
    range = 7,
    airspeed,
    battery = 100,
    motor,
    servo,
    esc = 106
};
enum Type : int { ok, off, stuck, garbage, wrong, slow, delayed, intermittent };

struct Bed : Bench {
    int fail(int unit, int type, float instance = 0, float mask = 0) {
        return command(inject, {static_cast<float>(unit), static_cast<float>(type), instance, mask});
    }
    std::vector<std::string> texts() const {
        std::vector<std::string> all;
        for (const auto& m : rig.all<msg::Statustext>())
            all.emplace_back(m.text.data(), strnlen(m.text.data(), m.text.size()));
        return all;
    }
};

TEST(InjectFailure, SupportsWhatPx4Supports) {
    const std::map<int, std::vector<int>> supported{
        {gyro, {off, stuck}},       {accel, {off, stuck}}, {mag, {off, stuck}},   {baro, {off, stuck}},
        {gps, {off, stuck, wrong}}, {vio, {off}},          {range, {off, stuck}}, {airspeed, {off, stuck, wrong}},
        {battery, {off}},           {motor, {off}},        {esc, {off, wrong}}};
    for (int unit = 0; unit < 110; ++unit) {
        for (int type = ok; type < 10; ++type) {
            const auto row = supported.find(unit);
            const bool expected = row != supported.end() &&
                                  (type == ok || std::ranges::find(row->second, type) != row->second.end());
            FailureTable table;
            EXPECT_EQ(table.inject(static_cast<std::uint32_t>(unit), static_cast<std::uint32_t>(type), 1),
                      expected ? flight::Result::accepted : flight::Result::unsupported)
                << unit << ' ' << type;
        }
    }
}

TEST(InjectFailure, AFifthPairIsRejectedForNow) {
    Bed sut;
    for (const int unit : {gyro, accel, mag, baro}) ASSERT_EQ(sut.fail(unit, off), accepted);
    EXPECT_EQ(sut.fail(gps, off), temporarily_rejected);
    EXPECT_THAT(sut.texts(), IsEmpty());
    EXPECT_EQ(sut.fail(gyro, off, 2), accepted) << "a pair that is there";
    EXPECT_EQ(sut.fail(gyro, stuck), accepted) << "replaces that pair";
    EXPECT_EQ(sut.fail(gyro, ok), accepted);
    EXPECT_EQ(sut.fail(gps, off), accepted);
}

TEST(InjectFailure, IsAnnouncedAsByPx4) {
    Bed sut;
    sut.fail(gps, off);
    EXPECT_THAT(sut.texts(), ElementsAre("Injected: gps off, all instances"));
    EXPECT_EQ(sut.rig.last<msg::Statustext>()->severity, 4);
    sut.fail(gps, ok);
    EXPECT_THAT(sut.texts(), ElementsAre("Cleared: gps, all instances"));
    sut.fail(motor, off, 3);
    EXPECT_THAT(sut.texts(), ElementsAre("Injected: motor off, instances 3"));
    sut.fail(esc, wrong, nan_f, 0b1011);
    EXPECT_THAT(sut.texts(), ElementsAre("Injected: esc wrong, instances 1,2,4"));
    EXPECT_EQ(sut.fail(range, off, 17), accepted) << "without effect";
    EXPECT_THAT(sut.texts(), IsEmpty());
    EXPECT_EQ(sut.fail(range, off, nan_f, nan_f), accepted);
    EXPECT_THAT(sut.texts(), IsEmpty());
}

TEST(InjectFailure, TheSecondInstanceOfASensorIsNotTheFirst) {
    FailureTable table;
    ASSERT_EQ(table.inject(gps, off, FailureTable::instance(2)), flight::Result::accepted);
    EXPECT_EQ(table.failures().gps, flight::Failure::none);
    ASSERT_EQ(table.inject(gps, wrong, FailureTable::instance(0)), flight::Result::accepted);
    EXPECT_EQ(table.failures().gps, flight::Failure::wrong);
    ASSERT_EQ(table.inject(gps, ok, FailureTable::instance(1)), flight::Result::accepted);
    EXPECT_EQ(table.failures().gps, flight::Failure::none);
}

TEST(InjectFailure, StopsMotorsByNumber) {
    Bed sut;
    ASSERT_TRUE(sut.fly());
    ASSERT_EQ(sut.fail(motor, off, nan_f, 0b0101), accepted);
    sut.rig.run(0.05);
    sut.command(512, {36});  // MAV_CMD_REQUEST_MESSAGE: SERVO_OUTPUT_RAW
    const auto outputs = *sut.rig.last<msg::ServoOutputRaw>();
    EXPECT_EQ(outputs.servo1_raw, 1000);
    EXPECT_EQ(outputs.servo3_raw, 1000);
    EXPECT_GT(std::max(outputs.servo2_raw, outputs.servo4_raw), 1000);
    EXPECT_TRUE(sut.rig.run_until([&] { return sut.state().relative_altitude_m < 1; }, 10));
}

TEST(InjectFailure, ChangesWhatEscsReport) {
    Bed sut;
    ASSERT_TRUE(sut.fly());
    const auto read = [&] {
        sut.command(512, {291});
        return *sut.rig.last<msg::EscStatus>();
    };
    const auto good = read();
    sut.fail(esc, wrong, 1);
    sut.fail(esc, off, 2);
    const auto bad = read();
    EXPECT_NEAR(bad.rpm[0], 10 * good.rpm[0], 200);
    EXPECT_NEAR(bad.voltage[0], good.voltage[0] / 10, 0.02);
    EXPECT_EQ(bad.rpm[1], 0);
    EXPECT_EQ(bad.voltage[1], 0);
    EXPECT_NEAR(bad.rpm[2], good.rpm[2], 200);
}

TEST(InjectFailure, FreezesOrSilencesTheRangeFinder) {
    Bed sut;
    ASSERT_TRUE(sut.fly());
    const auto read = [&] {
        sut.command(512, {132});
        return sut.rig.last<msg::DistanceSensor>();
    };
    sut.fail(range, stuck);
    const auto at_10_m = read()->current_distance;
    EXPECT_NEAR(at_10_m, 1000, 50);
    ASSERT_EQ(sut.command(21, {}), accepted);  // lands
    ASSERT_TRUE(sut.rig.run_until([&] { return sut.state().relative_altitude_m < 1; }, 60));
    EXPECT_EQ(read()->current_distance, at_10_m);
    sut.fail(range, off);
    EXPECT_FALSE(read());
    sut.fail(range, ok);
    EXPECT_LT(read()->current_distance, 150);
}

TEST(InjectFailure, EmptiesTheBatteryOnPaper) {
    Bed sut;
    sut.fail(battery, off);
    sut.command(512, {147});
    EXPECT_EQ(sut.rig.last<msg::BatteryStatus>()->battery_remaining, 0);
    EXPECT_EQ(sut.rig.last<msg::BatteryStatus>()->charge_state, 4) << "emergency";
    sut.fail(battery, ok);
    sut.command(512, {147});
    EXPECT_EQ(sut.rig.last<msg::BatteryStatus>()->battery_remaining, 100);
}

TEST(OperatorFaults, SilenceTheHeartbeatAlone) {
    Bench sut;
    ASSERT_TRUE(sut.rig.vehicle.fail({FaultPart::heartbeat, FaultKind::off}));
    sut.rig.forget();
    sut.rig.run(5.0);
    EXPECT_THAT(sut.rig.all<msg::Heartbeat>(), IsEmpty());
    EXPECT_GT(sut.rig.sink.frames.size(), 100u);
    ASSERT_TRUE(sut.rig.vehicle.fail({FaultPart::heartbeat, FaultKind::ok}));
    sut.rig.run(5.0);
    EXPECT_EQ(sut.rig.all<msg::Heartbeat>().size(), 5u);
}

TEST(OperatorFaults, SilenceTheRadioInBothDirections) {
    Bench sut;
    ASSERT_TRUE(sut.rig.vehicle.fail({FaultPart::radio, FaultKind::off}));
    sut.rig.forget();
    EXPECT_EQ(sut.arm(), none);
    sut.rig.run(5.0);
    EXPECT_THAT(sut.rig.sink.frames, IsEmpty());
    EXPECT_FALSE(sut.state().armed);
    ASSERT_TRUE(sut.rig.vehicle.fail({FaultPart::all, FaultKind::ok}));
    EXPECT_EQ(sut.arm(), accepted);
}

TEST(OperatorFaults, RestartTheSequenceNumbers) {
    Bench sut;
    sut.rig.run(1.0);
    ASSERT_TRUE(sut.rig.vehicle.fail({FaultPart::sequence, FaultKind::restart}));
    sut.rig.forget();
    sut.rig.run(1.0);
    ASSERT_GT(sut.rig.sink.frames.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(sut.rig.sink.frames[i].frame().sequence(), i);
}

TEST(OperatorFaults, ARebootInTheAirLetsTheVehicleFall) {
    Bench sut;
    ASSERT_TRUE(sut.fly());
    ASSERT_TRUE(sut.rig.vehicle.fail({FaultPart::autopilot, FaultKind::restart}));
    sut.rig.forget();
    sut.rig.run(2.0);
    EXPECT_THAT(sut.rig.sink.frames, IsEmpty()) << "it boots";
    EXPECT_TRUE(sut.rig.run_until([&] { return sut.state().altitude_m < home_altitude + 0.5; }, 10));
    sut.rig.run(3.0);
    EXPECT_FALSE(sut.state().armed);
    EXPECT_FALSE(sut.rig.all<msg::Heartbeat>().empty());
}

}  // namespace
}  // namespace mavloom::sim::test
