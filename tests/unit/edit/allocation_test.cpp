// SPDX-License-Identifier: MIT
// Counts operator new: the stage allocates when it is made and never for a frame.
#include <gtest/gtest.h>

#include "mavloom/edit/stage.hpp"
#include "support/count_allocations.hpp"
#include "support/golden_frames.hpp"

namespace mavloom::edit {
namespace {

TEST(Stage, AllocatesNothingForAFrame) {
    Options options{
        .set = {"HEARTBEAT.custom_mode=7"}, .remap_system = {"1=42"}, .max_rate = {"*:50"}, .resequence = true};
    options.sign_key.emplace(std::array<std::uint8_t, 32>{});
    const auto sut = Stage::create(dialect::default_dialect(), options);
    ASSERT_TRUE(sut.has_value());
    const auto before = test::allocations;

    for (int i = 0; i < 1000; ++i) {
        const WallTime now{std::chrono::milliseconds{i}};
        for (const auto* frame :
             {&test::heartbeat_v2, &test::heartbeat_v1, &test::tunnel_v2, &test::heartbeat_signed_1}) {
            (void)(*sut)->forward(wire::FrameView::unchecked(*frame), now, now);
            (void)(*sut)->backward(wire::FrameView::unchecked(*frame));
        }
    }

    EXPECT_EQ(test::allocations, before);
}

}  // namespace
}  // namespace mavloom::edit
