// SPDX-License-Identifier: MIT
// Log download and log streaming as a client sees them. Expected answers: MAVLink guide, "Log transfer protocol"; the
// formats of the logs from the PX4 guide and ArduPilot's developer documentation.
#include <gmock/gmock.h>

#include <bit>
#include <map>
#include <set>

#include "mavloom/msg/log_data.hpp"
#include "mavloom/msg/log_entry.hpp"
#include "mavloom/msg/log_erase.hpp"
#include "mavloom/msg/log_request_data.hpp"
#include "mavloom/msg/log_request_end.hpp"
#include "mavloom/msg/log_request_list.hpp"
#include "mavloom/msg/logging_ack.hpp"
#include "mavloom/msg/logging_data.hpp"
#include "mavloom/msg/logging_data_acked.hpp"
#include "mavloom/msg/remote_log_block_status.hpp"
#include "mavloom/msg/remote_log_data_block.hpp"
#include "sim/store/log_stream.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim::log_tests {
namespace {

using namespace msg;
using test::Peer;
using test::Rig;
using Bytes = std::vector<std::uint8_t>;

VehicleOptions options_with(std::size_t logs, Autopilot autopilot = Autopilot::px4) {
    VehicleOptions options;
    options.autopilot = autopilot;
    options.logs = logs;
    options.utc_at_start = WallTime{std::chrono::seconds{1795222314}};
    return options;
}

void request_list(Rig& rig, std::uint16_t start = 0, std::uint16_t end = 0xffff, const Peer& peer = {}) {
    rig.send(LogRequestList{.target_system = 1, .target_component = 1, .start = start, .end = end}, peer);
    rig.run(0.1);
}

void request_data(Rig& rig, std::uint16_t id, std::uint32_t offset, std::uint32_t count, const Peer& peer = {}) {
    rig.send(LogRequestData{.target_system = 1, .target_component = 1, .id_ = id, .ofs = offset, .count = count}, peer);
}

Bytes download(Rig& rig, std::uint16_t id) {
    rig.forget();
    request_data(rig, id, 0, 0xffffffff);
    rig.run(5.0);
    Bytes content;
    for (const auto& piece : rig.all<LogData>()) {
        EXPECT_EQ(piece.id_, id);
        EXPECT_EQ(piece.ofs, content.size()) << "in order, without gaps";
        content.insert(content.end(), piece.data.begin(), piece.data.begin() + piece.count);
    }
    return content;
}

TEST(LogService, ListsItsLogs) {
    Rig rig(options_with(3));

    request_list(rig);

    const auto entries = rig.all<LogEntry>();
    ASSERT_EQ(entries.size(), 3u);
    for (std::uint16_t i = 0; i < 3; ++i) {
        EXPECT_EQ(entries[i].id_, i);
        EXPECT_EQ(entries[i].num_logs, 3);
        EXPECT_EQ(entries[i].last_log_num, 3);
        EXPECT_GE(entries[i].size, 20'000u);
        EXPECT_LE(entries[i].size, 220'000u);
    }
    EXPECT_EQ(entries[2].time_utc, 1795222314u);
    EXPECT_LT(entries[0].time_utc, entries[1].time_utc);
    rig.forget();
    request_list(rig, 1, 1);
    ASSERT_EQ(rig.all<LogEntry>().size(), 1u);
    EXPECT_EQ(rig.last<LogEntry>()->id_, 1);
}

TEST(LogService, ArduPilotCountsFromOne) {
    Rig rig(options_with(2, Autopilot::ardupilot));

    request_list(rig);

    const auto entries = rig.all<LogEntry>();
    ASSERT_EQ(entries.size(), 2u);
    EXPECT_EQ(entries[0].id_, 1);
    EXPECT_EQ(entries[1].id_, 2);
    EXPECT_EQ(entries[1].last_log_num, 2);
}

TEST(LogService, OneEntryReportsThatThereAreNoLogs) {
    Rig rig(options_with(0));

    request_list(rig);

    const auto entries = rig.all<LogEntry>();
    ASSERT_EQ(entries.size(), 1u);
    EXPECT_EQ(entries[0], LogEntry{});
}

TEST(LogService, SendsWholeLogsInPiecesOf90Bytes) {
    Rig rig(options_with(2));
    request_list(rig);
    const auto entries = rig.all<LogEntry>();

    const Bytes first = download(rig, 0), second = download(rig, 1);

    EXPECT_EQ(first.size(), entries[0].size);
    EXPECT_EQ(second.size(), entries[1].size);
    EXPECT_NE(first, second);
    EXPECT_EQ(download(rig, 0), first) << "the content stays";
    const auto pieces = rig.all<LogData>();
    for (std::size_t i = 0; i + 1 < pieces.size(); ++i) EXPECT_EQ(pieces[i].count, 90);
}

TEST(LogService, SendsTheRangeThatWasAskedFor) {
    Rig rig(options_with(1));
    const Bytes whole = download(rig, 0);
    rig.forget();

    request_data(rig, 0, 11'520, 250);
    rig.run(0.1);

    const auto pieces = rig.all<LogData>();
    ASSERT_EQ(pieces.size(), 3u);
    EXPECT_EQ(pieces[2].ofs, 11'520u + 180);
    EXPECT_EQ(pieces[2].count, 70);
    EXPECT_TRUE(std::equal(pieces[0].data.begin(), pieces[0].data.end(), whole.begin() + 11'520));
}

TEST(LogService, AnswersWhatItDoesNotHaveWithNoBytes) {
    Rig rig(options_with(1));
    for (const auto& [id, offset, count] :
         {std::tuple{0, 0xffffffffu, 90u}, {7, 0u, 90u}, {65535, 0u, 90u}, {0, 0u, 0u}}) {
        rig.forget();
        request_data(rig, static_cast<std::uint16_t>(id), offset, count);
        rig.run(0.1);
        ASSERT_EQ(rig.all<LogData>().size(), 1u) << id;
        EXPECT_EQ(rig.last<LogData>()->count, 0);
        EXPECT_EQ(rig.last<LogData>()->id_, id);
        EXPECT_EQ(rig.last<LogData>()->ofs, offset);
    }
}

TEST(LogService, StopsWhenTheClientHasEnough) {
    Rig rig(options_with(1));
    request_data(rig, 0, 0, 0xffffffff);
    rig.run(0.011);
    rig.send(LogRequestEnd{.target_system = 1, .target_component = 1});
    rig.forget();
    rig.run(1.0);

    EXPECT_TRUE(rig.all<LogData>().empty());
}

TEST(LogService, ANewRequestReplacesTheOldOneOfItsClientOnly) {
    const Peer other{LinkId{2}, {SystemId{245}, ComponentId{190}}};
    Rig rig(options_with(1));
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    rig.sink.full = {1, 2};
    request_data(rig, 0, 0, 0xffffffff);
    request_data(rig, 0, 900, 90, other);
    request_data(rig, 0, 9000, 180);
    rig.sink.full = {};
    rig.run(1.0);

    EXPECT_EQ(rig.all<LogData>().size(), 2u);
    ASSERT_EQ(rig.all<LogData>(LinkId{2}).size(), 1u);
    EXPECT_EQ(rig.last<LogData>(LinkId{2})->ofs, 900u);
}

TEST(LogService, WaitsWhileTheLinkIsFull) {
    Rig rig(options_with(1));
    rig.sink.full = {1};
    request_data(rig, 0, 0, 900);
    rig.run(1.0);
    EXPECT_TRUE(rig.all<LogData>().empty());

    rig.sink.full = {};
    rig.run(0.1);
    EXPECT_EQ(rig.all<LogData>().size(), 10u);
}

TEST(LogService, ErasesAllLogs) {
    Rig rig(options_with(2));
    rig.send(LogErase{.target_system = 1, .target_component = 1});
    request_list(rig);

    ASSERT_EQ(rig.all<LogEntry>().size(), 1u);
    EXPECT_EQ(rig.last<LogEntry>()->num_logs, 0);
    request_data(rig, 0, 0, 90);
    rig.run(0.1);
    EXPECT_EQ(rig.last<LogData>()->count, 0);
}

TEST(LogService, IgnoresAnEndWithoutABeginning) {
    Rig rig(options_with(2));
    rig.send(LogRequestEnd{.target_system = 1, .target_component = 1});
    rig.forget();
    rig.run(0.2);

    EXPECT_TRUE(rig.all<LogEntry>().empty());
}

TEST(LogService, LimitsTheClients) {
    VehicleOptions options = options_with(1);
    options.limits.clients = 1;
    Rig rig(options);
    rig.sink.full = {1};
    request_data(rig, 0, 0, 900, {LinkId{1}, {SystemId{201}, ComponentId{1}}});
    request_data(rig, 0, 0, 900, {LinkId{1}, {SystemId{202}, ComponentId{1}}});

    ASSERT_EQ(rig.all<LogData>().size(), 1u);
    EXPECT_EQ(rig.last<LogData>()->count, 0);
}

TEST(LogService, AClientWithManyIdsKeepsNoOtherLinkOut) {
    VehicleOptions options = options_with(1);
    options.limits.clients = 2;
    Rig rig(options);
    rig.vehicle.open(LinkId{2}, {}, rig.now());
    rig.sink.full = {1};
    for (const auto system : {std::uint8_t{201}, std::uint8_t{202}, std::uint8_t{203}})
        request_data(rig, 0, 0, 900, {LinkId{1}, {SystemId{system}, ComponentId{1}}});

    request_data(rig, 0, 0, 90, {LinkId{2}, {SystemId{201}, ComponentId{1}}});

    ASSERT_EQ(rig.all<LogData>(LinkId{2}).size(), 1u);
    EXPECT_EQ(rig.last<LogData>(LinkId{2})->count, 90);
}

// --- Formats

TEST(RecordedLogs, Px4WritesULog) {
    Rig rig(options_with(1));
    const Bytes log = download(rig, 0);
    const Bytes magic{0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35, 0x01};
    ASSERT_TRUE(std::equal(magic.begin(), magic.end(), log.begin()));

    std::map<char, int> types;
    std::uint64_t last_time = 0;
    std::size_t at = 16;
    for (; at + 3 <= log.size();) {
        const std::size_t size = load_le<std::uint16_t>(log.data() + at);
        const char type = static_cast<char>(log[at + 2]);
        ++types[type];
        ASSERT_LE(at + 3 + size, log.size());
        if (type == 'D') {
            ASSERT_EQ(size, 2u + 8 + 8 + 16);  // vehicle_attitude: id, timestamp, timestamp_sample, q
            const auto time = load_le<std::uint64_t>(log.data() + at + 5);
            EXPECT_TRUE(types['D'] == 1 || time > last_time);
            last_time = time;
        }
        at += 3 + size;
    }
    EXPECT_EQ(at, log.size()) << "the log ends with a whole message";
    EXPECT_EQ(types['F'], 1);
    EXPECT_EQ(types['A'], 1);
    EXPECT_GT(types['D'], 500);
}

TEST(RecordedLogs, ArduPilotWritesDataFlash) {
    Rig rig(options_with(1, Autopilot::ardupilot));
    const Bytes log = download(rig, 1);
    std::map<std::uint8_t, std::size_t> lengths{{128, 89}};
    std::size_t at = 0, records = 0;
    float highest_yaw = 0;
    while (at + 3 <= log.size()) {
        ASSERT_EQ(log[at], 0xa3);
        ASSERT_EQ(log[at + 1], 0x95);
        const std::uint8_t type = log[at + 2];
        ASSERT_TRUE(lengths.contains(type)) << int{type};
        if (type == 128) lengths[log[at + 3]] = log[at + 4];
        if (type == 135)
            highest_yaw = std::max(highest_yaw, std::bit_cast<float>(load_le<std::uint32_t>(&log[at + 19])));
        at += lengths[type];
        ++records;
    }
    EXPECT_EQ(at, log.size());
    EXPECT_GT(records, 500u);
    EXPECT_GT(highest_yaw, 350) << "degrees";
    EXPECT_LT(highest_yaw, 360);
}

// --- Streaming by PX4

class Px4LogStream : public testing::Test {
protected:
    struct Null final : Sink {
        void send(LinkId /*link*/, const wire::FrameView& frame) override {
            if (frame.id() == LoggingDataAcked::id) acked.push_back(LoggingDataAcked::decode(frame.payload()));
            if (frame.id() == LoggingData::id) plain.push_back(LoggingData::decode(frame.payload()));
        }
        bool has_room(LinkId /*link*/) const override { return true; }
        std::vector<LoggingDataAcked> acked;
        std::vector<LoggingData> plain;
    };
    Px4LogStream() { radio.open(LinkId{1}); }
    void run(double seconds) {
        for (double passed = 0; passed < seconds; passed += 0.01) {
            time += std::chrono::milliseconds{10};
            streams.pump(now());
        }
    }
    Moment now() const { return {time, MonoTime{time}}; }
    void acknowledge(std::uint16_t sequence) {
        std::array<std::uint8_t, LoggingAck::max_length> payload;
        LoggingAck{.target_system = 1, .target_component = 1, .sequence = sequence}.encode(payload);
        streams.on_logging_ack(client, payload);
    }

    const Client client{LinkId{1}, {SystemId{255}, ComponentId{190}}};
    FlightTime time{};
    Null sink;
    Radio radio{SystemId{1}, sink};
    LogStreams streams{true, SystemId{1}, 2, radio};
};

TEST_F(Px4LogStream, WaitsForTheAcknowledgementOfTheHeader) {
    ASSERT_EQ(streams.start(client, now()), Result::accepted);
    run(1.0);
    ASSERT_GE(sink.acked.size(), 9u) << "it repeats";
    ASSERT_LE(sink.acked.size(), 11u);
    EXPECT_TRUE(sink.plain.empty());
    EXPECT_EQ(sink.acked[0].sequence, 0);
    EXPECT_EQ(sink.acked[0].first_message_offset, 0);
    EXPECT_EQ(sink.acked[0].target_system, 255);
    EXPECT_EQ(sink.acked[0], sink.acked.back());
    EXPECT_EQ(sink.acked[0].data[0], 0x55);

    acknowledge(7);
    run(0.2);
    EXPECT_TRUE(sink.plain.empty()) << "that was another message";
    acknowledge(0);
    run(10.0);

    ASSERT_FALSE(sink.plain.empty());
    Bytes log(sink.acked[0].data.begin(), sink.acked[0].data.begin() + sink.acked[0].length);
    std::uint16_t sequence = 1;
    for (const auto& message : sink.plain) {
        EXPECT_EQ(message.sequence, sequence++);
        EXPECT_EQ(message.length, 249);
        // A reader that lost messages finds the next record by this offset.
        const auto* const record = message.data.data() + message.first_message_offset;
        EXPECT_TRUE(message.first_message_offset >= 247 || record[2] == 'D');
        log.insert(log.end(), message.data.begin(), message.data.end());
    }
    // 50 records of 37 bytes a second.
    EXPECT_NEAR(static_cast<double>(log.size()), 11 * 50 * 37, 900);
}

TEST_F(Px4LogStream, GivesUpWithoutAcknowledgement) {
    ASSERT_EQ(streams.start(client, now()), Result::accepted);
    run(10.0);

    EXPECT_FALSE(streams.is_busy());
    EXPECT_EQ(sink.acked.size(), 50u);
}

TEST_F(Px4LogStream, LimitsTheClientsAndStops) {
    const Client second{LinkId{1}, {SystemId{1}, ComponentId{195}}}, third{LinkId{1}, {SystemId{2}, ComponentId{195}}};
    EXPECT_EQ(streams.start(client, now()), Result::accepted);
    EXPECT_EQ(streams.start(client, now()), Result::accepted) << "starts again";
    EXPECT_EQ(streams.start(second, now()), Result::accepted);
    EXPECT_EQ(streams.start(third, now()), Result::temporarily_rejected);
    streams.stop(client);
    EXPECT_EQ(streams.start(third, now()), Result::accepted);
    streams.stop(second);
    streams.stop(third);
    EXPECT_FALSE(streams.is_busy());
}

// --- Streaming by ArduPilot

class RemoteLog : public testing::Test {
protected:
    static constexpr std::uint32_t start = 2147483646, stop = 2147483645;
    void status(std::uint32_t seq, bool is_ack = true) {
        rig.send(RemoteLogBlockStatus{.target_system = 1, .target_component = 1, .seqno = seq, .status = is_ack});
    }
    Rig rig{options_with(1, Autopilot::ardupilot)};
};

TEST_F(RemoteLog, SendsBlocksFromTheBeginningOfTheLog) {
    status(start);
    Bytes log;
    for (int i = 0; i < 200; ++i) {
        rig.run(0.05);
        for (const auto& block : rig.all<RemoteLogDataBlock>()) {
            if (block.seqno * 200u == log.size()) log.insert(log.end(), block.data.begin(), block.data.end());
            status(block.seqno);
        }
        rig.forget();
    }

    // 50 records of 23 bytes a second, after the definitions.
    EXPECT_GT(log.size(), 10u * 50 * 23);
    EXPECT_LT(log.size(), 10u * 50 * 23 + 3000);
    ASSERT_GE(log.size(), 3u);
    EXPECT_EQ(log[0], 0xa3);
    EXPECT_EQ(log[2], 128);
}

TEST_F(RemoteLog, RepeatsBlocksThatAreMissedAndLimitsThoseOnTheWay) {
    status(start);
    rig.run(8.0);
    std::set<std::uint32_t> seqs;
    for (const auto& block : rig.all<RemoteLogDataBlock>()) seqs.insert(block.seqno);
    EXPECT_EQ(seqs.size(), 16u);
    EXPECT_EQ(*seqs.rbegin(), 15u);

    rig.forget();
    status(3, false);
    ASSERT_EQ(rig.all<RemoteLogDataBlock>().size(), 1u);
    EXPECT_EQ(rig.last<RemoteLogDataBlock>()->seqno, 3u);
    status(99, false);
    EXPECT_EQ(rig.all<RemoteLogDataBlock>().size(), 1u) << "that block was never sent";
}

TEST_F(RemoteLog, EndsWhenTheClientStopsOrFallsSilent) {
    status(start);
    rig.run(0.5);
    status(stop);
    rig.forget();
    rig.run(1.0);
    EXPECT_TRUE(rig.all<RemoteLogDataBlock>().empty());

    status(start);
    rig.run(11.0);
    rig.forget();
    rig.run(1.0);
    EXPECT_TRUE(rig.all<RemoteLogDataBlock>().empty());
}

}  // namespace
}  // namespace mavloom::sim::log_tests
