// SPDX-License-Identifier: MIT
// Intervals and requests of messages as a client sees them. Expected answers: MAVLink guide, "Command Protocol" and
// "Requesting and Rate-Controlling Messages"; results and fields of PX4 as in tests/data/px4_gcs_session.tlog.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <set>

#include "mavloom/msg/attitude.hpp"
#include "mavloom/msg/autopilot_version.hpp"
#include "mavloom/msg/available_modes.hpp"
#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/command_int.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/component_metadata.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_data_stream.hpp"
#include "mavloom/msg/enums/mav_result.hpp"
#include "mavloom/msg/flight_information.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/highres_imu.hpp"
#include "mavloom/msg/home_position.hpp"
#include "mavloom/msg/local_position_ned.hpp"
#include "mavloom/msg/message_interval.hpp"
#include "mavloom/msg/mission_current.hpp"
#include "mavloom/msg/protocol_version.hpp"
#include "mavloom/msg/request_data_stream.hpp"
#include "mavloom/msg/vfr_hud.hpp"
#include "unit/sim/bench.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

using namespace msg;
using test::Peer;
using test::Rig;
using test::Sent;
using testing::Each;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr float infinity = std::numeric_limits<float>::infinity();

// A vehicle that is ready, and has sent what it sends at the start.
struct Ready : Rig {
    explicit Ready(Autopilot autopilot = Autopilot::px4, Profile profile = Profile::lite)
        : Rig({.autopilot = autopilot}, {.profile = profile}) {
        run(5.0);
        forget();
    }

    // Sends a command and returns the ids of what came back during the call.
    std::vector<MessageId> command(std::uint16_t id, float p1 = 0, float p2 = 0, LinkId link = LinkId{1}) {
        forget();
        send(CommandLong{.target_system = 1, .target_component = 1, .command = id, .param1 = p1, .param2 = p2},
             Peer{.link = link});
        std::vector<MessageId> ids;
        for (const Sent& sent : sink.frames) ids.push_back(sent.frame().id());
        return ids;
    }
    std::uint8_t result_of(std::uint16_t id, float p1 = 0, float p2 = 0) {
        command(id, p1, p2);
        const auto acks = all<CommandAck>();
        return acks.size() == 1 && acks[0].command == id ? acks[0].result : std::uint8_t{255};
    }
    std::uint8_t set(MessageId message, float microseconds) {
        return result_of(MAV_CMD_SET_MESSAGE_INTERVAL, static_cast<float>(message.value), microseconds);
    }
    std::int32_t interval(MessageId message) {
        command(MAV_CMD_GET_MESSAGE_INTERVAL, static_cast<float>(message.value));
        const auto answer = last<MessageInterval>();
        return answer && answer->message_id == message.value ? answer->interval_us : 12345;
    }
};

TEST(RequestMessage, TheMessageComesBeforeTheAcknowledgement) {
    Ready vehicle;

    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_MESSAGE, 148), ElementsAre(AutopilotVersion::id, CommandAck::id));
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_MESSAGE, 300), ElementsAre(ProtocolVersion::id, CommandAck::id));
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_MESSAGE, 242), ElementsAre(HomePosition::id, CommandAck::id));
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_MESSAGE, 264), ElementsAre(FlightInformation::id, CommandAck::id));
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_MESSAGE, 30), ElementsAre(Attitude::id, CommandAck::id));
    const auto ack = vehicle.last<CommandAck>();
    EXPECT_EQ(ack->command, MAV_CMD_REQUEST_MESSAGE);
    EXPECT_EQ(ack->result, MAV_RESULT_ACCEPTED);
    EXPECT_EQ(ack->progress, 0) << "as PX4";
    EXPECT_EQ(ack->target_system, 255);
    EXPECT_EQ(ack->target_component, 190);
}

TEST(RequestMessage, GoesToTheLinkOfTheRequestOnly) {
    Ready vehicle;
    vehicle.vehicle.open(LinkId{2}, {.profile = Profile::lite}, vehicle.now());
    vehicle.run(1.0);
    vehicle.command(MAV_CMD_REQUEST_MESSAGE, 148, 0, LinkId{2});

    EXPECT_THAT(vehicle.all<AutopilotVersion>(LinkId{1}), IsEmpty());
    EXPECT_EQ(vehicle.all<AutopilotVersion>(LinkId{2}).size(), 1u);
}

TEST(RequestMessage, WithoutMessageItIsDeniedAsInPx4) {
    Ready vehicle;
    for (const float id :
         {9999.f, -1.f, nan_f, infinity, -infinity, 16777216.f, 4e9f, 30.5e9f, 42.f, 360.f, 25.f, 246.f})
        EXPECT_EQ(vehicle.result_of(MAV_CMD_REQUEST_MESSAGE, id), MAV_RESULT_DENIED) << id;
    EXPECT_THAT(vehicle.all<MissionCurrent>(), IsEmpty());
}

TEST(RequestMessage, CommandIntWorksTheSame) {
    Ready vehicle;
    vehicle.send(CommandInt{.target_system = 1, .command = MAV_CMD_REQUEST_MESSAGE, .param1 = 300});

    EXPECT_EQ(vehicle.all<ProtocolVersion>().size(), 1u);
    EXPECT_EQ(vehicle.last<CommandAck>()->result, MAV_RESULT_ACCEPTED);
}

TEST(RequestMessage, OlderCommandsBringTheSameMessages) {
    Ready vehicle;
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_PROTOCOL_VERSION, 1), ElementsAre(ProtocolVersion::id, CommandAck::id));
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_AUTOPILOT_CAPABILITIES, 1),
                ElementsAre(AutopilotVersion::id, CommandAck::id));
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_FLIGHT_INFORMATION, 1),
                ElementsAre(FlightInformation::id, CommandAck::id));
    EXPECT_THAT(vehicle.command(MAV_CMD_GET_HOME_POSITION), ElementsAre(HomePosition::id, CommandAck::id));
    // Without a camera.
    EXPECT_EQ(vehicle.result_of(MAV_CMD_REQUEST_CAMERA_INFORMATION, 1), MAV_RESULT_UNSUPPORTED);
    EXPECT_EQ(vehicle.result_of(MAV_CMD_REQUEST_STORAGE_INFORMATION, 1), MAV_RESULT_UNSUPPORTED);
    EXPECT_EQ(vehicle.result_of(MAV_CMD_REQUEST_CAMERA_CAPTURE_STATUS, 1), MAV_RESULT_UNSUPPORTED);
}

TEST(RequestMessage, ProtocolVersionIsMavlink2) {
    Ready vehicle;
    vehicle.command(MAV_CMD_REQUEST_MESSAGE, 300);

    const auto version = vehicle.last<ProtocolVersion>();
    ASSERT_TRUE(version);
    EXPECT_EQ(version->version, 200);
    EXPECT_EQ(version->min_version, 100);
    EXPECT_EQ(version->max_version, 203);
}

TEST(RequestMessage, EveryVehicleHasANumberOfItsOwn) {
    std::set<std::uint64_t> numbers;
    for (std::uint64_t seed = 1; seed <= 4; ++seed)
        for (unsigned system = 1; system <= 250; ++system) {
            Rig rig({.system = SystemId{static_cast<std::uint8_t>(system)}, .seed = seed});
            rig.send(CommandLong{
                .target_system = static_cast<std::uint8_t>(system), .command = MAV_CMD_REQUEST_MESSAGE, .param1 = 148});
            const auto version = rig.last<AutopilotVersion>();
            ASSERT_TRUE(version);
            EXPECT_NE(version->uid, 0u);
            EXPECT_TRUE(numbers.insert(version->uid).second);
        }
}

TEST(RequestMessage, ModesComeOneByOneOrAllAtOnce) {
    Ready vehicle;
    vehicle.command(MAV_CMD_REQUEST_MESSAGE, 435, 0);
    const auto all = vehicle.all<AvailableModes>();
    ASSERT_EQ(all.size(), 28u) << "PX4 lists 28 modes";
    EXPECT_EQ(vehicle.sink.frames.back().frame().id(), CommandAck::id);
    std::set<std::uint32_t> customs;
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(all[i].number_modes, 28);
        EXPECT_EQ(all[i].mode_index, i + 1);
        EXPECT_TRUE(customs.insert(all[i].custom_mode).second);
        EXPECT_EQ(all[i].standard_mode != 0, all[i].mode_name[0] == 0) << "PX4 names only modes of its own";
    }
    EXPECT_THAT(vehicle.command(MAV_CMD_REQUEST_MESSAGE, 435, 5), ElementsAre(AvailableModes::id, CommandAck::id));
    const auto hold = vehicle.last<AvailableModes>();
    EXPECT_EQ(hold->custom_mode, 0x03040000u);
    EXPECT_STREQ(hold->mode_name.data(), "Hold");
    EXPECT_EQ(*hold, all[4]);
    for (const float beyond : {29.f, -1.f, 255.f, 1e9f, 4.5f * 1e30f, infinity, -infinity})
        EXPECT_EQ(vehicle.result_of(MAV_CMD_REQUEST_MESSAGE, 435, beyond), MAV_RESULT_DENIED) << beyond;
    EXPECT_THAT(vehicle.all<AvailableModes>(), IsEmpty());
    EXPECT_EQ(vehicle.command(MAV_CMD_REQUEST_MESSAGE, 435, nan_f).size(), 29u) << "not given: all";
}

TEST(MessageInterval, ReportsWhatTheLinkStreams) {
    Ready vehicle(Autopilot::px4, Profile::px4_normal);

    EXPECT_THAT(vehicle.command(MAV_CMD_GET_MESSAGE_INTERVAL, 30), ElementsAre(MessageInterval::id, CommandAck::id));
    EXPECT_EQ(vehicle.interval(Attitude::id), 20'000) << "as PX4 answered";
    EXPECT_EQ(vehicle.interval(Heartbeat::id), 1'000'000);
    EXPECT_EQ(vehicle.interval(HighresImu::id), -1);
    EXPECT_EQ(vehicle.interval(MessageId{9999}), 0);
    EXPECT_EQ(vehicle.set(HighresImu::id, 20'000), MAV_RESULT_ACCEPTED);
    EXPECT_EQ(vehicle.interval(HighresImu::id), 20'000);
    EXPECT_EQ(vehicle.set(HighresImu::id, 0), MAV_RESULT_ACCEPTED);
    EXPECT_EQ(vehicle.interval(HighresImu::id), -1) << "the default of the profile is off";
    for (const float id : {nan_f, -1.f, infinity, 1e9f, 65536.f})
        EXPECT_EQ(vehicle.result_of(MAV_CMD_GET_MESSAGE_INTERVAL, id), MAV_RESULT_DENIED) << id;
}

TEST(MessageInterval, WhatTheVehicleCannotStreamFailsAsInPx4) {
    Ready vehicle;
    for (const std::uint32_t id : {0u, 9999u, 76u, 148u, 435u})
        EXPECT_EQ(vehicle.set(MessageId{id}, 100'000), MAV_RESULT_FAILED) << id;
    for (const float id : {nan_f, -1.f, infinity, 4e9f})
        EXPECT_EQ(vehicle.result_of(MAV_CMD_SET_MESSAGE_INTERVAL, id, 1e5), MAV_RESULT_FAILED) << id;
    EXPECT_EQ(vehicle.set(Attitude::id, nan_f), MAV_RESULT_DENIED);
    vehicle.run(10.0);
    EXPECT_NEAR(static_cast<double>(vehicle.all<Heartbeat>().size()), 10, 1);
}

TEST(MessageInterval, ExtremeIntervalsStayWithinBounds) {
    Ready vehicle;
    EXPECT_EQ(vehicle.set(Attitude::id, infinity), MAV_RESULT_ACCEPTED);
    EXPECT_EQ(vehicle.interval(Attitude::id), 2'000'000'000);
    EXPECT_EQ(vehicle.set(Attitude::id, -infinity), MAV_RESULT_ACCEPTED);
    EXPECT_EQ(vehicle.interval(Attitude::id), -1);
    EXPECT_EQ(vehicle.set(Attitude::id, 1e-30f), MAV_RESULT_ACCEPTED);
    EXPECT_EQ(vehicle.interval(Attitude::id), 4'000);
    vehicle.forget();
    vehicle.run(2.0);
    EXPECT_NEAR(static_cast<double>(vehicle.all<Attitude>().size()), 500, 1);
}

// Messages whose rate MAVSDK's telemetry, info and transponder plug-ins set: each must be accepted, and then arrive.
TEST(MessageInterval, AllThatMavsdkAsksForIsAcceptedAndArrives) {
    for (const Autopilot autopilot : {Autopilot::px4, Autopilot::ardupilot}) {
        Rig rig({.autopilot = autopilot, .utc_at_start = WallTime{std::chrono::seconds{1'700'000'000}}},
                {.profile = Profile::lite});
        rig.run(5.0);
        rig.forget();
        const std::vector<std::uint32_t> ids{32,  33, 242, 245, 31,  30,  105, 26, 27, 74,  115, 24,
                                             147, 65, 1,   140, 375, 331, 132, 29, 2,  141, 231, 264};
        for (const std::uint32_t id : ids)
            rig.send(CommandLong{.target_system = 1,
                                 .target_component = 1,
                                 .command = MAV_CMD_SET_MESSAGE_INTERVAL,
                                 .param1 = static_cast<float>(id),
                                 .param2 = 100'000});
        rig.send(CommandLong{.target_system = 1, .command = MAV_CMD_SET_MESSAGE_INTERVAL, .param1 = 246, .param2 = 1e6});
        const auto acks = rig.all<CommandAck>();
        ASSERT_EQ(acks.size(), ids.size() + 1);
        for (const CommandAck& ack : acks) EXPECT_EQ(ack.result, MAV_RESULT_ACCEPTED);
        rig.forget();
        rig.run(10.0);
        std::map<std::uint32_t, int> counts;
        for (const Sent& sent : rig.sink.frames) ++counts[sent.frame().id().value];
        for (const std::uint32_t id : ids) EXPECT_NEAR(counts[id], 100, 1) << id;
    }
}

struct ArduPilotStreams : testing::Test {
    Ready vehicle{Autopilot::ardupilot, Profile::ardupilot};

    void request(std::uint8_t group, std::uint16_t hz, std::uint8_t start = 1) {
        vehicle.send(
            RequestDataStream{.target_system = 1, .req_stream_id = group, .req_message_rate = hz, .start_stop = start});
    }
    template <class Message>
    double rate() {
        vehicle.forget();
        vehicle.run(10.0);
        return static_cast<double>(vehicle.all<Message>().size()) / 10;
    }
};

TEST_F(ArduPilotStreams, GroupsRunAt4HzUntilAClientAsks) {
    EXPECT_NEAR(rate<Attitude>(), 4, 0.1);
    EXPECT_NEAR(rate<VfrHud>(), 4, 0.1);
}

TEST_F(ArduPilotStreams, ARequestChangesItsGroupOnly) {
    request(MAV_DATA_STREAM_EXTRA1, 10);
    EXPECT_NEAR(rate<Attitude>(), 10, 0.1);
    EXPECT_NEAR(rate<VfrHud>(), 4, 0.1);
    request(MAV_DATA_STREAM_EXTRA1, 10, 0);
    EXPECT_EQ(rate<Attitude>(), 0);
    request(MAV_DATA_STREAM_ALL, 2);
    EXPECT_NEAR(rate<Attitude>(), 2, 0.1);
    EXPECT_NEAR(rate<LocalPositionNed>(), 2, 0.1);
    EXPECT_NEAR(rate<Heartbeat>(), 1, 0.1);
    request(MAV_DATA_STREAM_ALL, 0xffff);
    EXPECT_NEAR(rate<Attitude>(), 250, 0.2);
    request(MAV_DATA_STREAM_ALL, 0);
    EXPECT_EQ(rate<Attitude>(), 0);
    for (unsigned group = 13; group < 256; ++group) request(static_cast<std::uint8_t>(group), 10);
    EXPECT_EQ(rate<Attitude>(), 0);
}

TEST_F(ArduPilotStreams, ParametersSetTheRatesOfGroups) {
    ASSERT_TRUE(vehicle.vehicle.set_parameter("SR0_EXTRA1", 10));
    EXPECT_NEAR(rate<Attitude>(), 10, 0.1);
    EXPECT_NEAR(rate<VfrHud>(), 4, 0.1);
    ASSERT_TRUE(vehicle.vehicle.set_parameter("SR0_EXTRA1", 0));
    EXPECT_EQ(rate<Attitude>(), 0);
    ASSERT_TRUE(vehicle.vehicle.set_parameter("SR0_EXTRA1", -7));
    EXPECT_EQ(rate<Attitude>(), 0);
    vehicle.vehicle.open(LinkId{2}, {.profile = Profile::ardupilot}, vehicle.now());
    vehicle.forget();
    vehicle.run(5.0);
    EXPECT_TRUE(vehicle.all<Attitude>(LinkId{2}).empty()) << "also on links that open later";
    EXPECT_NEAR(static_cast<double>(vehicle.all<VfrHud>(LinkId{2}).size()), 20, 1);
}

TEST_F(ArduPilotStreams, ARequestChangesItsLinkOnly) {
    vehicle.vehicle.open(LinkId{2}, {.profile = Profile::ardupilot}, vehicle.now());
    request(MAV_DATA_STREAM_ALL, 20);
    vehicle.forget();
    vehicle.run(10.0);

    EXPECT_NEAR(static_cast<double>(vehicle.all<Attitude>(LinkId{1}).size()), 200, 1);
    EXPECT_NEAR(static_cast<double>(vehicle.all<Attitude>(LinkId{2}).size()), 40, 1);
}

TEST(DataStreams, Px4IgnoresRequestsForGroups) {
    Ready vehicle(Autopilot::px4, Profile::px4_normal);
    vehicle.send(RequestDataStream{.target_system = 1, .req_message_rate = 1, .start_stop = 1});
    vehicle.send(RequestDataStream{.target_system = 1, .start_stop = 0});
    vehicle.forget();
    vehicle.run(10.0);

    EXPECT_NEAR(static_cast<double>(vehicle.all<Attitude>().size()), 500, 1);
}

}  // namespace
}  // namespace mavloom::sim
