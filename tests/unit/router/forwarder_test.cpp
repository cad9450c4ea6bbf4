// SPDX-License-Identifier: MIT
// What a router does with a frame, over links that the test plays. Rules: docs/guide/routing.md and
// docs/guide/route.md. Which links a frame goes to is the engine's decision: unit/route.
#include "router/forwarder.hpp"

#include <gmock/gmock.h>

#include <map>
#include <set>

#include "unit/route/route_frames.hpp"

namespace mavloom::router {
namespace {

using namespace std::chrono_literals;
using route::test::Bytes;
using route::test::Id;
using route::test::make_frame;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Id vehicle{1, 1}, gcs{255, 190};

// Links that take every frame, and a clock that the test moves.
class PlayedLinks : public link::LinkAccess {
public:
    struct Sent {
        std::uint32_t link;
        MessageId id;
        bool may_sign;
    };
    std::size_t send(std::span<const LinkId> links, const wire::FrameView& frame) override {
        for (const LinkId link : links) sent.push_back({link.value, frame.id(), true});
        last = {frame.bytes().begin(), frame.bytes().end()};
        return links.size();
    }
    std::size_t forward(std::span<const LinkId> links, const wire::FrameView& frame, Rank from) override {
        if (from == Rank::verified) return send(links, frame), 0;
        for (const LinkId link : links) sent.push_back({link.value, frame.id(), false});
        return static_cast<std::size_t>(
            std::ranges::count_if(links, [&](LinkId link) { return signing.contains(link.value); }));
    }
    [[nodiscard]] MonoTime now() const noexcept override { return time; }
    [[nodiscard]] const link::LinkCounters* counters(LinkId link) const noexcept override {
        const auto at = there.find(link.value);
        return at == there.end() ? nullptr : &at->second;
    }
    [[nodiscard]] std::string_view link_name(LinkId link) const override {
        return there.contains(link.value) ? names[link.value % names.size()] : std::string_view{};
    }

    [[nodiscard]] Rank rank(LinkId link) const noexcept override { return ranks.at(link.value % ranks.size()); }

    std::vector<Sent> sent;
    std::array<Rank, 4> ranks{Rank::own, Rank::own, Rank::own, Rank::own};  // by link
    Bytes last;
    std::set<std::uint32_t> signing;
    MonoTime time{1000s};
    std::map<std::uint32_t, link::LinkCounters> there;
    std::array<std::string_view, 4> names{"four", "one", "two", "three"};
};

struct ForwarderAtWork {
    explicit ForwarderAtWork(config::RouterConfig config = {})
        : sut(dialect::default_dialect(), with_timeout(config), links) {}
    static config::RouterConfig with_timeout(config::RouterConfig config) {
        config.route_timeout = 60s;
        return config;
    }

    RoutedEndpoint& endpoint(std::string_view url) {
        auto made = std::make_unique<RoutedEndpoint>(
            RoutedEndpoint{.id = link::EndpointId{0}, .endpoint = *endpoint::parse_endpoint(url)});
        made->policy.tap = made->endpoint.options.tap;
        made->verifies = !made->endpoint.options.verify_key_file.empty();
        return *endpoints.emplace_back(std::move(made));
    }
    // Link 1, 2, 3... of an endpoint of its own.
    RoutedEndpoint& link(std::string_view url = "udpin://127.0.0.1:1") {
        RoutedEndpoint& at = endpoint(url);
        links.there.try_emplace(++last);
        EXPECT_TRUE(sut.add_link(LinkId{last}, at));
        return at;
    }
    route::Verdict hears(std::uint32_t link, const Bytes& bytes, bool is_repeated = false) {
        links.sent.clear();
        const auto frame = wire::FrameView::unchecked(bytes);
        const auto* const info = dialect::default_dialect().wire_table().find(frame.id());
        link::RxFrame rx{frame, info, LinkId{link}, {}};
        rx.is_repeated = is_repeated;
        rx.rank = links.rank(LinkId{link});
        rx.loss = &loss.try_emplace(link, counters).first->second;
        const auto decision = sut.decide(rx, sut.mark_of(rx));
        sut.deliver(rx, decision, *endpoints.at(link - 1));
        return decision.verdict;
    }
    [[nodiscard]] std::vector<std::uint32_t> reached() const {
        std::vector<std::uint32_t> ids;
        for (const auto& sent : links.sent) ids.push_back(sent.link);
        return ids;
    }

    // The number of frames whose loss was counted on a link.
    [[nodiscard]] std::uint64_t counted(std::uint32_t link) const {
        const auto at = loss.find(link);
        return at == loss.end() ? 0 : at->second.tracker.total().received;
    }

    PlayedLinks links;
    link::LinkCounters counters;
    std::map<std::uint32_t, link::Loss> loss;
    std::vector<std::unique_ptr<RoutedEndpoint>> endpoints;
    std::uint32_t last = 0;
    Forwarder sut;
};

Bytes attitude(Id source = vehicle) {
    static std::uint32_t unique = 0;
    return make_frame("ATTITUDE", source, {{"time_boot_ms", ++unique}});
}
Bytes command(Id target) {
    static std::uint32_t unique = 0;
    return make_frame("COMMAND_LONG", gcs,
                      {{"target_system", target.system}, {"target_component", target.component}, {"param1", ++unique}});
}

TEST(Forwarder, SendsWhereTheEngineDecidesAndCountsTheTraffic) {
    ForwarderAtWork router;
    for (int i = 0; i < 3; ++i) router.link();

    EXPECT_EQ(router.hears(1, attitude()), route::Verdict::forwarded);

    EXPECT_THAT(router.reached(), ElementsAre(2, 3));
    EXPECT_EQ(router.counted(1), 1u);
    const auto rows = router.sut.traffic().rows();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].link, LinkId{1});
    EXPECT_EQ(rows[0].count, 1u);
}

TEST(Forwarder, ALinkThatWentGetsNothing) {
    ForwarderAtWork router;
    for (int i = 0; i < 3; ++i) router.link();
    router.sut.remove_link(LinkId{2});

    router.hears(1, attitude());

    EXPECT_THAT(router.reached(), ElementsAre(3));
}

TEST(Forwarder, VerdictsContinueWhenALinkComesUpAgain) {
    ForwarderAtWork router;
    RoutedEndpoint& endpoint = router.link("tcpout://127.0.0.1:1");
    router.link();
    router.hears(1, attitude());

    router.sut.remove_link(LinkId{1});
    ASSERT_NE(router.sut.verdicts(LinkId{1}), nullptr);
    EXPECT_EQ(router.sut.verdicts(LinkId{1})->forwarded.value(), 1u);

    ASSERT_TRUE(router.sut.add_link(LinkId{1}, endpoint));
    router.hears(1, attitude());
    EXPECT_EQ(router.sut.verdicts(LinkId{1})->forwarded.value(), 2u);
}

TEST(Forwarder, VerdictsOfALinkThatIsGoneAreForgotten) {
    ForwarderAtWork router;
    router.link();
    router.sut.remove_link(LinkId{1});
    router.links.there.erase(1);

    (void)router.sut.maintain();

    EXPECT_EQ(router.sut.verdicts(LinkId{1}), nullptr);
}

TEST(Forwarder, SignsOnlyVerifiedFrames) {
    ForwarderAtWork router;
    router.links.ranks[1] = Rank::verified;
    router.link("udpin://127.0.0.1:1?verify=key");
    router.link("udpin://127.0.0.1:2");
    router.link("udpin://127.0.0.1:3?sign=key");
    router.links.signing = {3};

    router.hears(1, attitude());
    ASSERT_THAT(router.reached(), ElementsAre(2, 3));
    EXPECT_TRUE(router.links.sent[1].may_sign);
    EXPECT_EQ(router.sut.not_signed(), 0u);
    router.hears(2, attitude({2, 1}));
    ASSERT_THAT(router.reached(), ElementsAre(1, 3));
    EXPECT_FALSE(router.links.sent[1].may_sign);
    EXPECT_EQ(router.sut.not_signed(), 1u);
    router.hears(1, attitude(), true);
    ASSERT_THAT(router.reached(), ElementsAre(2, 3));
    EXPECT_FALSE(router.links.sent[1].may_sign);
    EXPECT_EQ(router.sut.not_signed(), 2u);
}

// They showed only as `not_signed` in the statistics.
TEST(Forwarder, WarnsOnceOfCommandsThatGoOutUnsigned) {
    ForwarderAtWork router;
    router.link("udpin://127.0.0.1:1?verify=key&sign=key");
    router.link("udpin://127.0.0.1:2");
    router.links.signing = {1};
    router.hears(1, attitude());
    router.hears(2, attitude(gcs));
    EXPECT_THAT(router.sut.maintain(), IsEmpty());

    router.hears(2, command(vehicle));
    EXPECT_THAT(router.sut.maintain(),
                ElementsAre(AllOf(HasSubstr("command from 255/190 on two went out unsigned"), HasSubstr("verify="))));
    router.hears(2, command(vehicle));
    EXPECT_THAT(router.sut.maintain(), IsEmpty());
}

TEST(Forwarder, AnEchoIsNoLoss) {
    ForwarderAtWork router;
    router.link();
    router.link();
    const auto frame = attitude();
    router.hears(1, frame);

    EXPECT_EQ(router.hears(2, frame), route::Verdict::echo);

    EXPECT_THAT(router.reached(), IsEmpty());
    EXPECT_EQ(router.counted(1), 1u);
    EXPECT_EQ(router.counted(2), 0u);
}

// Whether a restart of the vehicle that shows on link 1 reaches the engine, which then forgets routes.
bool restart_forgets_routes(std::string_view url, const dialect::Filter& in = {}, bool is_repeated = false) {
    ForwarderAtWork router;
    router.endpoint(url).policy.in = in;
    router.links.there.try_emplace(++router.last);
    EXPECT_TRUE(router.sut.add_link(LinkId{1}, *router.endpoints[0]));
    for (const std::uint32_t boot_ms : {100'000u, 10u})
        router.hears(1, make_frame("SYSTEM_TIME", vehicle, {{"time_boot_ms", boot_ms}}), is_repeated);
    return router.sut.engine().counters().reboots.value() == 1;
}

TEST(Forwarder, ARestartForgetsTheRoutesOfTheSystem) { EXPECT_TRUE(restart_forgets_routes("udpin://127.0.0.1:1")); }

TEST(Forwarder, WhatTeachesNoRouteForgetsNone) {
    EXPECT_FALSE(restart_forgets_routes("udpin://127.0.0.1:1?tap=true"));
    EXPECT_FALSE(restart_forgets_routes("udpin://127.0.0.1:1", route::test::make_filter({}, {.systems = {1}})));
    EXPECT_FALSE(restart_forgets_routes("udpin://127.0.0.1:1?verify=key", {}, true));
}

TEST(Forwarder, TheOwnHeartbeatGoesWhereTheRouterInitiatesContact) {
    ForwarderAtWork router({.heartbeat = std::pair<std::uint8_t, std::uint8_t>{255, 193}});
    router.link("udpout://127.0.0.1:1");
    router.link("udpin://127.0.0.1:2");
    router.link("udpout://127.0.0.1:3?tap=true");
    RoutedEndpoint& inlet = router.endpoint("udpout://127.0.0.1:4");
    inlet.is_inlet = true;
    EXPECT_TRUE(router.sut.add_link(LinkId{4}, inlet));

    router.sut.send_due(router.links.time);

    EXPECT_THAT(router.reached(), ElementsAre(1));
    EXPECT_EQ(router.sut.heartbeats_sent(), 1u);
}

TEST(Forwarder, TheOwnHeartbeatThatComesBackIsAnEcho) {
    ForwarderAtWork router({.heartbeat = std::pair<std::uint8_t, std::uint8_t>{255, 193}});
    router.link("udpout://127.0.0.1:1");
    router.link("udpin://127.0.0.1:2");
    router.sut.send_due(router.links.time);
    const Bytes own = router.links.last;

    EXPECT_EQ(router.hears(1, own), route::Verdict::echo);
    EXPECT_THAT(router.reached(), IsEmpty());
}

TEST(Forwarder, WhatIsForTheRouterItselfIsConsumed) {
    ForwarderAtWork router({.heartbeat = std::pair<std::uint8_t, std::uint8_t>{42, 191}});
    router.link();
    router.link();

    EXPECT_EQ(router.hears(1, command({42, 191})), route::Verdict::consumed);
}

TEST(Forwarder, AsksAnArduPilotForItsStreamsOnItsLink) {
    ForwarderAtWork router({.heartbeat = std::pair<std::uint8_t, std::uint8_t>{42, 191}, .request_streams_hz = 4});
    router.link();
    router.link();

    router.hears(2, make_frame("HEARTBEAT", vehicle, {{"autopilot", 3}}));

    ASSERT_THAT(router.reached(), ElementsAre(2, 1));
    EXPECT_EQ(router.links.sent[0].id, MessageId{66});  // REQUEST_DATA_STREAM
}

TEST(Forwarder, OtherOptionsHoldFromTheNextFrame) {
    ForwarderAtWork router;
    router.link();
    router.link();
    EXPECT_EQ(router.hears(1, command({9, 9})), route::Verdict::unknown_target);

    router.sut.configure({.unknown_target = route::UnknownTarget::flood});

    EXPECT_EQ(router.hears(1, command({9, 9})), route::Verdict::forwarded);
}

TEST(Forwarder, AnExplainedFrameGoesTheSameWay) {
    ForwarderAtWork router;
    for (int i = 0; i < 3; ++i) router.link();
    std::vector<route::Explanation> why;
    router.sut.explain([&](const auto&, const auto&, auto explained) { why.assign(explained.begin(), explained.end()); });

    EXPECT_EQ(router.hears(2, attitude()), route::Verdict::forwarded);

    EXPECT_THAT(router.reached(), ElementsAre(1, 3));
    ASSERT_EQ(why.size(), 3u);
    EXPECT_EQ(why[1].reason, route::Reason::ingress);
}

TEST(Forwarder, RefusesLinksBeyondTheBound) {
    ForwarderAtWork router;
    RoutedEndpoint& at = router.endpoint("udpin://127.0.0.1:1");
    for (std::uint32_t id = 1; id <= route::Engine::max_links; ++id) ASSERT_TRUE(router.sut.add_link(LinkId{id}, at));

    EXPECT_FALSE(router.sut.add_link(LinkId{route::Engine::max_links + 1}, at));
}

TEST(Forwarder, TwoSendersOfOneIdAreReportedOnceWithTheNamesOfTheirLinks) {
    ForwarderAtWork router;
    router.link();
    router.link();
    for (std::uint32_t i = 0; i < 8; ++i) router.hears(1 + i % 2, attitude({77, 2}));
    router.links.there.erase(2);

    EXPECT_THAT(router.sut.maintain(), ElementsAre(AllOf(HasSubstr("77/2 is heard on "), HasSubstr("on one"),
                                                         HasSubstr("on a link that is gone"))));
    EXPECT_THAT(router.sut.maintain(), IsEmpty());
}

TEST(Forwarder, AVehicleThatIsLearnedOnASecondLinkIsReportedOnceWithTheNamesOfTheLinks) {
    ForwarderAtWork router;
    router.links.ranks.fill(Rank::stranger);
    router.link();
    router.link();
    for (int tenths = 0; tenths < 60; ++tenths) {
        router.links.time += 100ms;
        router.hears(1, attitude());
        router.hears(2, attitude());
    }

    EXPECT_THAT(router.sut.maintain(),
                testing::Contains(
                    AllOf(HasSubstr("system 1 is alive on one and was learned on two too"), HasSubstr("learn=first"))));
    EXPECT_THAT(router.sut.maintain(), IsEmpty());
}

TEST(Forwarder, ForgetsTheTrafficOfLinksThatWent) {
    ForwarderAtWork router;
    router.link();
    router.link();
    router.hears(1, attitude());
    router.hears(2, attitude({2, 1}));
    router.sut.remove_link(LinkId{1});
    router.links.there.erase(1);

    (void)router.sut.maintain();

    const auto rows = router.sut.traffic().rows();
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].link, LinkId{2});
}

}  // namespace
}  // namespace mavloom::router
