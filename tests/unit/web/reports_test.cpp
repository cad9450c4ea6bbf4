// SPDX-License-Identifier: MIT
#include "web/report/reports.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mavloom::web {
namespace {

using nlohmann::json;
using ::testing::Le;

constexpr ReportTime now{WallTime{std::chrono::seconds(1'700'000'000)}, MonoTime{std::chrono::seconds(100)}};

TEST(Reports, UnknownValuesAreNull) {
    observe::Vehicle vehicle{.source = {SystemId{3}, ComponentId{1}}, .type = 250};
    vehicle.heard = now.mono - std::chrono::milliseconds(1500);
    vehicle.battery = observe::Battery{.percent = 40};
    const auto one = json::parse(vehicles_json(now, {&vehicle, 1}, dialect::default_dialect()))["vehicles"][0];
    EXPECT_EQ(one["type"], "250");
    EXPECT_EQ(one["mode"], nullptr);
    EXPECT_EQ(one["age_s"], 1.5);
    EXPECT_EQ(one["battery"], json::parse(R"({"percent":40,"voltage_v":null,"current_a":null})"));
    EXPECT_EQ(one["gps"], nullptr);
    EXPECT_EQ(one["position"], nullptr);
    EXPECT_EQ(one["round_trip_ms"], json::parse(R"({"timesync":null,"ping":null,"command":null})"));
}

TEST(Reports, TextFromOutsideIsOnlyText) {
    observe::Alarm alarm{.id = 1, .link = "a\"b\n", .text = "<img onerror='x'>\xff\x01\"}"};
    const auto one = json::parse(alarms_json(now, {&alarm, 1}))["alarms"][0];
    EXPECT_EQ(one["link"], "a\"b\n");
    EXPECT_EQ(one["text"], "<img onerror='x'>\xef\xbf\xbd\x01\"}");
    EXPECT_EQ(one["sys"], nullptr);
    EXPECT_EQ(one["ended_us"], nullptr);
}

TEST(Reports, OnlyLossesThatHappenedAreNamed) {
    const observe::Hop hop{
        .name = "r",
        .kind = observe::Hop::Kind::router,
        .hz_in = 2.5,
        .hz_out = std::numeric_limits<double>::infinity(),
        .losses = {{"a", 0, "x"}, {"b", 7, "y"}},
        .links = {{.name = "l", .is_up = false}, {.name = "f.tlog", .is_up = false, .has_ended = true}}};
    const auto one = json::parse(links_json(now, {&hop, 1}))["hops"][0];
    EXPECT_EQ(one["kind"], "router");
    EXPECT_EQ(one["hz_in"], 2.5);
    EXPECT_EQ(one["hz_out"], nullptr);
    EXPECT_EQ(one["losses"], json::parse(R"([{"name":"b","count":7,"help":"y"}])"));
    EXPECT_EQ(one["links"][0]["state"], "down");
    EXPECT_EQ(one["links"][1]["state"], "ended");
}

TEST(Reports, ARowMayHaveNoSteadyRate) {
    std::vector<TrafficLine> rows(2);
    rows[0].silent_after = std::chrono::seconds(5);
    const auto all = json::parse(traffic_json(now, rows))["rows"];
    EXPECT_EQ(all[0]["silent_after_s"], 5.0);
    EXPECT_EQ(all[1]["silent_after_s"], nullptr);
}

TEST(Reports, AVehicleIsSilentAndHasNoRateUnlessItsRecordingEnded) {
    std::vector<observe::Vehicle> some(3);
    for (auto& one : some) one.hz = 80;
    some[0].heard = now.mono - std::chrono::milliseconds(4900);
    some[1].heard = some[2].heard = now.mono - std::chrono::seconds(5);
    some[2].has_ended = true;
    const auto all = json::parse(vehicles_json(now, some, dialect::default_dialect()))["vehicles"];
    EXPECT_EQ(all[0]["silent"], false);
    EXPECT_EQ(all[1]["silent"], true);
    EXPECT_EQ(all[2]["silent"], false);
    EXPECT_EQ(all[0]["hz"], 80);
    EXPECT_EQ(all[1]["hz"], 0);
    EXPECT_EQ(all[2]["hz"], 80);
}

TEST(Reports, AlarmsThatLeftAreCounted) {
    const observe::Alarm alarm{.id = 1};
    EXPECT_EQ(json::parse(alarms_json(now, {&alarm, 1}, 7))["left_out"], 7);
}

// A client's queue has 192 KiB.
TEST(Reports, AreShortEnoughForAClient) {
    const std::vector<observe::Vehicle> many(4096);
    const auto text = vehicles_json(now, many, dialect::default_dialect());
    EXPECT_THAT(text.size(), Le(170'000u));
    const auto all = json::parse(text);
    EXPECT_GT(all["vehicles"].size(), 255u);
    EXPECT_EQ(all["left_out"], many.size() - all["vehicles"].size());
}

}  // namespace
}  // namespace mavloom::web
