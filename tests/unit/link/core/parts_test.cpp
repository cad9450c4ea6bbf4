// SPDX-License-Identifier: MIT
// The parts of module link that a turn drives: the table of links, outlets, tickers, lists of peers and the class of a
// frame.
#include <gmock/gmock.h>

#include "link/core/core.hpp"
#include "link/peer_list.hpp"
#include "unit/dialect/xml_folder.hpp"
#include "unit/link/fixture.hpp"

namespace mavloom::link::detail {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct PlainLink final : Link {
    explicit PlainLink(std::string given) : Link(EndpointId{0}, {}) { name = std::move(given); }
    void schedule() override {}
};

TEST(LinkTable, FindsLinksByIdsThatAreNeverUsedAgain) {
    LinkTable sut;
    PlainLink first("a"), second("b"), third("c");
    sut.add(first);
    sut.add(second);
    sut.remove(second.id);
    sut.add(third);

    EXPECT_EQ(first.id, LinkId{1});
    EXPECT_EQ(third.id, LinkId{3});
    EXPECT_EQ(sut.find(LinkId{1}), &first);
    EXPECT_EQ(sut.find(LinkId{2}), nullptr);
    EXPECT_EQ(sut.find(LinkId{3}), &third);
    EXPECT_EQ(sut.size(), 2u);
}

TEST(LinkTable, MakesNamesUnique) {
    LinkTable sut;
    PlainLink first("px4"), second("px4"), third("px4");
    for (Link* link : {static_cast<Link*>(&first), static_cast<Link*>(&second), static_cast<Link*>(&third)})
        sut.add(*link);

    EXPECT_EQ(second.name, "px4 (2)");
    EXPECT_EQ(third.name, "px4 (3)");
}

// An old link keeps its slot while ids wrap around the table, and its id still finds it.
TEST(LinkTable, KeepsOldLinksWhileOthersComeAndGo) {
    LinkTable sut;
    PlainLink old("old");
    sut.add(old);
    for (int i = 0; i < 1000; ++i) {
        PlainLink passing("passing");
        sut.add(passing);
        ASSERT_EQ(sut.find(passing.id), &passing);
        sut.remove(passing.id);
    }
    EXPECT_EQ(sut.find(old.id), &old);

    std::vector<std::unique_ptr<PlainLink>> many;
    for (int i = 0; i < 300; ++i) sut.add(*many.emplace_back(std::make_unique<PlainLink>(std::to_string(i))));
    for (const auto& link : many) EXPECT_EQ(sut.find(link->id), link.get());
    EXPECT_EQ(sut.find(old.id), &old);
}

TEST(LinkTable, CountsOnFromAnEarlierWriter) {
    LinkTable sut;
    sut.count_from(LinkId{41});
    PlainLink link("a");
    sut.add(link);
    EXPECT_EQ(link.id, LinkId{42});
}

struct PlainOutlet final : Outlet {
    void flush() override {
        ++flushed;
        if (on_flush) on_flush();
    }
    [[nodiscard]] bool blocked() const override { return is_blocked; }
    void expire(MonoTime) override { ++expired; }

    int flushed = 0, expired = 0;
    bool is_blocked = false;
    std::function<void()> on_flush;
};

TEST(Outlets, FlushOnceHoweverOftenTheyAreScheduled) {
    Outlets sut;
    PlainOutlet outlet;
    sut.schedule(outlet);
    sut.schedule(outlet);

    sut.flush();
    sut.flush();

    EXPECT_EQ(outlet.flushed, 1);
    EXPECT_TRUE(sut.empty());
}

TEST(Outlets, ABlockedOneStaysAndExpires) {
    Outlets sut;
    PlainOutlet blocked, free;
    blocked.is_blocked = true;
    sut.schedule(blocked);
    sut.schedule(free);
    sut.flush();

    sut.expire_blocked({});
    EXPECT_FALSE(sut.empty());
    EXPECT_EQ(blocked.expired, 1);
    EXPECT_EQ(free.expired, 0);
    blocked.is_blocked = false;
    sut.flush();
    EXPECT_EQ(blocked.flushed, 2);
    EXPECT_TRUE(sut.empty());
}

TEST(Outlets, MayForgetThemselvesAndOthersWhileTheyFlush) {
    Outlets sut;
    PlainOutlet first, second, third;
    first.is_blocked = true;
    first.on_flush = [&] {
        sut.forget(first);
        sut.forget(second);
    };
    for (Outlet* outlet : {static_cast<Outlet*>(&first), static_cast<Outlet*>(&second), static_cast<Outlet*>(&third)})
        sut.schedule(*outlet);

    sut.flush();

    EXPECT_EQ(second.flushed, 0);
    EXPECT_EQ(third.flushed, 1);
    EXPECT_TRUE(sut.empty()) << "one that forgot itself does not stay, though it is blocked";
}

struct PlainTicker final : Ticker {
    [[nodiscard]] std::optional<MonoTime> tick_due() const override { return due; }
    void tick(MonoTime now) override {
        ticks.push_back(now);
        if (on_tick) on_tick();
        else due.reset();
    }

    std::optional<MonoTime> due;
    std::vector<MonoTime> ticks;
    std::function<void()> on_tick;
};

TEST(Tickers, TickWhenTheyAreDueAndNotBefore) {
    Tickers sut;
    PlainTicker early, late;
    early.due = MonoTime{1s};
    late.due = MonoTime{3s};
    sut.keep(early);
    sut.keep(late);
    sut.keep(late);

    EXPECT_EQ(sut.due(), MonoTime{1s});
    sut.run(MonoTime{2s});
    EXPECT_THAT(early.ticks, ElementsAre(MonoTime{2s}));
    EXPECT_THAT(late.ticks, IsEmpty());
    EXPECT_EQ(sut.due(), MonoTime{3s});
    sut.run(MonoTime{3s});
    EXPECT_THAT(late.ticks, ElementsAre(MonoTime{3s}));
    EXPECT_TRUE(sut.empty());
    EXPECT_EQ(sut.due(), MonoTime::max());
}

TEST(Tickers, MayForgetThemselvesWhileTheyTick) {
    Tickers sut;
    PlainTicker first, second;
    first.due = second.due = MonoTime{1s};
    first.on_tick = [&] { sut.forget(first); };
    sut.keep(first);
    sut.keep(second);

    sut.run(MonoTime{1s});

    EXPECT_EQ(first.ticks.size(), 1u);
    EXPECT_EQ(second.ticks.size(), 1u);
    EXPECT_TRUE(sut.empty());
}

struct PlainEndpoint final : OpenEndpoint {
    using OpenEndpoint::OpenEndpoint;
    std::size_t send(const wire::FrameView&) override { return 0; }
    [[nodiscard]] std::size_t queued_bytes() const override { return 0; }
};

struct PlainPeer final : Link {
    PlainPeer() : Link(EndpointId{0}, {}) {}
    void schedule() override {}
    MonoTime last_heard{};
};

TEST(PeerList, ExpiresASilentPeerAtItsTimeThoughAnotherWasHeardLater) {
    Core core(dialect::default_dialect(), std::move(*net::EventLoop::create()), std::move(*net::ReceiveBatch::create()));
    const auto where = testing::endpoint_of("udpin://127.0.0.1:1");
    Opening opening{core, where, EndpointId{0}, nullptr};
    PlainEndpoint endpoint(opening);
    PeerList<PlainPeer> sut(core, endpoint);
    for (const auto heard : {0s, 3s}) sut.add(std::make_unique<PlainPeer>(), Rank::own).last_heard = MonoTime{heard};
    const auto drop = [&](PlainPeer& peer) { sut.remove(peer, "idle"); };

    EXPECT_EQ(sut.expire(MonoTime{4s}, 5s, drop), MonoTime{5s});
    EXPECT_EQ(sut.size(), 2u);
    EXPECT_EQ(sut.expire(MonoTime{5s}, 5s, drop), MonoTime{8s});
    EXPECT_EQ(sut.size(), 1u);
}

// The class and the key depend on the dialect: a message that supersedes itself in one is unknown in the other.
TEST(OutgoingFrame, UsesTheDialectOfEachLink) {
    dialect::test::XmlFolder folder;
    folder.write("a.xml",
                 "<mavlink><messages><message id=\"40000\" name=\"X\"><description/>"
                 "<field type=\"uint8_t\" name=\"x\">x</field></message></messages></mavlink>");
    const auto other = *folder.load();
    const LinkDialect usual(dialect::default_dialect()), small(other);
    const auto bytes = testing::attitude(0);
    const auto frame = testing::view(bytes);
    OutgoingFrame sut(frame);

    const auto key = sut.key(usual);
    EXPECT_NE(key, 0u);
    EXPECT_EQ(sut.key(small), 0u) << "an id without definition is never superseded";
    EXPECT_EQ(sut.key(usual), key);
}

}  // namespace
}  // namespace mavloom::link::detail
