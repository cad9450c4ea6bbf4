// SPDX-License-Identifier: MIT
// The events interface as a client sees it. Expected bytes are those of a recorded PX4 1.17
// (tests/data/px4_gcs_session.tlog); the rules are in the MAVLink guide, "Events Interface".
#include <gmock/gmock.h>

#include <fmt/format.h>

#include "flight/firmware/firmware.hpp"
#include "mavloom/msg/command_long.hpp"
#include "mavloom/msg/current_event_sequence.hpp"
#include "mavloom/msg/enums/mav_cmd.hpp"
#include "mavloom/msg/enums/mav_frame.hpp"
#include "mavloom/msg/event.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/mission_count.hpp"
#include "mavloom/msg/mission_item_int.hpp"
#include "mavloom/msg/request_event.hpp"
#include "mavloom/msg/response_event_error.hpp"
#include "mavloom/msg/statustext.hpp"
#include "sim/metadata/event_catalog.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::event_tests {
namespace {

using namespace msg;
using test::Peer;
using test::Rig;
using testing::ElementsAre;

VehicleOptions dated() {
    VehicleOptions options;
    options.utc_at_start = WallTime{std::chrono::seconds{1795222314}};  // 2026-11-21 00:51:54 UTC
    return options;
}

// Arguments in hexadecimal, without the zeros at the end, as in the listings of the recordings.
std::string arguments_of(const Event& event) {
    std::string text;
    for (const std::uint8_t byte : event.arguments) text += fmt::format("{:02x}", byte);
    text.erase(text.find_last_not_of('0') + 1);
    return text;
}

class EventService : public testing::Test {
protected:
    void greet() { rig.send(Heartbeat{.type = 6, .autopilot = 8, .mavlink_version = 3}); }
    std::vector<Event> of_id(std::uint32_t id) {
        auto all = rig.all<Event>();
        std::erase_if(all, [&](const Event& event) { return event.id_ != id; });
        return all;
    }
    // The events of the last report, from its summary on.
    std::vector<Event> report() {
        auto all = rig.all<Event>();
        const auto summary = std::find_if(
            all.rbegin(), all.rend(), [](const Event& event) { return event.id_ == event_id::arming_check_summary; });
        return {summary == all.rend() ? all.end() : summary.base() - 1, all.end()};
    }
    void request(std::uint16_t first, std::uint16_t last) {
        rig.forget();
        rig.send(RequestEvent{.target_system = 1, .target_component = 1, .first_sequence = first, .last_sequence = last});
    }

    Rig rig{dated()};
};

TEST_F(EventService, SendsTheSequenceEveryThreeSeconds) {
    rig.run(9.5);

    const auto sequences = rig.all<CurrentEventSequence>();
    ASSERT_EQ(sequences.size(), 4u);
    EXPECT_EQ(sequences[0].flags, 1) << "the counter began again";
    for (std::size_t i = 1; i < 4; ++i) EXPECT_EQ(sequences[i].flags, 0);
    EXPECT_EQ(sequences[3].sequence, rig.last<Event>()->sequence);
}

TEST_F(EventService, NumbersEventsWithoutGaps) {
    greet();
    rig.run(10.0);

    const auto events = rig.all<Event>();
    ASSERT_GE(events.size(), 6u);
    for (std::size_t i = 0; i < events.size(); ++i) EXPECT_EQ(events[i].sequence, i + 1);
    for (const Event& event : events) {
        EXPECT_EQ(event.destination_system, 0);
        EXPECT_LE(event.event_time_boot_ms, 10'000u);
    }
}

TEST_F(EventService, AnnouncesTheLogThatBoots) {
    rig.run(0.2);

    const auto opened = of_id(event_id::log_opened);
    ASSERT_EQ(opened.size(), 1u);
    EXPECT_EQ(arguments_of(opened[0]), "ea070b15003336");  // year 2026, month 11, day 21, 00:51:54
    EXPECT_EQ(opened[0].log_levels, 0x66);
    ASSERT_TRUE(rig.last<Statustext>());
    EXPECT_STREQ(rig.last<Statustext>()->text.data(), "[logger] ./log/2026-11-21/00_51_54.ulg\t");
}

TEST_F(EventService, AnnouncesNoLogAgainAfterAReboot) {
    rig.run(4.0);
    ASSERT_TRUE(rig.vehicle.arm(true));
    rig.run(1.0);
    ASSERT_TRUE(rig.vehicle.disarm(true));
    rig.run(1.0);
    rig.send(CommandLong{.target_system = 1, .target_component = 1, .command = 246, .param1 = 1});
    rig.run(8.0);
    EXPECT_EQ(of_id(event_id::log_opened).size(), 1u);
}

// A ready vehicle without mission and sticks: the report of the recording, byte by byte.
TEST_F(EventService, ReportsTheArmingChecksAsPx4Does) {
    greet();
    rig.run(8.0);

    const auto events = report();
    std::vector<std::string> lines;
    for (const Event& event : events)
        lines.push_back(fmt::format("{} {:02x} {}", event.id_, event.log_levels, arguments_of(event)));
    EXPECT_THAT(lines, ElementsAre("27825120 88 000000100080000000b03a7f80b03a7f8", "28241790 33 0040000014",
                                   "17154777 66 0800000014", "17231145 44 ffffffff07", "18691879 88 000a1d0238"));
    EXPECT_EQ(of_id(event_id::health_summary).size(), of_id(event_id::arming_check_summary).size());
}

TEST_F(EventService, ReportsAgainWhenAMissionArrives) {
    greet();
    rig.run(8.0);
    rig.forget();
    greet();
    rig.run(5.0);
    EXPECT_TRUE(rig.all<Event>().empty()) << "nothing changed";

    rig.send(MissionCount{.target_system = 1, .target_component = 1, .count = 1});
    rig.send(MissionItemInt{.target_system = 1,
                            .target_component = 1,
                            .frame = MAV_FRAME_GLOBAL_INT,
                            .command = MAV_CMD_NAV_WAYPOINT,
                            .x = 473977430,
                            .y = 85455939,
                            .z = 500});
    rig.run(1.0);

    const auto events = report();
    ASSERT_EQ(events.size(), 4u);
    EXPECT_EQ(arguments_of(events[0]), "000000100080000000b83a7f80b83a7f8") << "the bit of Mission";
    EXPECT_TRUE(of_id(event_id::no_mission).empty());
}

// The recorded report of a PX4 that boots.
TEST_F(EventService, ReportsWhileTheVehicleBoots) {
    rig.run(0.5);
    rig.send(CommandLong{.target_system = 1, .target_component = 1, .command = MAV_CMD_RUN_PREARM_CHECKS});

    std::vector<std::string> lines;
    for (const Event& event : report()) lines.push_back(fmt::format("{} {}", event.id_, arguments_of(event)));
    EXPECT_THAT(lines,
                ElementsAre("27825120 000000130180000000002a0180002a018", "30203637 fc007e0011", "28241790 0040000014",
                            "27227279 fed17e001", "30612409 fc007e0011", "26788467 3800000018", "17154777 0800000014",
                            "17231145 ffffffff07", "23579003 ffffffff0c", "18691879 00020d0238"));
}

TEST_F(EventService, SendsEventsAgain) {
    greet();
    rig.run(8.0);
    const auto past = rig.all<Event>();
    const std::uint16_t newest = past.back().sequence;

    request(static_cast<std::uint16_t>(newest - 1), newest);

    const auto again = rig.all<Event>();
    ASSERT_EQ(again.size(), 2u);
    EXPECT_FALSE(rig.last<ResponseEventError>());
    EXPECT_EQ(again[1].destination_system, 255);
    EXPECT_EQ(again[1].destination_component, 190);
    EXPECT_EQ(again[1].id_, past.back().id_);
    EXPECT_EQ(again[1].sequence, newest);
    EXPECT_EQ(again[1].event_time_boot_ms, past.back().event_time_boot_ms);
    EXPECT_EQ(again[1].arguments, past.back().arguments);
}

TEST_F(EventService, ReportsWhichEventsAreGone) {
    greet();
    rig.run(8.0);
    for (int i = 0; i < 6; ++i) {
        rig.send(CommandLong{.target_system = 1, .target_component = 1, .command = MAV_CMD_RUN_PREARM_CHECKS});
        rig.run(0.1);
    }
    const std::uint16_t newest = rig.last<Event>()->sequence;
    ASSERT_GT(newest, 25);

    request(1, newest);

    const auto error = rig.last<ResponseEventError>();
    ASSERT_TRUE(error);
    EXPECT_EQ(error->target_system, 255);
    EXPECT_EQ(error->sequence, 1);
    EXPECT_EQ(error->sequence_oldest_available, newest - 19);
    EXPECT_EQ(rig.all<Event>().size(), 20u);
    request(static_cast<std::uint16_t>(newest + 1), static_cast<std::uint16_t>(newest + 5));
    EXPECT_TRUE(rig.last<ResponseEventError>()) << "not sent yet";
    EXPECT_TRUE(rig.all<Event>().empty());
}

TEST_F(EventService, ReportsAtOnceWhenAClientAsks) {
    greet();
    rig.run(8.0);
    rig.forget();

    rig.send(CommandLong{.target_system = 1, .target_component = 1, .command = MAV_CMD_RUN_PREARM_CHECKS});

    EXPECT_EQ(report().size(), 5u);
}

TEST_F(EventService, BeginsAgainAfterAReboot) {
    rig.run(5.0);
    rig.send(CommandLong{
        .target_system = 1, .target_component = 1, .command = MAV_CMD_PREFLIGHT_REBOOT_SHUTDOWN, .param1 = 1});
    rig.forget();
    rig.run(5.0);

    const auto sequences = rig.all<CurrentEventSequence>();
    ASSERT_FALSE(sequences.empty());
    EXPECT_EQ(sequences[0].flags, 1);
    EXPECT_EQ(rig.all<Event>().front().sequence, 1);
}

TEST(EventServiceOfArduPilot, SendsNoEvents) {
    VehicleOptions options = dated();
    options.autopilot = Autopilot::ardupilot;
    Rig rig(options);
    rig.send(Heartbeat{.type = 6, .autopilot = 8, .mavlink_version = 3});
    rig.run(10.0);
    rig.send(RequestEvent{.target_system = 1, .target_component = 1, .first_sequence = 0, .last_sequence = 9});
    rig.send(CommandLong{.target_system = 1, .target_component = 1, .command = MAV_CMD_RUN_PREARM_CHECKS});

    EXPECT_FALSE(rig.last<Event>());
    EXPECT_FALSE(rig.last<CurrentEventSequence>());
    EXPECT_FALSE(rig.last<ResponseEventError>());
}

// --- Events of a flight

TEST_F(EventService, SendsTheEventOfAText) {
    greet();
    rig.run(8.0);
    rig.forget();

    ASSERT_TRUE(rig.vehicle.take_off(10));
    rig.run(6.0);

    const auto armed = of_id(26266355);
    ASSERT_EQ(armed.size(), 1u);
    EXPECT_EQ(arguments_of(armed[0]), "04") << "by external command";
    EXPECT_EQ(of_id(21054825).size(), 1u) << "take-off detected";
    std::vector<std::string> texts;
    for (const auto& message : rig.all<Statustext>()) texts.emplace_back(message.text.data());
    EXPECT_THAT(texts, testing::IsSupersetOf({"Armed by external command\t", "Takeoff detected\t"}))
        << "the tab keeps ground stations from showing the text beside the event";
}

}  // namespace
}  // namespace mavloom::sim::event_tests
