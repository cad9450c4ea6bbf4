// SPDX-License-Identifier: MIT
#include "mavloom/link/silence_watch.hpp"

#include <gmock/gmock.h>

#include <array>
#include <string_view>
#include <utility>
#include <vector>

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

// An endpoint with up to two links. The second one, if there is one, is newer.
struct Watch {
    LinkCounters counters, others;
    SilenceWatch sut;
    MonoTime now = start;
};

void connect(Watch& w) { w.sut.on_link_up(first, px4, w.now); }
void connect_another(Watch& w) { w.sut.on_link_up(second, px4, w.now); }
void disconnect(Watch& w) { w.sut.on_link_down(first, &w.counters); }
void remove(Watch& w) { w.sut.remove(px4); }
void send(Watch& w) { w.counters.frames_out.add(); }
void be_refused(Watch& w) { w.counters.refused.add(); }
void hear(Watch& w) { w.counters.frames_in.add(); }

struct Case {
    std::string_view what, url;
    std::vector<std::pair<int, void (*)(Watch&)>> events;  // at these seconds
    std::vector<int> reports;
};

// Looks once a second, and returns the seconds of the reports.
std::vector<int> reports_of(const Case& c) {
    constexpr int seconds = 300;
    Watch w;
    std::vector<int> reports;
    w.sut.add(px4, parsed(c.url), w.now);
    const auto counters_of = [&w](LinkId id) { return id == first ? &w.counters : id == second ? &w.others : nullptr; };
    for (int passed = 0; passed < seconds; ++passed, w.now += 1s) {
        for (const auto& [at, happens] : c.events)
            if (at == passed) happens(w);
        for (const auto& silent : w.sut.poll(counters_of, w.now)) {
            EXPECT_EQ(silent.endpoint, px4);
            reports.push_back(passed);
        }
    }
    return reports;
}

TEST(Silence, IsReportedOnceAfterFiveSeconds) {
    const std::array cases{
        Case{"a port without any peer", "udpin://127.0.0.1:1", {}, {5}},
        Case{"a link that sends", "serial:///dev/ttyS0", {{0, connect}, {0, send}}, {5}},
        Case{"one that sends nothing, and again after it sends",
             "udpout://127.0.0.1:1",
             {{0, connect}, {60, send}, {200, connect}},
             {5, 65}},
        Case{"without a connection, the link itself reports why", "tcpout://127.0.0.1:1", {{60, connect}}, {65}},
        Case{"no link, no silence", "tcpout://127.0.0.1:1", {{0, connect}, {3, disconnect}}, {}},
        Case{"removed", "tcpout://127.0.0.1:1", {{0, connect}, {3, remove}}, {}},
        Case{"heard in time", "udpout://127.0.0.1:1", {{0, connect}, {0, send}, {3, hear}}, {}},
        Case{"a client that is not the newest was heard",
             "tcpin://127.0.0.1:1",
             {{0, connect}, {0, connect_another}, {0, hear}},
             {}},
        Case{"a client was heard that came and went between two looks",
             "tcpin://127.0.0.1:1",
             {{0, connect}, {0, connect_another}, {0, hear}, {0, disconnect}},
             {}},
        Case{"no client that left was heard", "tcpin://127.0.0.1:1", {{0, connect}, {0, disconnect}}, {5}},
        Case{"while frames are refused, the link itself reports that no program listens",
             "udpout://127.0.0.1:1",
             {{0, connect}, {0, send}, {4, be_refused}},
             {9}},
        Case{"refused from the first frame on",
             "udpout://127.0.0.1:1",
             {{0, connect}, {0, be_refused}, {3, be_refused}, {6, be_refused}},
             {11}},
        Case{"a recording", "tlog:///tmp/x.tlog", {}, {}},
        Case{"a ring", "shm://px4", {}, {}},
    };
    for (const auto& c : cases) EXPECT_EQ(reports_of(c), c.reports) << c.what;
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
    EXPECT_THAT(text_of("tcpin://0.0.0.0:14550", {}, false), HasSubstr("no client has connected to port 14550: does "));
    EXPECT_THAT(text_of("tcpin://0.0.0.0:14550"), HasSubstr("a client is connected"));
}

TEST(SilenceText, NamesTheEndpointThatNeverSends) {
    for (const auto* url : {"udpout://10.0.0.1:14555", "udpbcast://10.0.0.255:14555"})
        EXPECT_THAT(text_of(url), AllOf(HasSubstr("nothing was sent"), HasSubstr("use udpin://0.0.0.0:14555"))) << url;
    Heard refused;
    refused.link.refused.add();
    for (const auto& heard : {sent(), refused})
        EXPECT_THAT(text_of("udpout://10.0.0.1:14555", heard), Not(HasSubstr("udpin")));
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
