// SPDX-License-Identifier: MIT
// Counts operator new: the stage allocates when it is made and never for a frame.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "mavloom/edit/stage.hpp"
#include "support/golden_frames.hpp"

namespace {
std::size_t allocations = 0;
}  // namespace

// Not inlined: GCC would take new and free for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
    ++allocations;
    if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
    throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace mavloom::edit {
namespace {

TEST(Stage, AllocatesNothingForAFrame) {
    Options options{
        .set = {"HEARTBEAT.custom_mode=7"}, .remap_system = {"1=42"}, .max_rate = {"*:50"}, .resequence = true};
    options.sign_key.emplace(std::array<std::uint8_t, 32>{});
    const auto sut = Stage::create(dialect::default_dialect(), options);
    ASSERT_TRUE(sut.has_value());
    const auto before = allocations;

    for (int i = 0; i < 1000; ++i) {
        const WallTime now{std::chrono::milliseconds{i}};
        for (const auto* frame :
             {&test::heartbeat_v2, &test::heartbeat_v1, &test::tunnel_v2, &test::heartbeat_signed_1}) {
            (void)(*sut)->forward(wire::FrameView::unchecked(*frame), now, now);
            (void)(*sut)->backward(wire::FrameView::unchecked(*frame));
        }
    }

    EXPECT_EQ(allocations, before);
}

}  // namespace
}  // namespace mavloom::edit
