// SPDX-License-Identifier: MIT
// Recorded sessions of ground stations with a real PX4, played to a simulated vehicle: every request gets an answer of
// the same kind, in the same order, that PX4 gave. tests/data/README.md describes the recordings.
//
// Requests are sent at their recorded times. Answers are compared within a service: command, parameters, plans, files,
// logs, time, texts, events. Between services the order is PX4's timing only, because it acknowledges commands 3 to 16
// ms later. Runs of equal kinds count once: a file's pieces, the values of a list. Differences that are kept on purpose
// stand in each test with their reason.
#include <gmock/gmock.h>

#include <fmt/format.h>

#include <bit>
#include <fstream>
#include <map>

#include "mavloom/msg/command_ack.hpp"
#include "mavloom/msg/event.hpp"
#include "mavloom/msg/file_transfer_protocol.hpp"
#include "mavloom/msg/heartbeat.hpp"
#include "mavloom/msg/mission_ack.hpp"
#include "mavloom/msg/mission_count.hpp"
#include "mavloom/msg/mission_item_int.hpp"
#include "mavloom/msg/mission_request_int.hpp"
#include "mavloom/msg/param_error.hpp"
#include "mavloom/msg/param_request_list.hpp"
#include "mavloom/msg/param_value.hpp"
#include "mavloom/msg/ping.hpp"
#include "mavloom/msg/statustext.hpp"
#include "mavloom/msg/timesync.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::session_tests {
namespace {

using namespace msg;
using test::Rig;

struct Record {
    FlightTime at{};  // since the first record
    std::vector<std::uint8_t> bytes;

    [[nodiscard]] wire::FrameView frame() const { return wire::FrameView::unchecked(bytes); }
    [[nodiscard]] bool is_request() const { return frame().system() == SystemId{255}; }
};

std::vector<Record> read_recording(const std::string& name) {
    std::ifstream file(std::string(MAVLOOM_TEST_DATA) + "/" + name, std::ios::binary);
    const std::vector<std::uint8_t> all{std::istreambuf_iterator<char>(file), {}};
    std::vector<Record> records;
    std::uint64_t first = 0;
    for (std::size_t at = 0; at + 8 < all.size();) {
        const std::uint64_t time_us = load_be64(all.data() + at);
        if (first == 0) first = time_us;
        at += 8;
        const std::size_t length = wire::frame_length(ByteView(all).subspan(at));
        if (length == 0 || at + length > all.size()) break;
        records.push_back(
            {std::chrono::microseconds{time_us - first},
             {all.begin() + static_cast<std::ptrdiff_t>(at), all.begin() + static_cast<std::ptrdiff_t>(at + length)}});
        at += length;
    }
    return records;
}

struct Answer {
    std::string service, kind;
};

std::string text_of(const auto& chars) {
    return {chars.begin(), std::find(chars.begin(), chars.end(), typename std::decay_t<decltype(chars)>::value_type{})};
}

Answer file_answer(ByteView payload) {
    const auto message = FileTransferProtocol::decode(payload);
    const bool is_ack = message.payload[3] == 128;
    return {"files", is_ack ? fmt::format("ACK of {}", message.payload[5])
                            : fmt::format("NAK of {}: {}", message.payload[5], message.payload[12])};
}

// Empty service: telemetry.
Answer answer_of(const wire::FrameView& frame) {
    const ByteView payload = frame.payload();
    const std::map<std::uint32_t, const char*> named{{148, "AUTOPILOT_VERSION"},
                                                     {300, "PROTOCOL_VERSION"},
                                                     {397, "COMPONENT_METADATA"},
                                                     {435, "AVAILABLE_MODES"},
                                                     {244, "MESSAGE_INTERVAL"}};
    if (const auto at = named.find(frame.id().value); at != named.end()) return {"commands", at->second};
    if (frame.id() == CommandAck::id) {
        const auto message = CommandAck::decode(payload);
        if (message.target_system != 255) return {};  // PX4 acknowledges commands of its own modules
        return {"commands", fmt::format("COMMAND_ACK {} {}", message.command, message.result)};
    }
    if (frame.id() == ParamValue::id) {
        const bool is_hash = text_of(ParamValue::decode(payload).param_id) == "_HASH_CHECK";
        return {"parameters", is_hash ? "PARAM_VALUE _HASH_CHECK" : "PARAM_VALUE"};
    }
    if (frame.id() == ParamError::id)
        return {"parameters", fmt::format("PARAM_ERROR {}", ParamError::decode(payload).error)};
    if (frame.id() == MissionCount::id)
        return {"plans", fmt::format("MISSION_COUNT {}", MissionCount::decode(payload).count)};
    if (frame.id() == MissionAck::id) return {"plans", fmt::format("MISSION_ACK {}", MissionAck::decode(payload).type)};
    if (frame.id() == MissionRequestInt::id)
        return {"plans", fmt::format("MISSION_REQUEST_INT {}", MissionRequestInt::decode(payload).seq)};
    if (frame.id() == MissionItemInt::id)
        return {"plans", fmt::format("MISSION_ITEM_INT {}", MissionItemInt::decode(payload).seq)};
    if (frame.id() == FileTransferProtocol::id) return file_answer(payload);
    if (frame.id() == MessageId{118}) return {"logs", "LOG_ENTRY"};
    if (frame.id() == Timesync::id && Timesync::decode(payload).tc1 != 0) return {"time", "TIMESYNC"};
    if (frame.id() == Ping::id && Ping::decode(payload).target_system != 0) return {"time", "PING"};
    if (frame.id() == Statustext::id) {
        const std::string text = text_of(Statustext::decode(payload).text);
        return {"texts", text.starts_with("[logger]") ? "[logger]" : text};  // a path with the time follows
    }
    if (frame.id() == Event::id) return {"events", fmt::format("{}", Event::decode(payload).id_)};
    return {};
}

using Answers = std::map<std::string, std::vector<std::string>>;  // by service

void add(Answers& answers, const wire::FrameView& frame) {
    const Answer answer = answer_of(frame);
    if (answer.service.empty()) return;
    auto& list = answers[answer.service];
    if (list.empty() || list.back() != answer.kind) list.push_back(answer.kind);
}

struct Session {
    Answers expected, got;
};

// Plays the requests of a recording. The vehicle boots `before` seconds before the first record.
Session play(const std::vector<Record>& records, const VehicleOptions& options, double before) {
    Session session;
    Rig rig(options);
    rig.run(before);
    rig.forget();
    const FlightTime start = rig.flight;
    bool was_asked = false;
    for (const Record& record : records) {
        was_asked = was_asked || (record.is_request() && record.frame().id() != Heartbeat::id);
        if (!record.is_request()) {
            if (was_asked) add(session.expected, record.frame());
            continue;
        }
        rig.run(start + record.at - rig.flight);
        if (!was_asked) rig.forget();
        const auto* const info = dialect::default_dialect().wire_table().find(record.frame().id());
        rig.vehicle.receive(LinkId{1}, record.frame(), info, rig.now());
    }
    rig.run(start + records.back().at + std::chrono::milliseconds{500} - rig.flight);
    for (const auto& sent : rig.sink.frames) add(session.got, sent.frame());
    return session;
}

VehicleOptions options() {
    VehicleOptions options;
    options.utc_at_start = WallTime{std::chrono::seconds{1795222314}};
    options.ready_after = std::chrono::seconds{4};
    return options;
}

// An answer of PX4 that a simulated vehicle does not give.
struct KeptDifference {
    const char* service;
    const char* kind;
    const char* reason;
};

void compare(Session session, std::initializer_list<KeptDifference> differences) {
    for (const KeptDifference& difference : differences) {
        auto& kinds = session.expected[difference.service];
        const auto last = std::find(kinds.rbegin(), kinds.rend(), difference.kind);
        ASSERT_NE(last, kinds.rend()) << difference.kind << ": " << difference.reason;
        kinds.erase(last.base() - 1);
    }
    for (const auto& [service, kinds] : session.expected) EXPECT_EQ(session.got[service], kinds) << service;
}

TEST(RecordedSessions, GroundStationThatAsksForEachService) {
    const auto records = read_recording("px4_gcs_session.tlog");
    ASSERT_EQ(records.size(), 6781u);
    const double booted_before = 7.5;  // s before the recording begins

    const Session session = play(records, options(), booted_before);

    for (const char* service : {"commands", "parameters", "plans", "files", "logs", "time", "texts", "events"})
        EXPECT_TRUE(session.expected.contains(service)) << service;
    compare(session, {{"parameters", "PARAM_VALUE", "PX4 broadcasts a value that was set twice, 9 ms apart"}});
}

// Types and first values by name; values of integers as PARAM_VALUE has them, byte by byte.
std::map<std::string, std::pair<int, std::uint32_t>> list_of(const auto& frames) {
    std::map<std::string, std::pair<int, std::uint32_t>> list;
    for (const auto& each : frames) {
        if (each.frame().id() != ParamValue::id) continue;
        const auto value = ParamValue::decode(each.frame().payload());
        list.try_emplace(text_of(value.param_id), value.param_type, std::bit_cast<std::uint32_t>(value.param_value));
    }
    return list;
}

// Names, types and values, so that the checksum over them is PX4's too.
TEST(RecordedSessions, ParametersAreThoseOfPx4) {
    auto recorded = list_of(read_recording("px4_gcs_session.tlog"));
    ASSERT_EQ(recorded.size(), 953u);
    ASSERT_TRUE(recorded.contains("_HASH_CHECK"));
    Rig rig;
    rig.send(ParamRequestList{.target_system = 1});
    rig.run(2.0);
    auto got = list_of(rig.sink.frames);
    // The vehicle maintains these by itself.
    for (const char* const name : {"COM_FLIGHT_UUID", "EKF2_MAG_DECL", "LND_FLIGHT_T_HI", "LND_FLIGHT_T_LO"}) {
        EXPECT_EQ(recorded[name].first, got[name].first) << name;
        recorded.erase(name);
        got.erase(name);
    }

    EXPECT_EQ(got, recorded);
}

constexpr double booted_at_once = 0.06;

TEST(RecordedSessions, QGroundControlWithEmptyCaches) {
    const auto records = read_recording("qgc_px4_session_requests.tlog");
    ASSERT_EQ(records.size(), 190u);

    compare(play(records, options(), booted_at_once),
            {{"texts", "Preflight Fail: no heading reference", "a text that only PX4's estimator causes"},
             {"events", "23579003", "PX4 counts a ground station as connected only some seconds after its heartbeat"}});
}

TEST(RecordedSessions, QGroundControlWithFilledCachesTakesOffAndLands) {
    const auto records = read_recording("qgc_px4_flight_requests.tlog");
    ASSERT_EQ(records.size(), 209u);

    compare(play(records, options(), booted_at_once),
            {{"texts", "Preflight Fail: no heading reference", "a text that only PX4's estimator causes"},
             {"events", "23579003", "PX4 counts a ground station as connected only some seconds after its heartbeat"}});
}

}  // namespace
}  // namespace mavloom::sim::session_tests
