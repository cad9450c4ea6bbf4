// SPDX-License-Identifier: MIT
#include <gmock/gmock.h>

#include "mavloom/msg/heartbeat.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

using test::Rig;

TEST(Streams, HeartbeatBeginsAtOnceAndKeepsItsRate) {
    Rig rig;

    rig.run(60.0);

    const auto beats = rig.all<msg::Heartbeat>();
    ASSERT_GE(beats.size(), 61u);
    EXPECT_EQ(rig.sink.frames.front().frame().id(), msg::Heartbeat::id);
    EXPECT_EQ(rig.sink.frames.front().at, FlightTime{0});
    EXPECT_EQ(beats.front().mavlink_version, 3);
}

}  // namespace
}  // namespace mavloom::sim
