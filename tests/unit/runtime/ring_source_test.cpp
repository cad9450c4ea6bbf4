// SPDX-License-Identifier: MIT
#include "runtime/ring_source.hpp"

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/shm/layout.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"
#include "unit/runtime/links_fixture.hpp"

namespace mavloom::runtime::detail {
namespace {

using namespace testing;

class CountsFrames final : public LinkHandler {
public:
    std::size_t frames = 0;

private:
    void on_frame(const RxFrame&) override { ++frames; }
};

struct RingSourceTest : ::testing::Test {
    test::RingName name;
    shm::RingWriter writer = opened(shm::RingWriter::open(name.text(), {.capacity = shm::min_capacity}));
    const dialect::Dialect& dialect = dialect::default_dialect();
    std::unique_ptr<Links> links = opened(Links::create(dialect));
    RingLinkIds ids;
    RingSource sut{endpoint_of("shm://" + name.text()), dialect.wire_table(), ids, *links, Copies::kept};
    CountsFrames handler;

    template <class T>
    static T opened(SetupResult<T> result) {
        if (!result) throw std::runtime_error(result.error().text);
        return std::move(*result);
    }
    void write(std::size_t frames) {
        for (std::size_t n = 0; n < frames; ++n) ASSERT_TRUE(writer.write(attitude(static_cast<std::uint8_t>(n)), {}));
    }
};

// Nothing of a writer that goes on may keep a loop from waiting for its other sources.
TEST_F(RingSourceTest, AtItsEndItIsNeverDueHoweverMuchIsWritten) {
    ASSERT_TRUE(sut.open());
    write(3);
    sut.end_here();
    write(2);
    EXPECT_FALSE(sut.at_end());
    EXPECT_EQ(sut.play(handler, 2), 2u);
    EXPECT_FALSE(sut.at_end());
    EXPECT_EQ(sut.due(true, mono_now()), MonoTime{});

    EXPECT_EQ(sut.play(handler, 10), 1u);
    EXPECT_TRUE(sut.at_end());
    EXPECT_EQ(sut.due(true, mono_now()), MonoTime::max());
    write(1);
    EXPECT_EQ(sut.play(handler, 10), 0u);
    EXPECT_EQ(sut.due(true, mono_now()), MonoTime::max());
    EXPECT_EQ(handler.frames, 3u);
}

TEST_F(RingSourceTest, WhatIsReadToItsLastRecordIsAtItsEnd) {
    ASSERT_TRUE(sut.open());
    write(2);
    sut.end_here();
    EXPECT_EQ(sut.play(handler, 10), 2u);
    EXPECT_TRUE(sut.at_end());
    EXPECT_EQ(sut.due(true, mono_now()), MonoTime::max());
}

TEST_F(RingSourceTest, WhileItIsHeldItIsNeitherReadNorDue) {
    ASSERT_TRUE(sut.open());
    write(3);
    sut.hold(true);
    EXPECT_EQ(sut.play(handler, 10), 0u);
    EXPECT_EQ(sut.due(true, mono_now()), MonoTime::max());

    sut.hold(false);
    EXPECT_EQ(sut.play(handler, 10), 3u);
    EXPECT_EQ(sut.counters().frames_in.value(), 3u);
}

TEST_F(RingSourceTest, ARingThatIsNotThereIsAtItsEnd) {
    sut.end_here();
    EXPECT_TRUE(sut.at_end());
    EXPECT_EQ(sut.play(handler, 10), 0u);
    EXPECT_EQ(sut.due(true, mono_now()), MonoTime::max());
}

}  // namespace
}  // namespace mavloom::runtime::detail
