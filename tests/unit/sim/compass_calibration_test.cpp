// SPDX-License-Identifier: MIT
// ArduPilot's calibration of compasses, as QGroundControl, Mission Planner and MAVProxy use it. Expected answers:
// AP_Compass_Calibration.cpp of ArduPilot 4.6; status numbers: MAG_CAL_STATUS in common.xml.
#include <gmock/gmock.h>

#include "mavloom/msg/mag_cal_progress.hpp"
#include "mavloom/msg/mag_cal_report.hpp"
#include "mavloom/msg/param_value.hpp"
#include "unit/sim/bench.hpp"

namespace mavloom::sim {
namespace {

using namespace test;
using namespace std::chrono_literals;
using msg::MagCalProgress;
using msg::MagCalReport;

constexpr int start = 42424, accept = 42425, cancel = 42426, by_heading = 42006;
constexpr std::uint8_t waiting = 1, step_one = 2, step_two = 3, success = 4;
constexpr double whole = 13;  // s; longer than a calibration takes

double parameter(const Bench& bench, std::string_view name) {
    return bench.rig.vehicle.parameter(name).value_or(nan_f);
}

struct CompassCalibration : testing::Test {
    Bench bench{Autopilot::ardupilot};

    // Offsets that no calibration finds.
    CompassCalibration() {
        for (const std::string_view name : {"COMPASS_OFS_X", "COMPASS_OFS_Y", "COMPASS_OFS_Z"})
            (void)bench.rig.vehicle.set_parameter(name, 77);
    }
    double offset() const { return parameter(bench, "COMPASS_OFS_X"); }
    // Only the first compass, so that the number of compasses does not matter.
    int begin(float autosave = 0, float delay = 0) { return bench.command(start, {1, 0, autosave, delay}); }
};

TEST_F(CompassCalibration, ReportsProgressAndThenAReportUntilTheClientAccepts) {
    ASSERT_EQ(begin(), accepted);
    bench.rig.run(whole);

    const auto progress = bench.rig.all<MagCalProgress>();
    ASSERT_GT(progress.size(), 20u);
    EXPECT_EQ(progress.front().cal_status, step_one);
    EXPECT_EQ(progress.back().cal_status, step_two);
    EXPECT_EQ(progress.back().cal_mask, 1);
    EXPECT_EQ(progress.back().attempt, 1);
    EXPECT_GT(progress.back().completion_pct, 90);
    EXPECT_LT(progress.back().completion_pct, 100);
    EXPECT_TRUE(std::ranges::is_sorted(progress, {}, &MagCalProgress::completion_pct));
    EXPECT_NE(progress.back().completion_mask[8], 0);

    const auto report = bench.rig.last<MagCalReport>();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->compass_id, 0);
    EXPECT_EQ(report->cal_mask, 1);
    EXPECT_EQ(report->cal_status, success);
    EXPECT_EQ(report->autosaved, 0);
    EXPECT_NE(offset(), report->ofs_x) << "not saved yet";

    EXPECT_EQ(bench.command(accept, {1}), accepted);
    EXPECT_EQ(offset(), report->ofs_x);
    bench.rig.forget();
    bench.rig.run(2.0);
    EXPECT_FALSE(bench.rig.last<MagCalReport>());
    EXPECT_FALSE(bench.rig.last<MagCalProgress>());
}

TEST_F(CompassCalibration, SavesByItselfIfTheClientWantsIt) {
    ASSERT_EQ(begin(1), accepted);
    bench.rig.run(whole);
    ASSERT_TRUE(bench.rig.last<MagCalReport>());
    EXPECT_EQ(bench.rig.last<MagCalReport>()->autosaved, 1);
    EXPECT_EQ(offset(), bench.rig.last<MagCalReport>()->ofs_x);
    EXPECT_TRUE(bench.rig.last<msg::ParamValue>()) << "clients see the new values";
}

TEST_F(CompassCalibration, WaitsForTheDelay) {
    ASSERT_EQ(begin(0, 3), accepted);
    bench.rig.run(2.0);
    EXPECT_EQ(bench.rig.last<MagCalProgress>()->cal_status, waiting);
    EXPECT_EQ(bench.rig.last<MagCalProgress>()->completion_pct, 0);
    bench.rig.run(2.0);
    EXPECT_EQ(bench.rig.last<MagCalProgress>()->cal_status, step_one);
}

TEST_F(CompassCalibration, ACancelledOneEndsAndSavesNothing) {
    ASSERT_EQ(begin(1), accepted);
    bench.rig.run(5.0);
    EXPECT_EQ(bench.arm(), failed) << "it runs";
    EXPECT_EQ(bench.command(cancel, {0}), accepted);
    bench.rig.forget();
    bench.rig.run(whole);
    EXPECT_FALSE(bench.rig.last<MagCalProgress>());
    EXPECT_FALSE(bench.rig.last<MagCalReport>());
    EXPECT_EQ(offset(), 77);
    EXPECT_EQ(bench.command(cancel, {0}), accepted) << "also if there is nothing to cancel";
}

TEST_F(CompassCalibration, AcceptingTooEarlyFailsAndEndsIt) {
    EXPECT_EQ(bench.command(accept, {0}), accepted) << "nothing was started";
    ASSERT_EQ(begin(), accepted);
    bench.rig.run(5.0);
    EXPECT_EQ(bench.command(accept, {0}), failed);
    bench.rig.forget();
    bench.rig.run(2.0);
    EXPECT_FALSE(bench.rig.last<MagCalProgress>());
    EXPECT_EQ(offset(), 77);
}

TEST_F(CompassCalibration, MasksChooseTheCompasses) {
    EXPECT_EQ(bench.command(start, {-1}), failed);
    EXPECT_EQ(bench.command(start, {256}), failed);
    EXPECT_EQ(bench.command(start, {nan_f}), failed);
    EXPECT_EQ(bench.command(start, {8}), failed) << "there is no fourth compass";
    EXPECT_EQ(bench.command(accept, {256}), failed);
    EXPECT_EQ(bench.command(cancel, {-1}), failed);
    ASSERT_TRUE(bench.rig.vehicle.set_parameter("COMPASS_USE", 0).has_value());
    EXPECT_EQ(bench.command(start, {1}), failed) << "not in use";
    EXPECT_EQ(bench.command(start, {3}), failed) << "one of them is not in use";
    bench.rig.run(1.0);
    EXPECT_FALSE(bench.rig.last<MagCalProgress>());
    ASSERT_TRUE(bench.rig.vehicle.set_parameter("COMPASS_USE", 1).has_value());
    EXPECT_EQ(bench.command(start, {0}), accepted);
    bench.rig.run(1.0);
    EXPECT_EQ(bench.rig.last<MagCalProgress>()->cal_mask & 1, 1);
}

TEST_F(CompassCalibration, RefusesWhileArmed) {
    ASSERT_TRUE(bench.fly());
    EXPECT_EQ(begin(), failed);
    EXPECT_EQ(bench.text(), "Disarm to allow compass calibration");
}

TEST_F(CompassCalibration, RefusesWhileAnotherSensorIsCalibratedAndTheReverse) {
    constexpr int calibrate = 241;
    const auto begin_accelerometer = [&] { return bench.command(calibrate, {0, 0, 0, 0, 1}); };
    ASSERT_EQ(begin(), accepted);
    EXPECT_EQ(begin_accelerometer(), temporarily_rejected);
    ASSERT_EQ(bench.command(cancel, {1}), accepted);
    ASSERT_EQ(begin_accelerometer(), accepted);
    EXPECT_EQ(begin(), temporarily_rejected);
}

TEST_F(CompassCalibration, RebootsAtItsEndIfTheClientWantsIt) {
    ASSERT_EQ(bench.command(start, {1, 0, 1, 0, 1}), accepted);
    bench.rig.run(whole + 5);
    bench.rig.forget();
    bench.rig.run(2.0);
    EXPECT_FALSE(bench.rig.last<MagCalReport>());
    EXPECT_EQ(offset(), 5) << "the saved value stays";
}

TEST_F(CompassCalibration, AHeadingAloneIsEnough) {
    EXPECT_EQ(bench.command(by_heading, {90, 0, 0, 0}), accepted);
    EXPECT_EQ(offset(), 5);
    EXPECT_EQ(bench.command(by_heading, {nan_f, 0, 0, 0}), failed);
    EXPECT_EQ(bench.command(by_heading, {90, 300, 0, 0}), failed);
    bench.rig.run(1.0);
    EXPECT_FALSE(bench.rig.last<MagCalReport>());
}

TEST(CompassCalibrationOfPx4, DoesNotExist) {
    Bench bench;
    for (const int command : {start, accept, cancel, by_heading}) EXPECT_EQ(bench.command(command, {0}), unsupported);
}

}  // namespace
}  // namespace mavloom::sim
