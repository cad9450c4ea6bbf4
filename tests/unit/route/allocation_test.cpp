// SPDX-License-Identifier: MIT
// Counts operator new: the engine allocates when it is made and when links come, never for a frame.
#include <gtest/gtest.h>

#include "support/count_allocations.hpp"
#include "unit/route/route_frames.hpp"

namespace mavloom::route {
namespace {

TEST(Engine, AllocatesNothingForAFrame) {
    using test::Id;
    test::Network network({.dedup = std::chrono::milliseconds{250}});
    network.links(2, {.group = GroupId{1}, .group_mode = GroupMode::best});
    network.link({.out = test::make_filter({}, {.messages = {"ATTITUDE"}}), .max_bytes_per_s = 5000});
    network.link({.tap = true, .max_rate = test::make_rates({{"*", 50}})});
    network.link();
    std::vector<test::Bytes> frames;
    for (std::uint32_t i = 0; i < 5000; ++i) {
        const Id source{static_cast<std::uint8_t>(i % 250), static_cast<std::uint8_t>(i / 20)};
        frames.push_back(i % 3 == 0 ? test::make_frame("COMMAND_LONG", source, {{"target_system", i % 256}})
                                    : test::make_frame("SYSTEM_TIME", source, {{"time_boot_ms", 99999 - 7 * i}}));
    }
    auto& sut = network.engine;
    const auto before = mavloom::test::allocations;

    for (std::size_t i = 0; i < frames.size(); ++i) {
        network.now += std::chrono::milliseconds{40};
        const LinkId ingress{1 + static_cast<std::uint32_t>(i % 5)};
        (void)sut.route(wire::FrameView::unchecked(frames[i]), ingress, network.now);
        sut.note_sent(wire::FrameView::unchecked(frames[i]), ingress, network.now);
    }

    EXPECT_EQ(mavloom::test::allocations, before);
}

}  // namespace
}  // namespace mavloom::route
