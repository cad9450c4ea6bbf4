// SPDX-License-Identifier: MIT
#include "mavloom/runtime/sources.hpp"

#include "links_fixture.hpp"

namespace mavloom::runtime {
namespace {

using runtime::testing::heartbeat;
using runtime::testing::PlainSocket;
using runtime::testing::Recorder;

TEST(SourcesDrain, EndsAlthoughFramesKeepComing) {
    auto sources = Sources::create(dialect::default_dialect());
    ASSERT_TRUE(sources);
    ASSERT_TRUE(sources->add(runtime::testing::endpoint_of("udpin://127.0.0.1:0"), mono_now()));
    const auto port = sources->links().endpoints().at(0).local_port;
    const auto peer = PlainSocket::udp();
    constexpr std::size_t arrived = 500;
    for (std::size_t i = 0; i < arrived; ++i) peer.send_to(port, heartbeat(static_cast<std::uint8_t>(i)));
    Recorder recorder;
    recorder.answer = [&](const RxFrame&) {
        peer.send_to(port, heartbeat(0));
    };  // for each that is read another one comes
    int turns = 0;
    sources->drain(recorder, [&] {
        ++turns;
        return Room(0);
    });

    EXPECT_GE(recorder.frames.size(), arrived);
    EXPECT_LT(turns, 200);
}

}  // namespace
}  // namespace mavloom::runtime
