// SPDX-License-Identifier: MIT
#include "mavloom/link/silence_watch.hpp"

#include <gmock/gmock.h>

#include <string_view>

namespace mavloom::link {
namespace {

using namespace std::chrono_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr LinkId first{7}, second{8};
constexpr EndpointId px4{3};
constexpr MonoTime start{1000s};

endpoint::Endpoint parsed(std::string_view url) { return *endpoint::parse_endpoint(url); }

struct Silence : ::testing::Test {
    // How many reports the looks of so many seconds bring.
    std::size_t reports(Nanoseconds from, int seconds) {
        std::size_t count = 0;
        for (int i = 0; i < seconds; ++i)
            count += sut.look([this](LinkId id) { return id == first    ? &counters
                                                         : id == second ? &others
                                                                        : nullptr; },
                              start + from + i * 1s)
                         .size();
        return count;
    }
    void open(std::string_view url) { sut.add(px4, parsed(url), start); }
    void connect(Nanoseconds at = 0s) { sut.on_link_up(first, px4, start + at); }

    LinkCounters counters, others;
    SilenceWatch sut;
};

TEST_F(Silence, OfAnEndpointThatSendsNothingIsReportedOnceAndAgainAfterItSends) {
    open("udpout://127.0.0.1:1");
    connect();
    EXPECT_EQ(reports(0s, 5), 0u);
    EXPECT_EQ(reports(5s, 55), 1u);
    counters.frames_out.add();

    EXPECT_EQ(reports(60s, 5), 0u);
    EXPECT_EQ(reports(65s, 1), 1u);
    EXPECT_EQ(reports(66s, 60), 0u);
    connect(200s);
    EXPECT_EQ(reports(200s, 60), 0u);
}

TEST_F(Silence, OfAnEndpointThatSendsIsReportedOnce) {
    open("serial:///dev/ttyS0");
    connect();
    counters.frames_out.add();

    EXPECT_EQ(reports(0s, 5), 0u);
    EXPECT_EQ(reports(5s, 60), 1u);
}

TEST_F(Silence, OfAPortIsReportedOnceWithoutAnyPeer) {
    open("udpin://127.0.0.1:1");

    EXPECT_EQ(reports(0s, 5), 0u);
    EXPECT_EQ(reports(5s, 60), 1u);
}

TEST_F(Silence, BeginsWithTheConnection) {
    open("tcpout://127.0.0.1:1");
    EXPECT_EQ(reports(0s, 60), 0u) << "the link itself reports why it has no connection";
    connect(60s);

    EXPECT_EQ(reports(60s, 5), 0u);
    EXPECT_EQ(reports(65s, 60), 1u);
}

TEST_F(Silence, OfALinkThatWasHeardOnceIsNone) {
    open("udpout://127.0.0.1:1");
    connect();
    counters.frames_out.add();
    EXPECT_EQ(reports(0s, 3), 0u);
    counters.frames_in.add();

    EXPECT_EQ(reports(3s, 60), 0u);
}

TEST_F(Silence, EndsWithItsLinkAndItsEndpoint) {
    open("tcpout://127.0.0.1:1");
    connect();
    EXPECT_EQ(reports(0s, 3), 0u);
    sut.on_link_down(first, &counters);
    EXPECT_EQ(reports(3s, 60), 0u);
    connect(70s);
    sut.remove(px4);

    EXPECT_EQ(reports(70s, 60), 0u);
}

TEST_F(Silence, OfAPortIsNoneIfAnyClientWasHeard) {
    open("tcpin://127.0.0.1:1");
    connect();
    sut.on_link_up(second, px4, start);
    counters.frames_in.add();

    EXPECT_EQ(reports(0s, 60), 0u) << "only the newest client was looked at";
}

TEST_F(Silence, OfAPortIsNoneIfAClientThatWasHeardHasLeft) {
    open("tcpin://127.0.0.1:1");
    connect();
    sut.on_link_up(second, px4, start);
    counters.frames_in.add();
    sut.on_link_down(first, &counters);

    EXPECT_EQ(reports(0s, 60), 0u) << "it came and went between two looks";
}

TEST_F(Silence, OfAPortIsReportedIfNoClientThatLeftWasHeard) {
    open("tcpin://127.0.0.1:1");
    connect();
    sut.on_link_down(first, &counters);

    EXPECT_EQ(reports(0s, 60), 1u);
}

TEST_F(Silence, StartsOverWhileFramesAreRefused) {
    open("udpout://127.0.0.1:1");
    connect();
    counters.frames_out.add();
    EXPECT_EQ(reports(0s, 4), 0u);
    counters.refused.add();

    EXPECT_EQ(reports(4s, 5), 0u) << "the link itself reports that no program listens";
    EXPECT_EQ(reports(9s, 60), 1u);
}

TEST_F(Silence, OfRecordingsAndRingsIsNotWatched) {
    open("tlog:///tmp/x.tlog");
    open("shm://px4");

    EXPECT_EQ(reports(0s, 60), 0u);
}

struct Heard {
    LinkCounters link;
    EndpointCounters endpoint;
};

std::string text_of(std::string_view url, const Heard& heard = {}, bool has_link = true) {
    return silence_text({.id = px4, .endpoint = parsed(url), .local_port = 14550, .counters = &heard.endpoint},
                        has_link ? &heard.link : nullptr);
}

Heard sent() {
    Heard heard;
    heard.link.frames_out.add();
    return heard;
}

TEST(SilenceText, StatesWhatToLookAt) {
    EXPECT_THAT(text_of("udpout://127.0.0.1:18570?name=px4", sent()),
                AllOf(StartsWith("px4: nothing heard for 5 s; "), HasSubstr("127.0.0.1:18570"), HasSubstr("PX4")));
    EXPECT_THAT(text_of("serial:///dev/ttyACM0?baud=115200"), HasSubstr("115200 here"));
    EXPECT_THAT(text_of("tcpout://10.0.0.1:5760"), HasSubstr("10.0.0.1:5760 accepted the connection"));
    EXPECT_THAT(text_of("udpbcast://10.0.0.255:14550", sent()), HasSubstr("listen on port 14550"));
    EXPECT_THAT(text_of("udpmcast://239.255.145.50:14550"), HasSubstr("iface="));
    EXPECT_THAT(text_of("udpin://0.0.0.0:14550", {}, false),
                AllOf(HasSubstr("send to port 14550"), HasSubstr("firewall")));
    EXPECT_THAT(text_of("tcpin://0.0.0.0:14550", {}, false), HasSubstr("no client has connected to port 14550"));
    EXPECT_THAT(text_of("tcpin://0.0.0.0:14550"), HasSubstr("a client is connected"));
}

TEST(SilenceText, NamesTheEndpointThatNeverSends) {
    for (const auto* url : {"udpout://10.0.0.1:14555", "udpbcast://10.0.0.255:14555"})
        EXPECT_THAT(text_of(url), AllOf(HasSubstr("nothing was sent"), HasSubstr("use udpin://0.0.0.0:14555"))) << url;
    EXPECT_THAT(text_of("udpout://10.0.0.1:14555", sent()), Not(HasSubstr("udpin")));
}

TEST(SilenceText, NamesWhatCameInstead) {
    Heard junk, foreign, stray, moved;
    junk.link.junk_bytes.add(512);
    foreign.endpoint.gone.bad_signature.add(3);
    stray.endpoint.stray_bytes.add(40);
    moved.endpoint.wrong_peer.add(9);
    EXPECT_THAT(text_of("serial:///dev/ttyACM0", junk), AllOf(HasSubstr("512 bytes"), HasSubstr("baud=auto")));
    EXPECT_THAT(text_of("udpin://0.0.0.0:1", stray, false),
                AllOf(HasSubstr("not MAVLink (40 bytes"), HasSubstr("port")));
    EXPECT_THAT(text_of("udpin://0.0.0.0:1", foreign, false), HasSubstr("3 frames arrived without the signature"));
    EXPECT_THAT(text_of("udpout://127.0.0.1:1", moved), HasSubstr("9 datagrams came from an address other than"));
}

}  // namespace
}  // namespace mavloom::link
