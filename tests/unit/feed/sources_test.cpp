// SPDX-License-Identifier: MIT
#include "mavloom/feed/sources.hpp"

#include "unit/link/fixture.hpp"

namespace mavloom::feed {
namespace {

using link::testing::heartbeat;
using link::testing::PlainSocket;
using link::testing::Recorder;

TEST(SourcesDrain, EndsAlthoughFramesKeepComing) {
    auto sources = Sources::create(dialect::default_dialect());
    ASSERT_TRUE(sources);
    ASSERT_TRUE(sources->add(link::testing::endpoint_of("udpin://127.0.0.1:0"), mono_now()));
    const auto port = sources->links().endpoints().at(0).local_port;
    const auto peer = PlainSocket::udp();
    constexpr std::size_t arrived = 6000;  // more than a drain reads of what comes later
    constexpr std::uint8_t early = 1, late = 2;
    for (std::size_t i = 0; i < arrived; ++i) peer.send_to(port, heartbeat(static_cast<std::uint8_t>(i), early));
    Recorder recorder;
    recorder.answer = [&](const link::RxFrame&) {
        peer.send_to(port, heartbeat(0, late));
    };  // for each that is read another one comes
    int turns = 0;
    sources->drain(recorder, [&] {
        ++turns;
        return Room(0);
    });

    sources->links().refresh_counters();
    const auto dropped = sources->links().endpoints().at(0).counters->kernel_drop.value();
    const auto heard = std::ranges::count_if(recorder.frames, [&](const auto& f) { return f.bytes[5] == early; });
    EXPECT_GE(static_cast<std::uint64_t>(heard) + dropped, arrived);
    EXPECT_LT(turns, 500);
}

}  // namespace
}  // namespace mavloom::feed
