// SPDX-License-Identifier: MIT
// The mission protocol as a client sees it. Expected answers: MAVLink guide, "Mission Protocol", and the session with
// PX4 in tests/data/px4_gcs_session.tlog.
#include <gmock/gmock.h>

#include <bit>
#include <cmath>
#include <limits>

#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/enums/mav_mission_result.hpp"
#include "mavloom/msg/enums/mav_mission_type.hpp"
#include "mavloom/msg/enums/mav_severity.hpp"
#include "mavloom/msg/mission_ack.hpp"
#include "mavloom/msg/mission_clear_all.hpp"
#include "mavloom/msg/mission_count.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/mission_item.hpp"
#include "mavloom/msg/mission_item_int.hpp"
#include "mavloom/msg/mission_item_reached.hpp"
#include "mavloom/msg/mission_request.hpp"
#include "mavloom/msg/mission_request_int.hpp"
#include "mavloom/msg/mission_request_list.hpp"
#include "mavloom/msg/mission_request_partial_list.hpp"
#include "mavloom/msg/mission_set_current.hpp"
#include "mavloom/msg/mission_write_partial_list.hpp"
#include "mavloom/msg/statustext.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::plan_tests {
namespace {

using namespace msg;
using test::Peer;
using test::Rig;
using testing::ElementsAre;

constexpr float not_given = std::numeric_limits<float>::quiet_NaN();
constexpr std::int32_t not_set = std::numeric_limits<std::int32_t>::max();

MissionItemInt waypoint(std::uint16_t seq, std::int32_t x = 473977430, std::int32_t y = 85455939, float z = 10) {
    return {.target_system = 1,
            .target_component = 1,
            .seq = seq,
            .frame = MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
            .command = MAV_CMD_NAV_WAYPOINT,
            .autocontinue = 1,
            .param4 = not_given,
            .x = x,
            .y = y,
            .z = z};
}

// The plan that a ground station uploaded in the recorded session.
std::vector<MissionItemInt> recorded_plan() {
    std::vector<MissionItemInt> items{waypoint(0),
                                      waypoint(1, 473979229, 85455939, 12),
                                      waypoint(2, 0, 0, 0),
                                      waypoint(3, 473979229, 85458596, 15),
                                      waypoint(4, 473977430, 85458596, 12),
                                      waypoint(5, 473977610, 85456205, 0)};
    items[0].command = MAV_CMD_NAV_TAKEOFF;
    items[0].current = 1;
    for (const std::size_t i : {1u, 3u, 4u}) items[i].param2 = 2;
    items[2].frame = MAV_FRAME_MISSION;
    items[2].command = MAV_CMD_DO_CHANGE_SPEED;
    items[2].param1 = 1;
    items[2].param2 = 4;
    items[2].param3 = -1;
    items[2].param4 = 0;
    items[3].param1 = 3;
    items[5].command = MAV_CMD_NAV_LAND;
    return items;
}
constexpr std::uint32_t recorded_plan_id = 1102882919;  // what PX4 answered

class PlanService : public testing::Test {
protected:
    explicit PlanService(const VehicleOptions& options = {}) : rig(options) {}
    void announce(std::uint16_t count, std::uint8_t type = MAV_MISSION_TYPE_MISSION, const Peer& peer = {}) {
        rig.send(MissionCount{.target_system = 1, .target_component = 1, .count = count, .mission_type = type}, peer);
    }
    void upload(std::vector<MissionItemInt> items, std::uint8_t type = MAV_MISSION_TYPE_MISSION, const Peer& peer = {}) {
        announce(static_cast<std::uint16_t>(items.size()), type, peer);
        for (MissionItemInt& item : items) {
            item.mission_type = type;
            rig.send(item, peer);
        }
    }
    void request_list(std::uint8_t type = MAV_MISSION_TYPE_MISSION, const Peer& peer = {}) {
        rig.send(MissionRequestList{.target_system = 1, .target_component = 1, .mission_type = type}, peer);
    }
    void request(std::uint16_t seq, std::uint8_t type = MAV_MISSION_TYPE_MISSION, const Peer& peer = {}) {
        rig.send(MissionRequestInt{.target_system = 1, .target_component = 1, .seq = seq, .mission_type = type}, peer);
    }
    std::uint8_t last_result(LinkId link = LinkId{1}) {
        const auto ack = rig.last<MissionAck>(link);
        return ack ? ack->type : 255;
    }
    bool has_sync_text() {
        return std::ranges::any_of(rig.all<Statustext>(), [](const Statustext& message) {
            return std::string_view(message.text.data()).starts_with("Mission sync timeout");
        });
    }
    std::uint16_t count(std::uint8_t type = MAV_MISSION_TYPE_MISSION) {
        request_list(type);
        const auto message = rig.last<MissionCount>();
        rig.send(MissionAck{.target_system = 1, .target_component = 1, .mission_type = type});
        return message ? message->count : 9999;
    }

    Rig rig;
};

// --- Upload

TEST_F(PlanService, AsksForEachItemInOrderAndAcknowledgesTheLastWithTheIdThatPx4Computed) {
    const auto plan = recorded_plan();

    announce(6);
    for (std::uint16_t seq = 0; seq < 6; ++seq) {
        const auto asked = rig.last<MissionRequestInt>();
        ASSERT_TRUE(asked);
        EXPECT_EQ(asked->seq, seq);
        EXPECT_EQ(asked->target_system, 255);
        EXPECT_EQ(asked->target_component, 190);
        EXPECT_FALSE(rig.last<MissionAck>());
        rig.send(plan[seq]);
    }

    const auto ack = rig.last<MissionAck>();
    ASSERT_TRUE(ack);
    EXPECT_EQ(ack->type, MAV_MISSION_ACCEPTED);
    EXPECT_EQ(ack->opaque_id, recorded_plan_id);
    EXPECT_EQ(rig.all<MissionRequestInt>().size(), 6u);
    EXPECT_EQ(rig.all<MissionAck>().size(), 1u);
}

TEST_F(PlanService, ARebootEndsAnUpload) {
    announce(6);
    rig.send(msg::CommandLong{.target_system = 1, .target_component = 1, .command = 246, .param1 = 1});
    rig.run(2.6);
    rig.forget();
    rig.run(3.0);
    EXPECT_FALSE(rig.last<MissionRequestInt>());
}

TEST_F(PlanService, ReturnsItemsBitByBit) {
    auto plan = recorded_plan();
    plan[1].x = not_set;
    plan[1].y = std::numeric_limits<std::int32_t>::min();
    plan[1].autocontinue = 0;
    plan[3].param4 = std::bit_cast<float>(0x7fc12345u);  // a NaN with a payload
    upload(plan);
    ASSERT_EQ(last_result(), MAV_MISSION_ACCEPTED);

    request_list();
    ASSERT_TRUE(rig.last<MissionCount>());
    EXPECT_EQ(rig.last<MissionCount>()->count, 6);
    EXPECT_EQ(rig.last<MissionCount>()->opaque_id, rig.last<MissionAck>()->opaque_id);

    for (const MissionItemInt& item : plan) {
        request(item.seq);
        auto got = rig.last<MissionItemInt>();
        ASSERT_TRUE(got);
        EXPECT_EQ(got->target_system, 255);
        EXPECT_EQ(got->current, item.seq == 0 ? 1 : 0);
        got->target_system = got->target_component = 1;
        std::array<std::uint8_t, MissionItemInt::max_length> a, b;
        got->encode(a);
        item.encode(b);
        EXPECT_THAT(a, testing::ElementsAreArray(b)) << item.seq;
    }
}

TEST_F(PlanService, RepeatsItsRequestEvery250MillisecondsAndGivesUpAfterFiveSeconds) {
    upload(recorded_plan());
    rig.forget();

    announce(3);
    rig.run(0.24);
    EXPECT_EQ(rig.all<MissionRequestInt>().size(), 1u);
    rig.run(0.02);
    EXPECT_EQ(rig.all<MissionRequestInt>().size(), 2u);
    rig.send(waypoint(0));
    rig.run(4.9);
    EXPECT_FALSE(rig.last<MissionAck>());
    EXPECT_EQ(rig.last<MissionRequestInt>()->seq, 1);
    EXPECT_THAT(rig.all<MissionRequestInt>().size(), testing::AllOf(testing::Ge(20u), testing::Le(24u)));
    rig.run(0.2);

    EXPECT_EQ(last_result(), MAV_MISSION_OPERATION_CANCELLED);
    EXPECT_TRUE(has_sync_text());
    rig.forget();
    rig.run(2.0);
    EXPECT_FALSE(rig.last<MissionRequestInt>());
    EXPECT_EQ(count(), 6) << "the old plan stays";
}

TEST_F(PlanService, TimeOutsRunInRealTime) {
    announce(3);
    rig.forget();

    rig.flight += std::chrono::seconds{60};  // a minute of flight in one second
    rig.vehicle.advance({.flight = rig.flight, .real = MonoTime{std::chrono::seconds{1}}});

    EXPECT_FALSE(rig.last<MissionAck>());
    EXPECT_LE(rig.all<MissionRequestInt>().size(), 4u);
}

TEST_F(PlanService, RefusesASecondUploaderUntilTheFirstFellSilent) {
    const Peer other{LinkId{1}, {SystemId{245}, ComponentId{190}}};
    announce(3);

    announce(2, MAV_MISSION_TYPE_MISSION, other);
    EXPECT_EQ(last_result(), MAV_MISSION_ERROR);
    EXPECT_EQ(rig.last<MissionAck>()->target_system, 245);
    announce(3, MAV_MISSION_TYPE_FENCE, other);
    EXPECT_EQ(rig.last<MissionRequestInt>()->mission_type, MAV_MISSION_TYPE_FENCE) << "other types are free";
    rig.run(5.1);
    rig.forget();
    upload({waypoint(0), waypoint(1)}, MAV_MISSION_TYPE_MISSION, other);

    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    EXPECT_EQ(rig.last<MissionAck>()->target_system, 245);
}

TEST_F(PlanService, FreesAnUploadWhenItsLinkCloses) {
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    announce(3, MAV_MISSION_TYPE_MISSION, {LinkId{2}});
    rig.vehicle.close(LinkId{2});

    upload({waypoint(0)});

    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
}

TEST_F(PlanService, AnswersADuplicateOfTheLastItemAgain) {
    upload({waypoint(0), waypoint(1)});
    const auto first = rig.last<MissionAck>();
    rig.forget();

    rig.send(waypoint(1));

    ASSERT_TRUE(rig.last<MissionAck>());
    EXPECT_EQ(*rig.last<MissionAck>(), *first);
    for (int i = 0; i < 3; ++i) {  // the answers are lost again
        rig.run(3);
        rig.send(waypoint(1));
        EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    }
    rig.run(5.1);
    rig.send(waypoint(1));
    EXPECT_EQ(last_result(), MAV_MISSION_ERROR) << "there is no upload any more";
}

TEST_F(PlanService, IgnoresItemsThatItDidNotAskForAsPx4Does) {
    announce(3);
    rig.send(waypoint(1));
    rig.send(waypoint(0));
    rig.send(waypoint(0));
    rig.send(waypoint(1));
    rig.send(waypoint(2));

    EXPECT_THAT(rig.all<MissionAck>(), ElementsAre(testing::Field(&MissionAck::type, MAV_MISSION_ACCEPTED)));
}

TEST_F(PlanService, StartsAgainWhenTheSameClientAnnouncesAgain) {
    announce(5);
    rig.send(waypoint(0));
    rig.send(waypoint(1));

    upload({waypoint(0, 100), waypoint(1, 200)});

    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    request(0);
    EXPECT_EQ(rig.last<MissionItemInt>()->x, 100);
}

TEST_F(PlanService, EndsAnUploadThatTheClientCancels) {
    announce(3);
    rig.send(MissionAck{.target_system = 1, .target_component = 1, .type = MAV_MISSION_OPERATION_CANCELLED});
    rig.forget();
    rig.run(1.0);

    EXPECT_FALSE(rig.last<MissionRequestInt>());
}

TEST_F(PlanService, AsksByMissionRequestAfterTheClientRefusedTheIntegerForm) {
    announce(2);
    rig.send(MissionAck{.target_system = 1, .target_component = 1, .type = MAV_MISSION_UNSUPPORTED});
    ASSERT_TRUE(rig.last<MissionRequest>());
    EXPECT_EQ(rig.last<MissionRequest>()->seq, 0);

    for (std::uint16_t seq = 0; seq < 2; ++seq)
        rig.send(MissionItem{.target_system = 1,
                             .target_component = 1,
                             .seq = seq,
                             .frame = MAV_FRAME_GLOBAL_RELATIVE_ALT,
                             .command = MAV_CMD_NAV_WAYPOINT,
                             .autocontinue = 1,
                             .x = 47.5f,
                             .y = -8.25f,
                             .z = 30});

    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    request(1);
    EXPECT_EQ(rig.last<MissionItemInt>()->x, 475000000);
    EXPECT_EQ(rig.last<MissionItemInt>()->y, -82500000);
    EXPECT_EQ(rig.last<MissionItemInt>()->frame, MAV_FRAME_GLOBAL_RELATIVE_ALT_INT) << "PX4's variant for this message";
}

TEST_F(PlanService, GivesUpOnAClientThatRefusesBothForms) {
    announce(2);
    for (int i = 0; i < 100; ++i)
        rig.send(MissionAck{.target_system = 1, .target_component = 1, .type = MAV_MISSION_UNSUPPORTED});
    EXPECT_EQ(rig.all<MissionRequest>().size(), 1u);
    EXPECT_EQ(rig.all<MissionRequestInt>().size(), 1u);
    for (int i = 0; i < 60; ++i) {
        rig.send(MissionAck{.target_system = 1, .target_component = 1, .type = MAV_MISSION_UNSUPPORTED});
        rig.run(0.1);
    }
    EXPECT_EQ(last_result(), MAV_MISSION_OPERATION_CANCELLED);
    EXPECT_LE(rig.all<MissionRequest>().size() + rig.all<MissionRequestInt>().size(), 2u + 5 * 4);
}

// DroneKit does not know MISSION_REQUEST_INT.
TEST_F(PlanService, TriesMissionRequestWithAClientThatDoesNotAnswer) {
    announce(2);
    rig.run(0.9);
    EXPECT_EQ(rig.all<MissionRequestInt>().size(), 4u);
    EXPECT_FALSE(rig.last<MissionRequest>());
    rig.run(0.2);
    ASSERT_TRUE(rig.last<MissionRequest>());
    EXPECT_EQ(rig.last<MissionRequest>()->seq, 0);

    rig.forget();
    rig.send(MissionItem{.target_system = 1,
                         .target_component = 1,
                         .frame = MAV_FRAME_GLOBAL_RELATIVE_ALT,
                         .command = MAV_CMD_NAV_WAYPOINT,
                         .x = 47.5f,
                         .y = 8.5f,
                         .z = 10});
    ASSERT_TRUE(rig.last<MissionRequest>()) << "the form that the client speaks";
    EXPECT_EQ(rig.last<MissionRequest>()->seq, 1);
    EXPECT_FALSE(rig.last<MissionRequestInt>());
}

TEST_F(PlanService, ReportsAnItemThatBelongsToNoTransfer) {
    rig.send(waypoint(0));
    EXPECT_EQ(last_result(), MAV_MISSION_ERROR);
    ASSERT_TRUE(rig.last<Statustext>());
    EXPECT_STREQ(rig.last<Statustext>()->text.data(), "IGN MISSION_ITEM: No transfer");
}

TEST_F(PlanService, TextsAboutMessagesThatDoNotFitComeOnceASecondAtMost) {
    rig.run(3.0);
    rig.forget();
    for (int i = 0; i < 25; ++i) {
        rig.send(waypoint(0));
        rig.send(MissionSetCurrent{.target_system = 1, .target_component = 1, .seq = 7});
        rig.run(0.1);
    }
    EXPECT_EQ(rig.all<Statustext>().size(), 3u);
    EXPECT_EQ(rig.all<MissionAck>().size(), 25u) << "the answers all come";
}

TEST_F(PlanService, FloatDegreesComeBackUnchanged) {
    const std::array<float, 6> degrees{47.397742f, -33.856784f, 1.0000001f, 89.99999f, -47.39774f, not_given};
    announce(static_cast<std::uint16_t>(degrees.size()));
    for (std::uint16_t seq = 0; seq < degrees.size(); ++seq)
        rig.send(MissionItem{.target_system = 1,
                             .target_component = 1,
                             .seq = seq,
                             .frame = MAV_FRAME_GLOBAL,
                             .command = MAV_CMD_NAV_LOITER_UNLIM,
                             .x = degrees[seq],
                             .y = 2 * degrees[seq],
                             .z = 1});
    ASSERT_EQ(last_result(), MAV_MISSION_ACCEPTED);

    for (std::uint16_t seq = 0; seq < degrees.size(); ++seq) {
        rig.send(MissionRequest{.target_system = 1, .target_component = 1, .seq = seq});
        const auto got = rig.last<MissionItem>();
        ASSERT_TRUE(got);
        EXPECT_THAT(got->x, testing::NanSensitiveFloatEq(degrees[seq])) << seq;
        EXPECT_THAT(got->y, testing::NanSensitiveFloatEq(2 * degrees[seq])) << seq;
        EXPECT_EQ(got->frame, MAV_FRAME_GLOBAL);
    }
}

TEST_F(PlanService, ItemsWithoutAPlaceKeepPlainNumbersInXAndY) {
    announce(1);
    rig.send(MissionItem{.target_system = 1,
                         .target_component = 1,
                         .frame = MAV_FRAME_MISSION,
                         .command = MAV_CMD_DO_SET_ACTUATOR,
                         .x = 7,
                         .y = -3});

    request(0);
    EXPECT_EQ(rig.last<MissionItemInt>()->x, 7);
    EXPECT_EQ(rig.last<MissionItemInt>()->y, -3);
}

struct Refusal {
    const char* name;
    std::uint8_t type;
    std::uint8_t result;
    void (*spoil)(MissionItemInt& item);
};

class PlanServiceRefuses : public PlanService, public testing::WithParamInterface<Refusal> {};

TEST_P(PlanServiceRefuses, TheItemAndKeepsTheOldPlan) {
    const Refusal& refusal = GetParam();
    auto fence = waypoint(0);
    fence.command = MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION;
    fence.param1 = 50;
    auto rally = waypoint(0);
    rally.command = MAV_CMD_NAV_RALLY_POINT;
    const std::array first{waypoint(0), fence, rally};
    upload({first[refusal.type]}, refusal.type);
    ASSERT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    auto bad = first[refusal.type];
    bad.seq = 1;
    bad.mission_type = refusal.type;
    refusal.spoil(bad);

    announce(2, refusal.type);
    auto good = first[refusal.type];
    good.mission_type = refusal.type;
    rig.send(good);
    rig.send(bad);

    EXPECT_EQ(last_result(), refusal.result);
    rig.forget();
    rig.run(1.0);
    EXPECT_FALSE(rig.last<MissionRequestInt>()) << "the upload is over";
    EXPECT_EQ(count(refusal.type), 1);
}

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr std::uint8_t mission = MAV_MISSION_TYPE_MISSION, fence = MAV_MISSION_TYPE_FENCE,
                       rally = MAV_MISSION_TYPE_RALLY;
using Item = MissionItemInt;

INSTANTIATE_TEST_SUITE_P(
    Items, PlanServiceRefuses,
    testing::Values(
        Refusal{"UnknownCommand", mission, MAV_MISSION_UNSUPPORTED, [](Item& i) { i.command = 31999; }},
        Refusal{"ArduPilotsCommand", mission, MAV_MISSION_UNSUPPORTED,
                [](Item& i) { i.command = MAV_CMD_CONDITION_YAW; }},
        Refusal{"FenceInAMission", mission, MAV_MISSION_UNSUPPORTED, [](Item& i) { i.command = 5003; }},
        Refusal{"WaypointInAFence", fence, MAV_MISSION_UNSUPPORTED, [](Item& i) { i.command = 16; }},
        Refusal{"FenceInRally", rally, MAV_MISSION_UNSUPPORTED, [](Item& i) { i.command = 5003; }},
        Refusal{"LocalFrame", mission, MAV_MISSION_UNSUPPORTED_FRAME, [](Item& i) { i.frame = MAV_FRAME_LOCAL_NED; }},
        Refusal{"UnknownFrame", mission, MAV_MISSION_UNSUPPORTED_FRAME, [](Item& i) { i.frame = 255; }},
        Refusal{"WaypointWithoutPlace", mission, MAV_MISSION_UNSUPPORTED_FRAME, [](Item& i) { i.frame = 2; }},
        Refusal{"FenceWithoutPlace", fence, MAV_MISSION_UNSUPPORTED_FRAME, [](Item& i) { i.frame = 2; }},
        Refusal{"InfiniteParam1", mission, MAV_MISSION_INVALID_PARAM1, [](Item& i) { i.param1 = infinite; }},
        Refusal{"InfiniteParam2", mission, MAV_MISSION_INVALID_PARAM2, [](Item& i) { i.param2 = -infinite; }},
        Refusal{"InfiniteParam3", mission, MAV_MISSION_INVALID_PARAM3, [](Item& i) { i.param3 = infinite; }},
        Refusal{"InfiniteParam4", mission, MAV_MISSION_INVALID_PARAM4, [](Item& i) { i.param4 = infinite; }},
        Refusal{"Latitude", mission, MAV_MISSION_INVALID_PARAM5_X, [](Item& i) { i.x = 900000001; }},
        Refusal{"Longitude", mission, MAV_MISSION_INVALID_PARAM6_Y, [](Item& i) { i.y = -1800000001; }},
        Refusal{"NoHeight", mission, MAV_MISSION_INVALID_PARAM7, [](Item& i) { i.z = not_given; }},
        Refusal{"InfiniteHeight", mission, MAV_MISSION_INVALID_PARAM7, [](Item& i) { i.z = infinite; }},
        Refusal{"RallyWithoutLatitude", rally, MAV_MISSION_INVALID_PARAM5_X, [](Item& i) { i.x = not_set; }},
        Refusal{"CircleWithoutRadius", fence, MAV_MISSION_INVALID_PARAM1, [](Item& i) { i.param1 = 0; }},
        Refusal{"CircleOfNan", fence, MAV_MISSION_INVALID_PARAM1, [](Item& i) { i.param1 = not_given; }},
        Refusal{"TwoVertices", fence, MAV_MISSION_ERROR,
                [](Item& i) {
                    i.command = 5001;
                    i.param1 = 2;
                }},
        Refusal{"JumpBeyondTheEnd", mission, MAV_MISSION_INVALID_PARAM1,
                [](Item& i) {
                    i.command = 177;
                    i.param1 = 2;
                }},
        Refusal{"JumpToNan", mission, MAV_MISSION_INVALID_PARAM1,
                [](Item& i) {
                    i.command = 177;
                    i.param1 = not_given;
                }},
        Refusal{"SpeedOfUnknownKind", mission, MAV_MISSION_INVALID_PARAM1,
                [](Item& i) {
                    i.command = 178;
                    i.param1 = 4;
                }}),
    [](const auto& test) { return test.param.name; });

TEST_F(PlanService, AcceptsWhatMavsdkAndQGroundControlUpload) {
    // NAV_DELAY, gimbal, camera, RTL in MAV_FRAME_MISSION; a speed item whose z is NaN; take-off at 0/0 means "here".
    std::vector<MissionItemInt> items;
    for (const std::uint16_t command : std::initializer_list<std::uint16_t>{22, 178, 93, 1000, 1001, 2000, 2001, 2500,
                                                                            2501, 206, 530, 195, 197, 21, 20, 18}) {
        auto item = waypoint(static_cast<std::uint16_t>(items.size()), 0, 0);
        item.command = command;
        if (command != 18 && command != 22) {
            item.frame = MAV_FRAME_MISSION;
            item.z = not_given;
        }
        items.push_back(item);
    }

    upload(items);

    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    EXPECT_EQ(count(), items.size());
}

TEST_F(PlanService, RefusesMoreItemsThanItHasRoomFor) {
    const Limits limits;
    const std::array most{limits.mission_items, limits.fence_items, limits.rally_items};
    for (std::uint8_t type = 0; type < 3; ++type) {
        announce(static_cast<std::uint16_t>(most[type] + 1), type);
        EXPECT_EQ(last_result(), MAV_MISSION_NO_SPACE);
        EXPECT_FALSE(rig.last<MissionRequestInt>());
        announce(static_cast<std::uint16_t>(most[type]), type);
        EXPECT_TRUE(rig.last<MissionRequestInt>());
        rig.forget();
    }
    announce(65535);
    EXPECT_EQ(last_result(), MAV_MISSION_NO_SPACE);
}

TEST_F(PlanService, LimitsHowManyClientsTransfer) {
    VehicleOptions options;
    options.limits.clients = 2;
    Rig small(options);
    const auto count_from = [&](std::uint8_t system, std::uint8_t type) {
        small.send(MissionCount{.target_system = 1, .target_component = 1, .count = 2, .mission_type = type},
                   Peer{LinkId{1}, {SystemId{system}, ComponentId{1}}});
    };
    count_from(201, 0);
    count_from(202, 1);
    count_from(203, 2);

    EXPECT_EQ(small.last<MissionAck>()->type, MAV_MISSION_ERROR);
    EXPECT_EQ(small.last<MissionAck>()->target_system, 203);
}

TEST_F(PlanService, AClientWithManyIdsKeepsNoOtherLinkOut) {
    upload(recorded_plan());
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    const MissionRequestList request{.target_system = 1, .target_component = 1};
    for (int i = 0; i < 100; ++i)
        rig.send(request, Peer{LinkId{1}, {SystemId{static_cast<std::uint8_t>(100 + i)}, ComponentId{1}}});
    ASSERT_EQ(last_result(), MAV_MISSION_ERROR);

    rig.send(request, Peer{LinkId{2}, {SystemId{255}, ComponentId{190}}});

    ASSERT_TRUE(rig.last<MissionCount>(LinkId{2}));
    EXPECT_EQ(rig.last<MissionCount>(LinkId{2})->count, recorded_plan().size());
}

TEST_F(PlanService, ACountOfZeroClears) {
    upload(recorded_plan());

    announce(0);

    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    EXPECT_EQ(rig.last<MissionAck>()->opaque_id, 0u);
    EXPECT_EQ(count(), 0);
}

// --- Download

TEST_F(PlanService, AnswersRequestsInAnyOrderWithoutAnAcknowledgementAtTheEnd) {
    upload(recorded_plan());
    rig.forget();

    request_list();
    for (const std::uint16_t seq : std::initializer_list<std::uint16_t>{4, 0, 5, 5, 2}) request(seq);

    std::vector<std::uint16_t> got;
    for (const auto& item : rig.all<MissionItemInt>()) got.push_back(item.seq);
    EXPECT_THAT(got, ElementsAre(4, 0, 5, 5, 2));
    rig.run(6.0);
    EXPECT_FALSE(has_sync_text());
    upload({waypoint(0)});
    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
}

TEST_F(PlanService, RepeatsTheCountUntilTheFirstRequest) {
    upload(recorded_plan());
    rig.forget();

    request_list();
    rig.run(0.6);
    EXPECT_EQ(rig.all<MissionCount>().size(), 3u);
    request(0);
    rig.run(1.0);
    EXPECT_EQ(rig.all<MissionCount>().size(), 3u);

    request_list();
    rig.forget();
    rig.run(20.0);
    EXPECT_LE(rig.all<MissionCount>().size(), 20u) << "it ends after 5 s";
    EXPECT_FALSE(rig.last<MissionAck>());
}

TEST_F(PlanService, RefusesARequestBeyondTheEnd) {
    upload(recorded_plan());
    request_list();

    request(6);

    EXPECT_EQ(last_result(), MAV_MISSION_INVALID_SEQUENCE);
    request(65535);
    EXPECT_EQ(last_result(), MAV_MISSION_INVALID_SEQUENCE);
    EXPECT_FALSE(rig.last<MissionItemInt>());
}

TEST_F(PlanService, EndsADownloadWhenAnotherClientReplacesThePlan) {
    const Peer other{LinkId{1}, {SystemId{245}, ComponentId{190}}};
    upload(recorded_plan());
    request_list();
    request(0);

    upload({waypoint(0, 1), waypoint(1, 2)}, MAV_MISSION_TYPE_MISSION, other);
    rig.forget();
    request(1);

    EXPECT_EQ(last_result(), MAV_MISSION_ERROR);
    EXPECT_FALSE(rig.last<MissionItemInt>());
}

TEST_F(PlanService, ServesClientsAndTypesSideBySide) {
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    const Peer other{LinkId{2}, {SystemId{245}, ComponentId{190}}};
    upload(recorded_plan());
    auto point = waypoint(0);
    point.command = MAV_CMD_NAV_RALLY_POINT;
    upload({point}, rally);

    request_list();
    request_list(mission, other);
    request_list(rally, other);
    request(2);
    request(0, rally, other);
    request(3, mission, other);

    EXPECT_EQ(rig.last<MissionItemInt>()->seq, 2);
    const auto items = rig.all<MissionItemInt>(LinkId{2});
    ASSERT_EQ(items.size(), 2u);
    EXPECT_EQ(items[0].mission_type, rally);
    EXPECT_EQ(items[1].seq, 3);
    EXPECT_EQ(items[1].target_system, 245);
}

// --- Other messages

TEST_F(PlanService, ClearsOneTypeOrAll) {
    auto circle = waypoint(0);
    circle.command = MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION;
    circle.param1 = 20;
    auto point = waypoint(0);
    point.command = MAV_CMD_NAV_RALLY_POINT;
    const auto fill = [&] {
        upload({waypoint(0)});
        upload({circle}, fence);
        upload({point}, rally);
    };
    for (std::uint8_t type = 0; type < 3; ++type) {
        fill();
        rig.send(MissionClearAll{.target_system = 1, .target_component = 1, .mission_type = type});
        EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
        EXPECT_EQ(rig.last<MissionAck>()->mission_type, type);
        for (std::uint8_t other = 0; other < 3; ++other) EXPECT_EQ(count(other), other == type ? 0 : 1);
    }
    fill();
    rig.send(MissionClearAll{.target_system = 1, .target_component = 1, .mission_type = MAV_MISSION_TYPE_ALL});
    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    EXPECT_EQ(rig.last<MissionAck>()->mission_type, MAV_MISSION_TYPE_ALL);
    for (std::uint8_t type = 0; type < 3; ++type) EXPECT_EQ(count(type), 0);
}

TEST_F(PlanService, DoesNotClearWhatAnotherClientUploads) {
    upload({waypoint(0)});
    announce(3, mission, {LinkId{1}, {SystemId{245}, ComponentId{190}}});

    rig.send(MissionClearAll{.target_system = 1, .target_component = 1, .mission_type = MAV_MISSION_TYPE_ALL});

    EXPECT_EQ(last_result(), MAV_MISSION_ERROR);
    EXPECT_EQ(count(), 1);
}

TEST_F(PlanService, RefusesTypesThatItDoesNotKnow) {
    for (const std::uint8_t type : std::initializer_list<std::uint8_t>{3, 7, 254}) {
        const auto refused = [&] { return last_result() == MAV_MISSION_UNSUPPORTED; };
        announce(2, type);
        EXPECT_TRUE(refused());
        rig.forget();
        request_list(type);
        EXPECT_TRUE(refused());
        rig.forget();
        request(0, type);
        EXPECT_TRUE(refused());
        rig.forget();
        rig.send(MissionClearAll{.target_system = 1, .target_component = 1, .mission_type = type});
        EXPECT_TRUE(refused());
        EXPECT_EQ(rig.last<MissionAck>()->mission_type, type);
        rig.forget();
    }
}

TEST_F(PlanService, RefusesPartialLists) {
    upload(recorded_plan());

    rig.send(MissionWritePartialList{.target_system = 1, .target_component = 1, .start_index = 0, .end_index = 1});
    EXPECT_EQ(last_result(), MAV_MISSION_UNSUPPORTED);
    rig.forget();
    rig.send(MissionRequestPartialList{.target_system = 1, .target_component = 1, .start_index = 0, .end_index = 1});
    EXPECT_EQ(last_result(), MAV_MISSION_UNSUPPORTED);
}

TEST_F(PlanService, EqualPlansHaveEqualIds) {
    upload(recorded_plan());
    const auto first = rig.last<MissionAck>()->opaque_id;
    auto changed = recorded_plan();
    changed[5].z = 1;
    upload(changed);
    EXPECT_NE(rig.last<MissionAck>()->opaque_id, first);

    upload(recorded_plan());
    EXPECT_EQ(rig.last<MissionAck>()->opaque_id, first);
}

// --- Flight

TEST_F(PlanService, SetsTheCurrentItemAndReportsItAtOnce) {
    upload(recorded_plan());
    rig.run(0.1);
    rig.forget();

    rig.send(MissionSetCurrent{.target_system = 1, .target_component = 1, .seq = 99});

    EXPECT_FALSE(rig.last<MissionAck>()) << "clients would take it for the end of a transfer";
    EXPECT_TRUE(rig.last<MissionCurrent>());
}

TEST_F(PlanService, ReportsANewPlanAtOnce) {
    rig.run(0.5);
    rig.forget();
    upload(recorded_plan());

    ASSERT_TRUE(rig.last<MissionCurrent>());
    EXPECT_EQ(rig.last<MissionCurrent>()->mission_id, recorded_plan_id);
    EXPECT_EQ(rig.last<MissionCurrent>()->total, 6);
    rig.send(MissionClearAll{.target_system = 1, .target_component = 1});
    EXPECT_EQ(rig.last<MissionCurrent>()->mission_id, 0u);
}

TEST_F(PlanService, BeginsWithTheItemThatTheClientMarked) {
    auto plan = recorded_plan();
    plan[0].current = 0;
    plan[3].current = 1;
    upload(plan);

    request(3);
    EXPECT_EQ(rig.last<MissionItemInt>()->current, 1);
    request(0);
    EXPECT_EQ(rig.last<MissionItemInt>()->current, 0);
}

TEST_F(PlanService, RepeatsTheItemThatWasReachedTenTimesASecondApart) {
    rig.run(4.0);
    std::vector<MissionItemInt> plan{waypoint(0), waypoint(1)};
    plan[0].command = MAV_CMD_NAV_TAKEOFF;
    plan[1].command = MAV_CMD_NAV_LOITER_UNLIM;
    upload(plan);
    ASSERT_TRUE(rig.vehicle.set_mode("Mission"));
    ASSERT_TRUE(rig.vehicle.arm(false));
    ASSERT_TRUE(rig.run_until([&] { return rig.last<MissionItemReached>().has_value(); }, 60));
    rig.run(30.0);

    std::vector<FlightTime> times;
    for (const auto& sent : rig.sink.frames)
        if (sent.frame().id() == MissionItemReached::id && MissionItemReached::decode(sent.frame().payload()).seq == 0)
            times.push_back(sent.at);
    ASSERT_EQ(times.size(), 11u);
    for (std::size_t i = 1; i < times.size(); ++i)
        EXPECT_NEAR(static_cast<double>((times[i] - times[i - 1]).count()), 1e9, 3e7);
}

// --- ArduPilot

class ArduPilotPlanService : public PlanService {
protected:
    static VehicleOptions ardupilot() {
        VehicleOptions options;
        options.autopilot = Autopilot::ardupilot;
        return options;
    }
    ArduPilotPlanService() : PlanService(ardupilot()) { rig.run(5.0); }
};

// The texts of ArduPilot 4.6, MissionItemProtocol_Waypoints and _Rally.
TEST_F(ArduPilotPlanService, AnnouncesThatAPlanWasReceived) {
    const auto was_said = [&](std::string_view text) {
        return std::ranges::any_of(rig.all<Statustext>(), [&](const Statustext& message) {
            return std::string_view(message.text.data()) == text && message.severity == MAV_SEVERITY_INFO;
        });
    };
    upload({waypoint(0, 473977430, 85455930, 0), waypoint(1, 473979229, 85455930, 10)});
    EXPECT_TRUE(was_said("Flight plan received"));
    EXPECT_FALSE(was_said("Rally points received"));
    rig.forget();
    MissionItemInt point = waypoint(0, 473979229, 85455930, 10);
    point.command = MAV_CMD_NAV_RALLY_POINT;
    upload({point}, MAV_MISSION_TYPE_RALLY);
    EXPECT_TRUE(was_said("Rally points received"));
    EXPECT_FALSE(was_said("Flight plan received"));
}

TEST_F(ArduPilotPlanService, ReturnsHomeAsItemZero) {
    upload({waypoint(0, 1, 2, 3), waypoint(1), waypoint(2)});
    ASSERT_EQ(last_result(), MAV_MISSION_ACCEPTED);

    request_list();
    EXPECT_EQ(rig.last<MissionCount>()->count, 3);
    request(0);
    const auto item = rig.last<MissionItemInt>();
    EXPECT_EQ(item->command, MAV_CMD_NAV_WAYPOINT);
    EXPECT_EQ(item->frame, MAV_FRAME_GLOBAL);
    EXPECT_NEAR(item->x, 473977420, 100);
    EXPECT_NEAR(item->y, 85455940, 100);
    EXPECT_NEAR(item->z, 489.4, 1);
    request(1);
    EXPECT_EQ(rig.last<MissionItemInt>()->frame, MAV_FRAME_GLOBAL_RELATIVE_ALT) << "the variant of MISSION_ITEM";
}

// ArduPilot asks by MISSION_REQUEST only, whatever the client answers, and repeats that once a second for 8 s.
TEST_F(ArduPilotPlanService, AsksByMissionRequest) {
    announce(3);
    rig.send(MissionAck{.target_system = 1, .target_component = 1, .type = MAV_MISSION_UNSUPPORTED});
    rig.send(waypoint(0));
    rig.send(MissionItem{.target_system = 1,
                         .target_component = 1,
                         .seq = 1,
                         .frame = MAV_FRAME_GLOBAL_RELATIVE_ALT,
                         .command = MAV_CMD_NAV_WAYPOINT,
                         .x = 47.5f,
                         .y = 8.5f,
                         .z = 10});
    EXPECT_THAT(rig.all<MissionRequest>(),
                ElementsAre(testing::Field(&MissionRequest::seq, 0), testing::Field(&MissionRequest::seq, 1),
                            testing::Field(&MissionRequest::seq, 2)));
    EXPECT_FALSE(rig.last<MissionRequestInt>());

    rig.forget();
    rig.run(3.5);
    EXPECT_EQ(rig.all<MissionRequest>().size(), 3u);
    EXPECT_EQ(last_result(), 255);
    rig.run(5.0);
    EXPECT_EQ(last_result(), MAV_MISSION_OPERATION_CANCELLED);
}

// DroneKit waits for it after each download of a mission.
TEST_F(ArduPilotPlanService, ReturnsHomeWithoutAMission) {
    EXPECT_EQ(count(), 0);
    rig.send(MissionRequest{.target_system = 1, .target_component = 1, .seq = 0});
    const auto item = rig.last<MissionItem>();
    ASSERT_TRUE(item);
    EXPECT_NEAR(item->x, 47.397742, 1e-5);
    EXPECT_NEAR(item->y, 8.545594, 1e-5);
    EXPECT_NEAR(item->z, 489.4, 1);
    request(0);
    EXPECT_NEAR(rig.last<MissionItemInt>()->x, 473977420, 100);
    request(1);
    EXPECT_EQ(last_result(), MAV_MISSION_INVALID_SEQUENCE);
    request(0, MAV_MISSION_TYPE_RALLY);
    EXPECT_EQ(last_result(), MAV_MISSION_INVALID_SEQUENCE);
}

TEST_F(ArduPilotPlanService, ReplacesAPartOfThePlan) {
    upload({waypoint(0), waypoint(1, 100), waypoint(2, 200), waypoint(3, 300)});
    const auto write = [&](int first, int last) {
        rig.send(MissionWritePartialList{.target_system = 1,
                                         .target_component = 1,
                                         .start_index = static_cast<std::int16_t>(first),
                                         .end_index = static_cast<std::int16_t>(last)});
    };
    rig.forget();
    write(2, 2);
    ASSERT_TRUE(rig.last<MissionRequest>());
    EXPECT_EQ(rig.last<MissionRequest>()->seq, 2);
    rig.send(waypoint(2, 222));
    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    EXPECT_EQ(count(), 4);
    request(2);
    EXPECT_EQ(rig.last<MissionItemInt>()->x, 222);
    request(3);
    EXPECT_EQ(rig.last<MissionItemInt>()->x, 300);

    for (const auto& [first, last] : {std::pair{-1, 2}, {3, 2}, {0, 5}, {-32768, 32767}}) {
        rig.forget();
        write(first, last);
        EXPECT_EQ(last_result(), MAV_MISSION_ERROR) << first << " " << last;
    }
    write(4, 4);
    rig.send(waypoint(4, 400));
    EXPECT_EQ(count(), 5) << "one item may be appended";
}

TEST_F(ArduPilotPlanService, ReportsItemsOutOfSequence) {
    announce(3);
    rig.send(waypoint(2));
    EXPECT_EQ(last_result(), MAV_MISSION_INVALID_SEQUENCE);
    rig.send(waypoint(0));
    rig.send(waypoint(1));
    rig.send(waypoint(2));
    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
}

TEST_F(ArduPilotPlanService, KnowsItsOwnCommands) {
    auto yaw = waypoint(1);
    yaw.command = MAV_CMD_CONDITION_YAW;
    upload({waypoint(0), yaw});
    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    auto gate = waypoint(1);
    gate.command = MAV_CMD_CONDITION_GATE;
    upload({waypoint(0), gate});
    EXPECT_EQ(last_result(), MAV_MISSION_UNSUPPORTED);
}

TEST_F(ArduPilotPlanService, FliesToAnItemThatIsAnOrder) {
    ASSERT_TRUE(rig.vehicle.set_mode("GUIDED"));
    ASSERT_TRUE(rig.vehicle.arm(false));
    ASSERT_TRUE(rig.vehicle.take_off(15));
    rig.run(15.0);

    auto order = waypoint(0, 473980000, 85455939, 15);
    order.frame = MAV_FRAME_GLOBAL_RELATIVE_ALT;
    order.current = 2;
    rig.send(order);
    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    rig.run(25.0);
    EXPECT_NEAR(rig.vehicle.status().latitude_deg, 47.398, 2e-5);
    EXPECT_EQ(count(), 0) << "it is no part of a plan";

    order.current = 3;
    order.z = 25;
    rig.send(order);
    EXPECT_EQ(last_result(), MAV_MISSION_ACCEPTED);
    rig.run(15.0);
    EXPECT_NEAR(rig.vehicle.status().relative_altitude_m, 25, 1);

    order.current = 2;
    order.z = not_given;
    rig.send(order);
    EXPECT_EQ(last_result(), MAV_MISSION_ERROR);
}

TEST_F(ArduPilotPlanService, RefusesAnOrderOutsideGuided) {
    ASSERT_TRUE(rig.vehicle.set_mode("LOITER"));
    auto order = waypoint(0);
    order.current = 2;
    rig.send(order);

    EXPECT_EQ(last_result(), MAV_MISSION_ERROR);
}

}  // namespace
}  // namespace mavloom::sim::plan_tests
