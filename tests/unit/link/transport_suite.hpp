// SPDX-License-Identifier: MIT
// What holds for every transport: one suite, run over each pair of a listening and a calling scheme. A program includes
// it in one file, and instantiates it with its pairs.
#pragma once

#include <thread>

#include "unit/link/fixture.hpp"

namespace mavloom::link::testing {

using ::testing::HasSubstr;
using ::testing::SizeIs;

struct Pair {
    const char* listening;
    const char* calling;
    const char* host;  // as in a URL
};
inline void PrintTo(const Pair& pair, std::ostream* out) {
    *out << pair.listening << '_' << pair.calling << '_' << pair.host;
}

class LinksTransport : public ::testing::TestWithParam<Pair> {
protected:
    std::string listen_url(std::uint16_t port = 0, std::string_view query = "") {
        return fmt::format("{}://{}:{}{}", GetParam().listening, GetParam().host, port, query);
    }
    std::string call_url(std::string_view query = "") {
        return fmt::format("{}://{}:{}{}", GetParam().calling, GetParam().host, near.port(in), query);
    }
    // Listens, calls, and sends one frame each way, so that both ends know each other.
    void marry() {
        in = near.add(listen_url());
        out = far.add(call_url());
        ASSERT_TRUE(until([&] { return !far.recorder.ups.empty(); }, near, far));
        ASSERT_EQ(far.links->send(out, view(heartbeat(0))), 1u);
        ASSERT_TRUE(until([&] { return near.recorder.frames.size() == 1; }, near, far));
        ASSERT_EQ(near.links->send(near.recorder.frames[0].link, view(heartbeat(100, 255))), 1u);
        ASSERT_TRUE(until([&] { return far.recorder.frames.size() == 1; }, near, far));
        near.recorder.frames.clear();
        far.recorder.frames.clear();
    }
    Node near, far;
    EndpointId in, out;
};

TEST_P(LinksTransport, CarriesFramesBothWaysByteForByte) {
    marry();
    Bytes sent;
    for (int i = 1; i <= 200; ++i) {
        const Bytes frame = i % 3 == 0 ? frame_bytes(131, static_cast<std::uint8_t>(i))
                                       : attitude(static_cast<std::uint8_t>(i));
        ASSERT_EQ(far.links->send(out, view(frame)), 1u);
        sent = std::move(sent) + frame;
    }
    ASSERT_TRUE(until([&] { return near.recorder.frames.size() == 200; }, near, far));
    EXPECT_EQ(near.recorder.bytes(), sent);
    ASSERT_EQ(near.links->send(in, view(attitude(101, 255))), 1u);
    ASSERT_TRUE(until([&] { return far.recorder.frames.size() == 1; }, near, far));
    EXPECT_EQ(far.recorder.bytes(), attitude(101, 255));
    EXPECT_TRUE(until([&] { return !far.links->pending(); }, near, far)) << "a thread may send them";
    EXPECT_EQ(far.links->queued_bytes(out), 0u);
}

TEST_P(LinksTransport, FramesOfStrangersLeaveLast) {
    marry();
    const LinkId to[] = {far.links->links().at(0).id};
    Bytes trusted, others;
    for (std::uint8_t i = 1; i <= 20; ++i) {
        far.links->forward(to, view(attitude(i)), Rank::stranger);
        far.links->forward(to, view(heartbeat(i, 9)), i % 2 == 0 ? Rank::own : Rank::verified);
        others = std::move(others) + attitude(i);
        trusted = std::move(trusted) + heartbeat(i, 9);
    }
    ASSERT_TRUE(until([&] { return near.recorder.frames.size() == 40; }, near, far));
    EXPECT_EQ(near.recorder.bytes(), trusted + others);
}

TEST_P(LinksTransport, FramesOfStrangersTakeNoRoomOfOthers) {
    in = near.add(listen_url());
    out = far.add(call_url("?queue_bytes=1000"));
    ASSERT_TRUE(until([&] { return !far.recorder.ups.empty(); }, near, far));
    const LinkId to[] = {far.links->links().at(0).id};
    for (int i = 0; i < 1000; ++i) far.links->forward(to, view(heartbeat(1)), Rank::stranger);

    const std::size_t most = 1000 / heartbeat(1).size();
    EXPECT_EQ(far.counters(to[0]).queue_bytes.value(), 1000 - most);
    for (std::size_t i = 0; i < most; ++i) EXPECT_EQ(far.links->send(to, view(heartbeat(1, 9))), 1u);
    EXPECT_EQ(far.counters(to[0]).queue_bytes.value(), 1000 - most);
    EXPECT_EQ(far.links->queued_bytes(out), 2 * most * heartbeat(1).size());
}

TEST_P(LinksTransport, CountsPerLink) {
    marry();
    const auto& counters = near.counters(near.links->links().at(0).id);
    EXPECT_EQ(counters.frames_in.value(), 1u);
    EXPECT_EQ(counters.bytes_in.value(), heartbeat(0).size());
    ASSERT_TRUE(until([&] { return counters.frames_out.value() == 1; }, near, far)) << "a thread may send it";
    EXPECT_EQ(counters.bytes_out.value(), heartbeat(0).size());
    for (const int sequence : {1, 5, 5, 4}) far.links->send(out, view(attitude(static_cast<std::uint8_t>(sequence))));
    ASSERT_TRUE(until([&] { return near.recorder.frames.size() == 4; }, near, far));
    EXPECT_EQ(counters.duplicate.value(), 1u);
    EXPECT_EQ(counters.late.value(), 1u);
    EXPECT_EQ(counters.lost.value(), 2u) << "2, 3 and 4 were missing, then 4 came late";
}

TEST_P(LinksTransport, NamesDistinguishPeers) {
    marry();
    Node third;
    const auto third_out = third.add(call_url());
    ASSERT_TRUE(until([&] { return !third.recorder.ups.empty(); }, near, third));
    third.links->send(third_out, view(heartbeat(0, 7)));
    ASSERT_TRUE(until([&] { return near.recorder.frames.size() == 1; }, near, third));
    const auto links = near.links->links();
    ASSERT_THAT(links, SizeIs(2));
    EXPECT_THAT(links[0].name, HasSubstr(listen_url(near.port(in)) + "#"));
    EXPECT_NE(links[0].name, links[1].name);
    EXPECT_EQ(near.links->link_name(links[1].id), links[1].name);
    EXPECT_EQ(far.links->links().at(0).name, call_url());
    EXPECT_EQ(near.links->send(in, view(heartbeat(1))), 2u);
}

TEST_P(LinksTransport, APortInUseIsAnErrorThatNamesIt) {
    marry();
    Node other;
    const auto error = other.refused(listen_url(near.port(in)));
    EXPECT_EQ(error.code, SetupCode::in_use);
    EXPECT_THAT(error.text, HasSubstr(listen_url(near.port(in))));
    EXPECT_THAT(error.text, HasSubstr("in use"));
}

TEST_P(LinksTransport, RemovingAnEndpointFreesItsPort) {
    marry();
    const std::uint16_t port = near.port(in);
    near.links->remove(in);
    EXPECT_THAT(near.links->links(), SizeIs(0));
    EXPECT_THAT(near.links->endpoints(), SizeIs(0));
    in = near.add(listen_url(port));
    EXPECT_TRUE(until([&] { return near.port(in) == port; }, near)) << "a name is looked up beside the turns";
}

TEST_P(LinksTransport, TheCallerFindsARestartedListenerAgain) {
    marry();
    const std::uint16_t port = near.port(in);
    near.links->remove(in);
    near.recorder.ups.clear();
    // Some calls meet nobody; they harm nothing.
    ASSERT_TRUE(until([&, turns = 0]() mutable { return far.links->send(out, view(attitude(1))), ++turns > 20; }, far));
    in = near.add(listen_url(port));
    near.recorder.frames.clear();
    ASSERT_TRUE(until([&] { return far.links->send(out, view(attitude(2))), !near.recorder.frames.empty(); }, near, far));
    ASSERT_THAT(near.recorder.ups, SizeIs(1));
    EXPECT_EQ(near.links->send(near.recorder.ups[0].first, view(heartbeat(3))), 1u);
    ASSERT_TRUE(until([&] { return !far.recorder.frames.empty(); }, near, far));
    EXPECT_EQ(far.recorder.frames[0].bytes, heartbeat(3));
}

TEST_P(LinksTransport, AnIdlePeerIsExpired) {
    in = near.add(listen_url(0, "?idle=50ms"));
    out = far.add(call_url());
    ASSERT_TRUE(until([&] { return !far.recorder.ups.empty(); }, near, far));
    far.links->send(out, view(heartbeat(0)));
    ASSERT_TRUE(until([&] { return !near.recorder.ups.empty(); }, near, far));
    ASSERT_TRUE(until([&] { return near.recorder.downs.size() == 1; }, near));
    EXPECT_EQ(near.recorder.downs[0].first, near.recorder.ups[0].first);
    EXPECT_EQ(near.recorder.downs[0].second, "idle");
    EXPECT_THAT(near.links->links(), SizeIs(0));
    EXPECT_EQ(near.links->send(near.recorder.ups[0].first, view(heartbeat(1))), 0u);
}

TEST_P(LinksTransport, LosesNothingAndKeepsOrderUnderLoad) {
    marry();
    constexpr int count = 20'000;
    int sent = 0;
    ASSERT_TRUE(until(
        [&] {
            // As fast as the queue takes it: a jam would drop, and this is not about jams.
            for (int i = 0; i < 100 && sent < count && far.links->queued_bytes(out) < 100'000; ++i, ++sent) {
                far.links->send(out, view(attitude(static_cast<std::uint8_t>(sent + 1))));
            }
            return near.recorder.frames.size() == count;
        },
        near, far));
    const auto& counters = near.counters(near.recorder.frames[0].link);
    EXPECT_EQ(counters.lost.value() + counters.late.value() + counters.duplicate.value() + counters.resync.value(), 0u);
    near.links->refresh_counters();
    EXPECT_EQ(near.info(in).counters->kernel_drop.value(), 0u);
}

TEST_P(LinksTransport, WakesFromAnotherThread) {
    marry();
    std::thread other([&] { near.links->wake(); });
    const MonoTime start = mono_now();
    near.links->turn(near.recorder, start + std::chrono::seconds(60));
    other.join();
    EXPECT_LT(mono_now() - start, std::chrono::seconds(30));
}

// The name of a pair's tests.
inline std::string name_of(const ::testing::TestParamInfo<Pair>& made) {
    const std::string_view host = made.param.host;
    const auto kind = host == "[::1]" ? "Ipv6" : host == "localhost" ? "Name" : "Ipv4";
    return fmt::format("{}To{}", made.param.calling, kind);
}

}  // namespace mavloom::link::testing
