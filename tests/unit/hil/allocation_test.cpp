// SPDX-License-Identifier: MIT
// Counts operator new: a pair allocates when it is made, never for a step or an answer.
#include <gtest/gtest.h>

#include "mavloom/hil/pair.hpp"
#include "mavloom/msg/hil_actuator_controls.hpp"
#include "mavloom/msg/hil_sensor.hpp"
#include "mavloom/wire/struct_frame.hpp"
#include "support/count_allocations.hpp"

namespace mavloom::hil {
namespace {

TEST(Pair, AllocatesNothingForAStep) {
    using Controls = msg::HilActuatorControls;
    MonoTime now{std::chrono::hours{1}};
    Pair sut({.rates = {.distance_hz = 100}, .speed = any_speed});
    sut.begin(now);
    const auto before = mavloom::test::allocations;

    std::size_t frames = 0;
    for (int i = 0; i < 2500; ++i) {
        now = std::max(now, sut.due());
        const auto sent = sut.step(now);
        frames += sent.size();
        Controls controls{.time_usec = msg::HilSensor::decode(sent.front().payload()).time_usec, .flags = 1};
        controls.controls.fill(0.6f);
        wire::FrameBuffer buffer;
        sut.receive(wire::write_frame(buffer, {}, controls), now);
    }

    EXPECT_EQ(mavloom::test::allocations, before);
    EXPECT_GT(frames, 3000u);
    EXPECT_EQ(sut.lock_step().counters().answered, 2500u);
}

}  // namespace
}  // namespace mavloom::hil
