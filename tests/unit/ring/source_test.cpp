// SPDX-License-Identifier: MIT
#include "mavloom/ring/source.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <map>

#include "mavloom/dialect/dialect.hpp"
#include "mavloom/shm/counter_page.hpp"
#include "mavloom/shm/layout.hpp"
#include "mavloom/shm/ring_writer.hpp"
#include "support/ring_name.hpp"
#include "unit/link/fixture.hpp"
#include "unit/ring/allocations.hpp"

namespace mavloom::ring {
namespace {

using namespace link::testing;

class CountsFrames final : public link::LinkHandler {
public:
    std::size_t frames = 0, links_down = 0;
    LinkId last;                          // whose the last frame was
    std::map<LinkId, std::string> names;  // of all that ever came up

private:
    void on_frame(const link::RxFrame& rx) override {
        ++frames;
        last = rx.link;
    }
    void on_link_up(LinkId link, link::EndpointId, std::string_view name) override { names.emplace(link, name); }
    void on_link_down(LinkId, link::EndpointId, std::string_view) override { ++links_down; }
};

struct RingSourceTest : ::testing::Test {
    test::RingName name;
    shm::RingWriter writer = opened(shm::RingWriter::open(name.text(), {.capacity = shm::min_capacity}));
    const dialect::Dialect& dialect = dialect::default_dialect();
    std::unique_ptr<link::Links> links = opened(link::Links::create(dialect));
    RingSource sut{endpoint_of("shm://" + name.text()), dialect.wire_table(), *links, Copies::kept};
    CountsFrames handler;

    template <class T>
    static T opened(SetupResult<T> result) {
        if (!result) throw std::runtime_error(result.error().text);
        return std::move(*result);
    }
    void write(std::size_t frames) {
        for (std::size_t n = 0; n < frames; ++n) ASSERT_TRUE(writer.write(attitude(static_cast<std::uint8_t>(n)), {}));
    }
    // The name of the link that a frame of this number is handed over with.
    const std::string& heard_from(std::uint32_t link) {
        EXPECT_TRUE(writer.write(attitude(0), {.link = LinkId{link}}));
        EXPECT_EQ(sut.play(handler, 10), 1u);
        return handler.names[handler.last];
    }
};

// A writer that continues must not keep a loop from waiting for its other sources.
TEST_F(RingSourceTest, AtItsEndItIsNeverDueHoweverMuchIsWritten) {
    ASSERT_TRUE(sut.open());
    write(3);
    sut.stop_at_current_end();
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
    sut.stop_at_current_end();
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

// docs/guide/listen.md: records that were missed in the ring are never part of `lost`.
TEST_F(RingSourceTest, WhatWasMissedInTheRingIsNoLossOfTheLink) {
    ASSERT_TRUE(sut.open());
    write(3);
    EXPECT_EQ(sut.play(handler, 10), 3u);
    write(2000);  // from sequence number 0 again
    while (sut.play(handler, 1000) != 0) continue;
    ASSERT_NE(sut.losses().lapped, 0u);
    ASSERT_NE(sut.losses().lapped % 256, 3u) << "after the first three frames, these numbers would show no gap";
    const auto& counters = sut.counters();
    EXPECT_EQ(counters.lost.value() + counters.late.value() + counters.duplicate.value() + counters.resync.value(), 0u);
}

TEST_F(RingSourceTest, ARingThatIsNotThereIsAtItsEnd) {
    sut.stop_at_current_end();
    EXPECT_TRUE(sut.at_end());
    EXPECT_EQ(sut.play(handler, 10), 0u);
    EXPECT_EQ(sut.due(true, mono_now()), MonoTime::max());
}

TEST_F(RingSourceTest, LinksThatComeAndGoForEverHaveTheirNames) {
    ASSERT_TRUE(sut.open());
    auto page = opened(shm::CounterPage::create(name.text(), {.counters = 1, .links = 2}));
    ASSERT_TRUE(page.name_link(LinkId{1}, "who stays"));
    ASSERT_EQ(heard_from(1), "who stays");
    const LinkId stays = handler.last;
    for (std::uint32_t number = 2; number < 20'000; ++number) {
        const auto peer = fmt::format("peer {}", number);
        ASSERT_TRUE(page.name_link(LinkId{number}, peer));
        ASSERT_EQ(heard_from(number), peer);
        page.forget_link(LinkId{number});
        if (number % 1000 == 0) {
            ASSERT_EQ(heard_from(1), "who stays");
            ASSERT_EQ(handler.last, stays);
        }
    }
    EXPECT_GT(handler.links_down, 10'000u) << "what is remembered is bounded";

    for (int i = 0; i < 50; ++i) {
        for (const std::uint32_t number : {1u, 19'999u})
            ASSERT_TRUE(writer.write(attitude(0), {.link = LinkId{number}}));
        const std::size_t before = test::allocations_so_far();
        ASSERT_EQ(sut.play(handler, 10), 2u);
        EXPECT_EQ(test::allocations_so_far(), before);
    }
}

// A router whose page somebody removed creates it again within a second or so.
TEST_F(RingSourceTest, APageOfAnotherUserNamesNoLinks) {
    if (::geteuid() != 0) GTEST_SKIP() << "giving files away needs root";
    ASSERT_TRUE(sut.open());
    auto page = opened(shm::CounterPage::create(name.text(), {.counters = 1, .links = 1}));
    ASSERT_TRUE(page.name_link(LinkId{7}, "forged"));
    ASSERT_EQ(::chown((name.path() + ".stat").c_str(), 65534, 65534), 0);
    EXPECT_EQ(heard_from(7), "shm://" + name.text() + "/7");
}

TEST_F(RingSourceTest, ALinkThatSpokeWithoutACounterPageGetsItsNameWhenThePageIsThere) {
    ASSERT_TRUE(sut.open());
    EXPECT_EQ(heard_from(7), "shm://" + name.text() + "/7");
    auto page = opened(shm::CounterPage::create(name.text(), {.counters = 1, .links = 1}));
    ASSERT_TRUE(page.name_link(LinkId{7}, "radio"));
    const MonoTime deadline = mono_now() + std::chrono::minutes(1);
    while (heard_from(7) != "radio" && mono_now() < deadline) continue;
    EXPECT_EQ(heard_from(7), "radio");
}

}  // namespace
}  // namespace mavloom::ring
