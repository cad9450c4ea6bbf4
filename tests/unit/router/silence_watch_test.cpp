// SPDX-License-Identifier: MIT
#include "router/silence_watch.hpp"

#include <gmock/gmock.h>

#include <map>

namespace mavloom::router {
namespace {

using namespace std::chrono_literals;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

constexpr LinkId link{7};
constexpr link::EndpointId px4{3};
constexpr MonoTime silence_start{1000s};

struct Silence : testing::Test {
    // How many reports the looks of so many seconds bring.
    std::size_t reports(MonoTime from, int seconds) {
        std::size_t count = 0;
        for (int i = 0; i < seconds; ++i)
            count += sut.look([this](LinkId id) { return id == link ? &counters : nullptr; }, from + i * 1s).size();
        return count;
    }
    link::LinkCounters counters;
    SilenceWatch sut;
};

TEST_F(Silence, IsReportedOnceAfterFiveSecondsOfSending) {
    sut.add(link, px4);
    EXPECT_EQ(reports(silence_start, 60), 0u) << "nothing was sent yet";
    counters.frames_out.add();

    EXPECT_EQ(reports(silence_start + 60s, 5), 0u);
    EXPECT_EQ(reports(silence_start + 65s, 1), 1u);
    EXPECT_EQ(reports(silence_start + 66s, 60), 0u);
    sut.add(link, px4);  // it reconnected
    EXPECT_EQ(reports(silence_start + 200s, 60), 0u);
}

TEST_F(Silence, OfALinkThatWasHeardOnceIsNone) {
    sut.add(link, px4);
    counters.frames_out.add();
    EXPECT_EQ(reports(silence_start, 3), 0u);
    counters.frames_in.add();

    EXPECT_EQ(reports(silence_start + 3s, 60), 0u);
}

// The notice blamed a closed port although a program had been listening there for seconds.
TEST_F(Silence, BeginsWhenTheFarSideNoLongerRefuses) {
    sut.add(link, px4);
    for (int second = 0; second < 20; ++second) {
        counters.refused.add();
        counters.frames_out.add();
        EXPECT_EQ(reports(silence_start + second * 1s, 1), 0u) << second;
    }
    EXPECT_EQ(reports(silence_start + 20s, 4), 0u);
    EXPECT_EQ(reports(silence_start + 24s, 1), 1u);
}

TEST_F(Silence, EndsWithItsLink) {
    sut.add(link, px4);
    counters.frames_out.add();
    EXPECT_EQ(reports(silence_start, 3), 0u);
    sut.remove(link);

    EXPECT_EQ(reports(silence_start + 3s, 60), 0u);
}

TEST(SilenceText, IsExpectedIfTheEndpointInitiatesContact) {
    for (const auto* calls : {"udpout://127.0.0.1:1", "tcpout://127.0.0.1:1", "serial:///dev/ttyS0"})
        EXPECT_TRUE(expects_answer(*endpoint::parse_endpoint(calls))) << calls;
    for (const auto* not_expected : {"udpin://127.0.0.1:1", "tcpin://127.0.0.1:1", "udpout://127.0.0.1:1?tap=true"})
        EXPECT_FALSE(expects_answer(*endpoint::parse_endpoint(not_expected))) << not_expected;
}

std::string text_of(std::string_view url, const link::LinkCounters& heard = {}, std::uint64_t wrong_peer = 0) {
    link::EndpointCounters counters;
    counters.wrong_peer.add(wrong_peer);
    return silence_text({.id = px4, .endpoint = *endpoint::parse_endpoint(url), .counters = &counters}, heard);
}

TEST(SilenceText, StatesWhatToLookAt) {
    EXPECT_THAT(text_of("udpout://127.0.0.1:18570?name=px4"),
                AllOf(StartsWith("px4: nothing heard for 5 s; "), HasSubstr("127.0.0.1:18570"), HasSubstr("PX4")));
    EXPECT_THAT(text_of("serial:///dev/ttyACM0?baud=115200"), HasSubstr("115200 here"));
    EXPECT_THAT(text_of("tcpout://10.0.0.1:5760"), HasSubstr("10.0.0.1:5760 accepted the connection"));
    EXPECT_THAT(text_of("udpbcast://10.0.0.255:14550"), HasSubstr("listen on port 14550"));
    EXPECT_THAT(text_of("udpmcast://239.255.145.50:14550"), HasSubstr("iface="));
}

TEST(SilenceText, NamesWhatCameInstead) {
    link::LinkCounters junk, foreign;
    junk.junk_bytes.add(512);
    foreign.bad_signature.add(3);
    EXPECT_THAT(text_of("serial:///dev/ttyACM0", junk), AllOf(HasSubstr("512 bytes"), HasSubstr("baud=auto")));
    EXPECT_THAT(text_of("udpout://127.0.0.1:1", foreign), HasSubstr("3 frames arrived without the signature"));
    link::LinkCounters once_refused;
    once_refused.refused.add(2);
    EXPECT_THAT(text_of("udpout://127.0.0.1:1", once_refused), HasSubstr("does the far side listen on 127.0.0.1:1"));
    EXPECT_THAT(text_of("udpout://127.0.0.1:1", {}, 9), HasSubstr("9 datagrams came from an address other than"));
}

}  // namespace
}  // namespace mavloom::router
