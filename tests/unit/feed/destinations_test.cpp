// SPDX-License-Identifier: MIT
#include "mavloom/feed/destinations.hpp"

#include "mavloom/link/flush.hpp"
#include "unit/feed/sending_fixture.hpp"

namespace mavloom::feed {
namespace {

using namespace testing;
using link::testing::attitude;
using link::testing::heartbeat;
using link::testing::Node;
using link::testing::view;
using std::chrono::seconds;

constexpr auto longest_flush = seconds(60);

const auto no_notice = [](std::string_view text) { ADD_FAILURE() << text; };

// A port of this machine on which nobody listens.
std::uint16_t closed_port() { return PlainSocket::udp().port(); }

TEST(Destinations, EachGetsEveryFrameOnceAndInOrder) {
    Node node;
    const test::TempDir dir;
    const auto first = PlainSocket::udp(), second = PlainSocket::udp();
    auto sut = open({udpout(first), "tlog://" + (dir / "all.tlog").string(), udpout(second)}, *node.links);
    Bytes frames, records;
    for (std::uint8_t i = 0; i < 100; ++i) {
        const Bytes frame = i % 10 == 0 ? heartbeat(i) : attitude(i);
        append(frames, frame);
        append(records, record(at_ms(1000 + i), frame));
        EXPECT_TRUE(sut.send(view(frame), at_ms(1000 + i)));
    }
    link::flush(*node.links, node.recorder, longest_flush);
    ASSERT_TRUE(sut.close(no_notice));

    Bytes heard_first, heard_second;
    read_into(heard_first, first);
    read_into(heard_second, second);
    EXPECT_EQ(heard_first, frames);
    EXPECT_EQ(heard_second, frames);
    EXPECT_EQ(test::content_of(dir / "all.tlog"), records);
    EXPECT_EQ(sut.given(), 100u);
    EXPECT_EQ(sut.sent(), 100u);
    ASSERT_EQ(sut.deliveries().size(), 2u);
    for (const auto& delivery : sut.deliveries()) {
        EXPECT_EQ(delivery.frames, 100u);
        EXPECT_EQ(delivery.bytes, frames.size());
        EXPECT_FALSE(delivery.lost_any());
    }
    ASSERT_EQ(sut.files().size(), 1u);
    EXPECT_EQ(sut.files()[0].written_records(), 100u);
    EXPECT_FALSE(sut.lost_any());
    EXPECT_FALSE(sut.reached_no_destination());
}

TEST(Destinations, FramesWithoutAPeerAreCountedAndReachNobody) {
    Node node;
    auto sut = open({"tcpin://127.0.0.1:0"}, *node.links);
    EXPECT_FALSE(sut.all_up());
    for (std::uint8_t i = 0; i < 3; ++i) EXPECT_FALSE(sut.send(view(heartbeat(i)), {}));
    EXPECT_EQ(sut.given(), 3u);
    EXPECT_EQ(sut.sent(), 0u);
    EXPECT_EQ(sut.deliveries().at(0).nobody_there, 3u);
    EXPECT_TRUE(sut.lost_any());
    EXPECT_TRUE(sut.reached_no_destination());

    const auto peer = PlainSocket::connected_tcp(last_port(*node.links));
    ASSERT_TRUE(link::testing::until([&] { return sut.all_up(); }, node));
    EXPECT_TRUE(sut.send(view(heartbeat(3)), {}));
    link::flush(*node.links, node.recorder, longest_flush);
    EXPECT_EQ(peer.read(), heartbeat(3));
    EXPECT_EQ(sut.deliveries().at(0).frames, 1u);
    EXPECT_TRUE(sut.lost_any());
    EXPECT_FALSE(sut.reached_no_destination());
}

TEST(Destinations, OneThatRefusesLeavesTheOthers) {
    Node node;
    const auto peer = PlainSocket::udp();
    auto sut = open({"udpout://127.0.0.1:" + std::to_string(closed_port()), udpout(peer)}, *node.links);
    Bytes frames;
    std::uint8_t next = 0;
    ASSERT_TRUE(link::testing::until(
        [&] {
            if (next < 50) {
                append(frames, heartbeat(next));
                sut.send(view(heartbeat(next)), {});
                ++next;
            }
            return next == 50 && !node.links->pending() && sut.deliveries().at(0).send_errors != 0;
        },
        node));
    Bytes heard;
    read_into(heard, peer);
    EXPECT_EQ(heard, frames);
    EXPECT_TRUE(sut.deliveries().at(0).lost_any());
    EXPECT_NE(sut.deliveries().at(0).refused, 0u);
    EXPECT_FALSE(sut.deliveries().at(1).lost_any());
    EXPECT_TRUE(sut.lost_any());
}

TEST(Destinations, AFileThatCannotBeWrittenLeavesTheOthers) {
    Node node;
    const test::TempDir dir;
    const auto peer = PlainSocket::udp();
    auto sut = open({"tlog:///dev/full", udpout(peer), "tlog://" + (dir / "good.tlog").string()}, *node.links);
    Bytes frames, records, heard;
    constexpr std::uint64_t most = 100'000;  // far more than any buffer of a file holds
    while (!sut.failed() && sut.given() < most) {
        const Bytes frame = attitude(static_cast<std::uint8_t>(sut.given()));
        append(frames, frame);
        append(records, record(at_ms(7), frame));
        EXPECT_TRUE(sut.send(view(frame), at_ms(7)));
        node.poll();
        read_into(heard, peer);
    }
    ASSERT_TRUE(sut.failed());
    link::flush(*node.links, node.recorder, longest_flush);
    const auto closed = sut.close(no_notice);
    ASSERT_FALSE(closed);
    EXPECT_EQ(closed.error().code, SetupCode::no_space);
    EXPECT_NE(closed.error().text.find("/dev/full"), std::string::npos);
    read_into(heard, peer);
    EXPECT_EQ(heard, frames);
    EXPECT_EQ(test::content_of(dir / "good.tlog"), records);
    EXPECT_NE(sut.files()[0].lost_records(), 0u);
    EXPECT_EQ(sut.files()[1].lost_records(), 0u);
}

// A recording that was deleted while a frame was still buffered.
struct DeletedRecording : ::testing::Test {
    DeletedRecording() {
        EXPECT_TRUE(sut.send(view(frame), at_ms(1000)));
        std::filesystem::remove(path);
    }
    ~DeletedRecording() override {
        EXPECT_EQ(notices, path + " was removed or replaced; a new file begins");
        EXPECT_EQ(test::content_of(path), record(at_ms(1000), frame));
    }
    void note(std::string_view text) { notices += text; }

    Node node;
    const test::TempDir dir;
    const std::string path = (dir / "x.tlog").string();
    decltype(open({}, *node.links)) sut = open({"tlog://" + path}, *node.links);
    const Bytes frame = attitude(1);
    std::string notices;
};

TEST_F(DeletedRecording, IsNoticedWhileOtherFramesMayCome) {
    sut.maintain_files(MonoTime{} + seconds(1), [&](std::string_view text) { note(text); });
    ASSERT_TRUE(sut.close(no_notice));
}

TEST_F(DeletedRecording, IsNoticedAtTheEnd) {
    ASSERT_TRUE(sut.close([&](std::string_view text) { note(text); }));
}

TEST(Destinations, TheRoomIsThatOfTheSmallestQueue) {
    Node node;
    const auto peer = PlainSocket::udp();
    const auto sut = open({udpout(peer) + "?queue_bytes=32k", udpout(peer) + "?queue_bytes=16k&name=small"},
                          *node.links);
    EXPECT_EQ(sut.room_in_frames(), 16u * 1024 / 512);  // half a KiB for the longest frame and its place in a queue
}

TEST(Destinations, ASourceThatKeepsToTheRoomLosesNothing) {
    Node node;
    auto sut = open({"tcpin://127.0.0.1:0?queue_bytes=16k"}, *node.links);
    const auto peer = PlainSocket::connected_tcp(last_port(*node.links), 4096);
    ASSERT_TRUE(link::testing::until([&] { return sut.all_up(); }, node));
    const std::size_t empty = sut.room_in_frames();
    Bytes frames, heard;
    int full = 0;
    for (int rounds = 0; full < 3; ++rounds) {
        ASSERT_LT(rounds, 100'000);
        for (std::size_t room = sut.room_in_frames(); room > 0; --room) {
            const Bytes frame = link::testing::frame_bytes(131, static_cast<std::uint8_t>(sut.given()));
            append(frames, frame);
            ASSERT_TRUE(sut.send(view(frame), {}));
        }
        node.poll();
        if (sut.room_in_frames() != 0) continue;
        ++full;
        ASSERT_TRUE(link::testing::until(
            [&] {
                read_into(heard, peer);
                return sut.room_in_frames() == empty;
            },
            node));
    }
    EXPECT_TRUE(link::testing::until(
        [&] {
            read_into(heard, peer);
            return heard.size() >= frames.size();
        },
        node));
    EXPECT_EQ(heard, frames);
    EXPECT_FALSE(sut.lost_any());
}

TEST(Destinations, AQueueSmallerThanAFrameTakesOneAtATime) {
    Node node;
    const auto peer = PlainSocket::udp();
    auto sut = open({udpout(peer) + "?queue_bytes=300"}, *node.links);
    EXPECT_EQ(sut.room_in_frames(), 1u);
    ASSERT_TRUE(sut.send(view(heartbeat(0)), {}));
    EXPECT_EQ(sut.room_in_frames(), 0u);
    link::flush(*node.links, node.recorder, longest_flush);
    EXPECT_EQ(sut.room_in_frames(), 1u);
}

TEST(Destinations, AFileThatWasThereIsRenamedOnlyIfEveryLinkOpens) {
    Node node;
    const test::TempDir dir;
    const Bytes old = link::testing::operator+(Bytes(8), heartbeat(1));  // a recording of one frame
    test::write_file(dir / "x.tlog", old);
    const auto url = "tlog://" + (dir / "x.tlog").string();
    const auto taken = PlainSocket::udp();
    const auto in_use = "udpin://127.0.0.1:" + std::to_string(taken.port());
    EXPECT_FALSE(Destinations::open(endpoints_of({url, in_use}), *node.links));
    EXPECT_EQ(test::content_of(dir / "x.tlog"), old);

    std::vector<std::filesystem::path> renamed;
    const auto opened = Destinations::open(endpoints_of({url}), *node.links,
                                           [&](const auto& file) { renamed.push_back(file.renamed_to()); });
    ASSERT_TRUE(opened);
    EXPECT_EQ(renamed, std::vector<std::filesystem::path>{dir / "x.tlog.1"});
    EXPECT_EQ(test::content_of(dir / "x.tlog.1"), old);
}

TEST(Destinations, ARecordingThatIsWrittenHasNoSpeed) {
    const auto refused = create_recording(link::testing::endpoint_of("tlog:///tmp/x.tlog?speed=2"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, SetupCode::usage);
    EXPECT_NE(refused.error().text.find("'speed'"), std::string::npos);
}

}  // namespace
}  // namespace mavloom::feed
