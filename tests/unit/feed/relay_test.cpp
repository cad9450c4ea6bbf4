// SPDX-License-Identifier: MIT
#include "mavloom/feed/relay.hpp"

#include <atomic>
#include <limits>
#include <thread>

#include "unit/feed/sending_fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;
using link::testing::attitude;
using link::testing::heartbeat;
using std::chrono::seconds;

const std::filesystem::path flight = MAVLOOM_TEST_DATA "/px4_gcs_flight.tlog";
const std::filesystem::path session = MAVLOOM_TEST_DATA "/px4_gcs_session.tlog";

class Handler : public RelayHandler {
public:
    std::function<bool()> before_turn;  // true ends the relay
    int waits = 0, starts = 0;
    std::vector<std::string> ups, notices;

private:
    bool should_stop() override { return before_turn && before_turn(); }
    void on_waiting() override { ++waits; }
    void on_started() override { ++starts; }
    void on_link_up(std::string_view name) override { ups.emplace_back(name); }
    void on_notice(std::string_view text) override { notices.emplace_back(text); }
};

// A relay with its sources. Destinations are given as URLs.
struct Bench {
    explicit Bench(const edit::Options& edits = {})
        : sources(std::move(*Sources::create(dialect::default_dialect(), Copies::left_out))),
          stage(std::move(*edit::Stage::create(dialect::default_dialect(), edits))) {}

    std::uint16_t add_source(const std::string& url) {
        EXPECT_TRUE(sources.add(link::testing::endpoint_of(url), mono_now())) << url;
        return sources.recordings().empty() ? last_port(sources.links()) : std::uint16_t{0};
    }
    void send_to(const std::vector<std::string>& urls) { destinations = open(urls, sources.links()); }
    RelayOutcome run() { return Relay(sources, *destinations, *stage, handler).run(mono_now() + seconds(120)); }

    Sources sources;
    std::unique_ptr<edit::Stage> stage;
    std::optional<Destinations> destinations;
    Handler handler;
};

void expect_complete(const RelayOutcome& outcome) {
    EXPECT_FALSE(outcome.is_incomplete);
    EXPECT_FALSE(outcome.reached_no_destination);
    EXPECT_FALSE(outcome.write_error) << outcome.write_error->text;
    EXPECT_FALSE(outcome.read_error) << outcome.read_error->text;
}

TEST(Relay, EveryDestinationGetsARecordingOnceAndInOrder) {
    Bench bench;
    const test::TempDir dir;
    const auto first = PlainSocket::udp(), second = PlainSocket::udp();
    bench.add_source("tlog://" + flight.string());
    bench.send_to({udpout(first), udpout(second), "tlog://" + (dir / "copy.tlog").string()});
    Bytes heard_first, heard_second;
    bench.handler.before_turn = [&] {
        read_into(heard_first, first);
        read_into(heard_second, second);
        return false;
    };
    const auto outcome = bench.run();
    read_into(heard_first, first);
    read_into(heard_second, second);
    expect_complete(outcome);
    const Bytes frames = frames_of(flight);
    EXPECT_TRUE(heard_first == frames);
    EXPECT_TRUE(heard_second == frames);
    EXPECT_TRUE(test::content_of(dir / "copy.tlog") == test::content_of(flight));
    EXPECT_EQ(bench.destinations->given(), 40'087u);
    EXPECT_EQ(bench.stage->counters().reencoded.value() + bench.stage->counters().passed_untouched.value(), 40'087u);
    EXPECT_EQ(bench.handler.waits, 0);
}

TEST(Relay, AFullQueuePausesARecordingInsteadOfLosing) {
    Bench bench;
    bench.add_source("tlog://" + session.string());
    bench.send_to({"tcpin://127.0.0.1:0?queue_bytes=16k"});
    const auto peer = PlainSocket::connected_tcp(last_port(bench.sources.links()), 4096);
    Bytes heard;
    bool was_full = false;
    int turns = 0;
    bench.handler.before_turn = [&] {
        const bool is_full = bench.destinations->room_in_frames() == 0;
        was_full = was_full || is_full;
        if (++turns % 50 == 0 || is_full) read_into(heard, peer);
        return false;
    };
    bench.add_source("tlog://" + session.string());
    const auto outcome = bench.run();
    read_into(heard, peer);
    expect_complete(outcome);
    EXPECT_TRUE(was_full);
    EXPECT_EQ(bench.destinations->deliveries().at(0).dropped, 0u);
    EXPECT_EQ(heard.size(), 2 * frames_of(session).size());
}

TEST(Relay, ARecordingWaitsForAPeer) {
    Bench bench;
    bench.add_source("tlog://" + session.string());
    bench.send_to({"tcpin://127.0.0.1:0"});
    std::optional<PlainSocket> peer;
    Bytes heard;
    bench.handler.before_turn = [&] {
        if (!peer && bench.handler.waits != 0)
            peer.emplace(PlainSocket::connected_tcp(last_port(bench.sources.links())));
        if (peer) read_into(heard, *peer);
        return false;
    };
    const auto outcome = bench.run();
    read_into(heard, *peer);
    expect_complete(outcome);
    EXPECT_EQ(bench.handler.waits, 1);
    EXPECT_EQ(bench.handler.starts, 1);
    EXPECT_TRUE(heard == frames_of(session));
}

TEST(Relay, ARecordingThatIsStoppedAfterALossIsIncomplete) {
    Bench bench;
    bench.add_source("tlog://" + flight.string());
    bench.send_to({"tcpin://127.0.0.1:0"});
    std::optional<PlainSocket> peer(PlainSocket::connected_tcp(last_port(bench.sources.links())));
    bench.handler.before_turn = [&] {
        if (bench.destinations->given() != 0) peer.reset();
        return bench.destinations->deliveries().at(0).nobody_there != 0;
    };
    const auto outcome = bench.run();
    EXPECT_LT(bench.destinations->given(), 40'087u);
    EXPECT_TRUE(outcome.is_incomplete);
}

TEST(Relay, ARecordingForWhichNobodyComesReachesNobody) {
    Bench bench;
    bench.add_source("tlog://" + session.string());
    bench.send_to({"tcpin://127.0.0.1:0"});
    bench.handler.before_turn = [&] { return bench.handler.waits != 0; };
    const auto outcome = bench.run();
    EXPECT_TRUE(outcome.reached_no_destination);
    EXPECT_EQ(bench.destinations->given(), 0u);
}

TEST(Relay, ARateLimitPassesItsShareOfTheFramesTimes) {
    Bench bench({.max_rate = {"ATTITUDE:10"}});
    const test::TempDir dir;
    Bytes recording, expected;
    for (std::uint8_t i = 0; i < 100; ++i) {  // 20 Hz of ATTITUDE, of which every second one passes, and 2 Hz beside it
        append(recording, record(at_ms(1000 + 50 * i), attitude(i)));
        if (i % 2 == 0) append(expected, attitude(i));
        if (i % 10 != 9) continue;
        append(recording, record(at_ms(1000 + 50 * i + 1), heartbeat(i)));
        append(expected, heartbeat(i));
    }
    test::write_file(dir / "in.tlog", recording);
    const auto peer = PlainSocket::udp();
    bench.add_source("tlog://" + (dir / "in.tlog").string());
    bench.send_to({udpout(peer)});
    expect_complete(bench.run());
    Bytes heard;
    read_into(heard, peer);
    EXPECT_EQ(heard, expected);
    EXPECT_EQ(bench.stage->counters().rate_limited.value(), 50u);
}

TEST(Relay, TheEndSendsWhatHadArrived) {
    Bench bench;
    const auto port = bench.add_source("udpin://127.0.0.1:0");
    const auto vehicle = PlainSocket::udp(), station = PlainSocket::udp();
    bench.send_to({udpout(station)});
    Bytes frames;
    for (std::uint8_t i = 0; i < 100; ++i) {
        vehicle.send_to(port, heartbeat(i));
        append(frames, heartbeat(i));
    }
    bench.handler.before_turn = [] { return true; };
    expect_complete(bench.run());
    Bytes heard;
    read_into(heard, station);
    EXPECT_EQ(heard, frames);
}

TEST(Relay, TheEndWaitsForAQueueThatIsFull) {
    Bench bench;
    bench.add_source("tlog://" + flight.string());
    bench.send_to({"tcpin://127.0.0.1:0?queue_bytes=16k"});
    const auto peer = PlainSocket::connected_tcp(last_port(bench.sources.links()), 4096);
    Bytes heard;
    std::atomic<std::uint64_t> sent = std::numeric_limits<std::uint64_t>::max();  // unknown until the end
    std::thread reader;
    bench.handler.before_turn = [&] {
        const bool is_full = bench.destinations->room_in_frames() == 0;
        if (!is_full || reader.joinable()) return is_full;
        reader = std::thread([&] {  // reads again only after the relay began to end
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
            for (; heard.size() < sent; std::this_thread::yield()) read_into(heard, peer);
        });
        return true;
    };
    const auto outcome = bench.run();
    const auto delivery = bench.destinations->deliveries().at(0);
    sent = delivery.bytes;
    ASSERT_TRUE(reader.joinable());
    reader.join();
    EXPECT_FALSE(outcome.reached_no_destination);
    EXPECT_FALSE(delivery.lost_any());
    EXPECT_EQ(delivery.frames, bench.destinations->given());
    Bytes begin = frames_of(flight);
    ASSERT_LT(heard.size(), begin.size());
    begin.resize(heard.size());
    EXPECT_TRUE(heard == begin);
}

TEST(Relay, AnswersGoBackToTheSource) {
    Bench bench({.remap_system = {"1=42"}});
    const auto port = bench.add_source("udpin://127.0.0.1:0");
    const auto vehicle = PlainSocket::udp();
    bench.send_to({"tcpin://127.0.0.1:0"});
    const auto station = PlainSocket::connected_tcp(last_port(bench.sources.links()));
    Bytes heard, answered;
    bench.handler.before_turn = [&] {
        if (heard.empty()) vehicle.send_to(port, heartbeat(0, 1));
        const bool is_first = heard.empty();
        read_into(heard, station);
        if (is_first && !heard.empty()) station.write(attitude(9, 255));
        read_into(answered, vehicle);
        return !answered.empty();
    };
    const auto outcome = bench.run();
    ASSERT_GE(heard.size(), heartbeat(0).size());
    EXPECT_EQ(Bytes(heard.begin(), heard.begin() + static_cast<std::ptrdiff_t>(heartbeat(0).size())), heartbeat(0, 42));
    EXPECT_EQ(answered, attitude(9, 255));
    EXPECT_EQ(outcome.unheard_answers, 0u);
}

TEST(Relay, AnswersForWhichThereIsNoSourceAreCounted) {
    Bench bench;
    bench.add_source("udpin://127.0.0.1:0");  // no peer yet
    bench.send_to({"tcpin://127.0.0.1:0"});
    const auto station = PlainSocket::connected_tcp(last_port(bench.sources.links()));
    for (std::uint8_t i = 0; i < 3; ++i) station.write(heartbeat(i, 255));
    bench.handler.before_turn = [&] { return bench.stage->counters().backward.value() == 3; };
    EXPECT_EQ(bench.run().unheard_answers, 3u);
}

TEST(Relay, AFileThatCannotBeWrittenEndsItAfterTheOthersGotTheirs) {
    Bench bench;
    bench.add_source("tlog://" + flight.string());
    const auto peer = PlainSocket::udp();
    bench.send_to({"tlog:///dev/full", udpout(peer)});
    Bytes heard;
    bench.handler.before_turn = [&] {
        read_into(heard, peer);
        return false;
    };
    const auto outcome = bench.run();
    read_into(heard, peer);
    ASSERT_TRUE(outcome.write_error);
    EXPECT_EQ(outcome.write_error->code, SetupCode::no_space);
    EXPECT_LT(bench.destinations->given(), 40'087u);
    EXPECT_EQ(bench.destinations->deliveries().at(0).frames, bench.destinations->given());
    Bytes begin = frames_of(flight);
    ASSERT_LT(heard.size(), begin.size());
    begin.resize(heard.size());
    EXPECT_TRUE(heard == begin);
    EXPECT_EQ(heard.size(), bench.destinations->deliveries().at(0).bytes);
}

// relay alone did not report it.
TEST(Relay, AFileThatIsGoneAtTheEndIsReported) {
    Bench bench;
    const test::TempDir dir;
    bench.add_source("tlog://" + flight.string());
    bench.send_to({"tlog://" + (dir / "copy.tlog").string()});
    bench.handler.before_turn = [&] {
        return bench.destinations->sent() != 0 && std::filesystem::remove(dir / "copy.tlog");
    };
    expect_complete(bench.run());

    const std::vector expected{(dir / "copy.tlog").string() + " was removed or replaced before it was complete"};
    EXPECT_EQ(bench.handler.notices, expected);
}

TEST(Relay, AnEmptyRecordingIsReported) {
    Bench bench;
    const test::TempDir dir;
    test::write_file(dir / "empty.tlog", Bytes{});
    const auto peer = PlainSocket::udp();
    bench.add_source("tlog://" + (dir / "empty.tlog").string());
    bench.send_to({udpout(peer)});
    const auto outcome = bench.run();
    EXPECT_FALSE(outcome.write_error);
    EXPECT_FALSE(outcome.is_incomplete);
    EXPECT_EQ(bench.handler.notices.size(), 1u);  // "… holds no frames"
}

}  // namespace
}  // namespace mavloom::feed
