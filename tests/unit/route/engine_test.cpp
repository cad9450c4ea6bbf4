// SPDX-License-Identifier: MIT
#include "mavloom/route/engine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "unit/route/route_frames.hpp"

namespace mavloom::route {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::gcs;
using test::Id;
using test::make_frame;
using test::make_unknown;
using test::Network;
using test::vehicle;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;
using testing::UnorderedElementsAre;

TEST(Engine, TakesEachLinkOnce) {
    Engine sut(dialect::default_dialect().wire_table(), {});

    EXPECT_TRUE(sut.add_link(LinkId{1}, {}));
    EXPECT_FALSE(sut.add_link(LinkId{1}, {}));
    EXPECT_FALSE(sut.add_link(LinkId{0}, {}));
    EXPECT_EQ(sut.links(), 1u);
}

TEST(Engine, OtherOptionsKeepRoutesAndCounters) {
    Network sut;
    sut.links(3);
    sut.hears(2, vehicle);
    ASSERT_THAT(sut.command(1, gcs, Id{66, 1}), IsEmpty());
    Options other;
    other.unknown_target = UnknownTarget::flood;
    other.route_timeout = 5s;

    sut.engine.set_options(other);

    EXPECT_EQ(sut.engine.counters(LinkId{1})->unknown_target.value(), 1u);
    EXPECT_THAT(sut.command(1, gcs, vehicle), ElementsAre(2));
    EXPECT_THAT(sut.command(1, gcs, Id{66, 1}), UnorderedElementsAre(2, 3));
    sut.now += 6s;
    sut.hears(1, gcs);
    EXPECT_EQ(sut.engine.counters().routes_expired.value(), 2u) << "also those learned before have the new timeout";
}

TEST(Engine, RefusesLinksBeyondItsBound) {
    Network sut;
    sut.links(Engine::max_links);

    EXPECT_FALSE(sut.engine.add_link(LinkId{999999}, {}));
    EXPECT_EQ(sut.send(1, "ATTITUDE", vehicle).size(), Engine::max_links - 1);
    sut.engine.remove_link(LinkId{7});
    EXPECT_TRUE(sut.engine.add_link(LinkId{999999}, {}));
    EXPECT_EQ(sut.send(1, "ATTITUDE", vehicle).back(), 999999u);
}

TEST(Engine, AnswersUnknownLinkForALinkThatIsGone) {
    Network sut;
    sut.links(3);
    sut.hears(2, vehicle);
    sut.engine.remove_link(LinkId{2});

    EXPECT_THAT(sut.hears(2, vehicle), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::unknown_link);
    EXPECT_EQ(sut.engine.counters().unknown_link.value(), 1u);
    EXPECT_EQ(sut.engine.counters(LinkId{2}), nullptr);
    EXPECT_THAT(sut.command(1, gcs, vehicle), IsEmpty());
}

TEST(Engine, LinkInTheSlotOfAnotherInheritsNothing) {
    Network sut;
    sut.links(2);
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    ASSERT_THAT(sut.pass(1, frame), ElementsAre(2));
    sut.engine.remove_link(LinkId{2});
    sut.link();

    EXPECT_THAT(sut.pass(3, frame), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::nowhere);  // its sender is on 1; no echo, because link 3 was never sent it
    EXPECT_EQ(sut.counters(3).echo.value(), 0u);
}

// With a longer `dedup`, the engine remembers frames for longer. One that link 2 brought is still there.
TEST(Engine, LinkInTheSlotOfAnotherInheritsNothingWhenDedupGrows) {
    Network sut;
    sut.links(2);
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    sut.pass(2, frame);
    sut.engine.remove_link(LinkId{2});
    sut.wait(3s).hears(1, gcs);
    sut.engine.set_options({.dedup = 10s});
    sut.link();

    sut.pass(3, frame);

    EXPECT_EQ(sut.verdict, Verdict::duplicate);
    EXPECT_THAT(sut.engine.routes(LinkId{3}, sut.now), testing::SizeIs(1)) << "it did not bring the frame before";
}

// So many links come and go within two seconds that slots are taken again at once.
class QuickTurnover : public testing::Test {
protected:
    QuickTurnover() { sut.links(101); }
    void replace_a_hundred() {
        for (int i = 0; i < 100; ++i)
            sut.engine.remove_link(LinkId{sut.last_link - 99 + static_cast<std::uint32_t>(i)});
        sut.links(100);
    }

    Network sut;
    const Bytes frame = make_frame("ATTITUDE", vehicle);
};

TEST_F(QuickTurnover, NewLinksInheritNothing) {
    ASSERT_EQ(sut.pass(1, frame).size(), 100u);
    for (int round = 0; round < 3; ++round) replace_a_hundred();

    for (std::uint32_t link = sut.last_link - 99; link <= sut.last_link; ++link) {
        sut.pass(link, frame);
        ASSERT_EQ(sut.counters(link).echo.value(), 0u) << link;
    }
    ASSERT_THAT(sut.engine.links(), 101u);
}

TEST_F(QuickTurnover, EchoesOnNewLinksAreKnown) {
    for (int round = 0; round < 3; ++round) replace_a_hundred();
    sut.wait(1ns);
    ASSERT_EQ(sut.pass(1, frame).size(), 100u);

    for (std::uint32_t link = sut.last_link - 99; link <= sut.last_link; ++link) {
        EXPECT_THAT(sut.pass(link, frame), IsEmpty());
        ASSERT_EQ(sut.verdict, Verdict::echo) << link;
    }
}

TEST(Engine, KeepsWhatItKnowsWhenTheSixtyFifthLinkComes) {
    Network sut;
    sut.links(64);
    sut.hears(64, vehicle);
    const Bytes frame = make_frame("ATTITUDE", gcs);
    ASSERT_EQ(sut.pass(1, frame).size(), 63u);

    sut.links(2);

    EXPECT_THAT(sut.command(66, {7, 7}, vehicle), ElementsAre(64));
    EXPECT_THAT(sut.pass(64, frame), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::echo);
    EXPECT_EQ(sut.hears(65, {3, 3}).size(), 65u);
}

TEST(Engine, RouteIsForgottenExactlyAtItsTimeout) {
    Network sut({.route_timeout = 60s});
    sut.links(2);
    sut.hears(2, vehicle);

    sut.wait(60s - 1ns);
    EXPECT_THAT(sut.command(1, gcs, vehicle), ElementsAre(2));
    sut.wait(1ns);
    EXPECT_THAT(sut.command(1, gcs, vehicle), IsEmpty());
    EXPECT_EQ(sut.engine.counters().routes_expired.value(), 1u);
}

TEST(Engine, RebootForgetsTheRoutesOfASystemAndKeepsTheCount) {
    Network sut;
    sut.links(3);
    sut.hears(2, {1, 190});
    sut.hears(1, vehicle);
    sut.hears(1, {1, 154});

    sut.hears(1, vehicle);
    sut.engine.note_reboot(LinkId{1}, vehicle, sut.now);

    EXPECT_THAT(sut.command(3, gcs, {1, 154}), ElementsAre(1, 2)) << "154 is unknown, so the system gets it";
    EXPECT_EQ(sut.engine.counters().reboots.value(), 1u);
    ASSERT_EQ(sut.engine.routes(sut.now).size(), 3u) << "the route on link 2 stays";
    EXPECT_EQ(sut.engine.routes(sut.now)[0].source, Source(vehicle));
    EXPECT_EQ(sut.engine.routes(sut.now)[0].frames, 2u);
}

// A second link of the vehicle lags: what was learnt since the restart stays.
TEST(Engine, OneRestartThatTwoLinksReportIsOneReboot) {
    Network sut;
    sut.links(3);
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);
    sut.engine.note_reboot(LinkId{1}, vehicle, sut.now);
    sut.hears(1, {1, 154});
    sut.wait(5s);
    sut.hears(2, vehicle);
    sut.engine.note_reboot(LinkId{2}, vehicle, sut.now);

    EXPECT_EQ(sut.engine.counters().reboots.value(), 1u);
    EXPECT_THAT(sut.command(3, gcs, {1, 154}), ElementsAre(1));

    sut.engine.note_reboot(LinkId{1}, vehicle, sut.now);
    EXPECT_EQ(sut.engine.counters().reboots.value(), 2u) << "the same link reports another restart";
}

TEST(Engine, ARebootOnALinkThatIsGoneForgetsNothing) {
    Network sut;
    sut.links(2);
    sut.hears(1, vehicle);
    sut.engine.note_reboot(LinkId{9}, vehicle, sut.now);

    EXPECT_THAT(sut.command(2, gcs, vehicle), ElementsAre(1));
    EXPECT_EQ(sut.engine.counters().reboots.value(), 0u);
}

// A router that hears itself, or two that hear each other: the first heartbeat is sent while there is no link yet that
// brings it back.
TEST(Engine, TheOwnFrameThatComesBackByALaterLinkIsNotSentAgain) {
    Network sut;
    sut.links(1);
    const auto beat = test::make_frame("HEARTBEAT", gcs, {});
    const auto own = wire::FrameView::unchecked(beat);
    sut.engine.note_sent(own, LinkId{1}, sut.now);
    sut.links(1);

    for (int i = 0; i < 3; ++i) EXPECT_TRUE(sut.engine.route(own, LinkId{2}, sut.now).links.empty()) << i;
}

TEST(Engine, ManualControlGoesToItsTargetOnly) {
    Network sut;
    sut.links(3);
    sut.hears(2, vehicle);

    EXPECT_THAT(sut.send(1, "MANUAL_CONTROL", gcs, {{"target", 1}, {"x", 5}}), ElementsAre(2));
    EXPECT_THAT(sut.send(1, "MANUAL_CONTROL", gcs, {{"target", 9}, {"x", 5}}), IsEmpty());
}

TEST(Engine, TargetWhereTheFrameCameFromGoesNowhere) {
    Network sut({.unknown_target = UnknownTarget::flood});
    sut.links(3);
    sut.hears(1, vehicle);

    EXPECT_THAT(sut.command(1, {1, 154}, vehicle), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::nowhere);
}

TEST(Engine, UnknownIdIsBroadcastAndTeachesNothing) {
    Network sut;
    sut.links(3);

    EXPECT_THAT(sut.pass(1, make_unknown({33, 1})), ElementsAre(2, 3));
    EXPECT_TRUE(sut.engine.routes(sut.now).empty());
    sut.hears(2, {33, 1});
    EXPECT_THAT(sut.pass(1, make_unknown({33, 1}, 1)), ElementsAre(3));
}

TEST(Engine, FilteredFrameTeachesNothing) {
    Network sut;
    sut.link({.in = test::make_filter({.systems = {7}}, {})});
    sut.link();
    sut.hears(1, vehicle);

    EXPECT_TRUE(sut.engine.routes(sut.now).empty());
    EXPECT_EQ(sut.counters(1).filtered.value(), 1u);
}

TEST(Engine, OwnIdIsConsumedAndItsSystemIsNot) {
    Network sut({.own = Source{SystemId{1}, ComponentId{191}}});
    sut.links(2);
    sut.hears(2, vehicle);

    EXPECT_THAT(sut.command(1, gcs, {1, 191}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::consumed);
    EXPECT_THAT(sut.command(1, gcs, {1, 0}), ElementsAre(2));
}

TEST(Engine, DuplicateOnAnotherLinkIsDroppedAndTeachesItsRoute) {
    Network sut({.dedup = 250ms});
    sut.links(3);
    sut.hears(2, gcs);
    const Bytes frame = make_frame("ATTITUDE", gcs);
    ASSERT_THAT(sut.pass(1, frame), ElementsAre(3));
    sut.wait(249ms);

    EXPECT_THAT(sut.pass(2, frame), IsEmpty());

    EXPECT_EQ(sut.verdict, Verdict::duplicate);
    EXPECT_EQ(sut.counters(2).duplicate.value(), 1u);
    EXPECT_EQ(sut.engine.routes(sut.now)[1].frames, 2u);
}

TEST(Engine, AFrameOfAPrivateLinkIsNoDuplicateElsewhere) {
    Network sut({.dedup = 250ms});
    sut.link({.is_private = true});
    sut.links(2);
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    ASSERT_THAT(sut.pass(1, frame), IsEmpty());

    EXPECT_THAT(sut.pass(2, frame), ElementsAre(3));
    EXPECT_THAT(sut.pass(3, frame), IsEmpty());
}

TEST(Engine, DedupEndsWithItsWindow) {
    Network sut({.dedup = 250ms});
    sut.links(2);
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    ASSERT_THAT(sut.pass(1, frame), ElementsAre(2));
    sut.wait(100ms);
    EXPECT_THAT(sut.pass(1, frame), IsEmpty());
    sut.wait(150ms);

    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2));
}

TEST(Engine, WithoutDedupASenderMayRepeatItself) {
    Network sut;
    sut.links(2);
    const Bytes frame = make_frame("ATTITUDE", vehicle);

    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2));
    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2));
}

TEST(Engine, CopyFromAnotherLinkGoesOnlyWhereTheFrameHasNotBeen) {
    Network sut;
    sut.links(3);
    const Bytes frame = make_frame("ATTITUDE", gcs);
    ASSERT_THAT(sut.pass(1, frame), ElementsAre(2, 3));
    const auto late = sut.link();
    const auto other = sut.link();

    EXPECT_THAT(sut.pass(late, frame), ElementsAre(other));
    EXPECT_EQ(sut.verdict, Verdict::forwarded);
    EXPECT_THAT(sut.engine.routes(sut.now), testing::SizeIs(2));
    EXPECT_THAT(sut.pass(other, frame), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::echo);
    EXPECT_THAT(sut.pass(late, frame), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::duplicate);
    EXPECT_EQ(sut.counters(late).duplicate.value(), 1u);
}

// One router reaches the other through its udpout, and the other it through its own: whatever comes back comes on a
// link to which it was not sent.
TEST(Engine, LoopOfTwoRoutersEndsAlsoForAFrameThatTheNetworkDoubles) {
    Network sut;
    sut.links(3);  // the vehicle, the way to the other router, the way back
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    ASSERT_THAT(sut.pass(1, frame), ElementsAre(2, 3));
    sut.engine.remove_link(LinkId{3});
    const auto back = sut.link();
    sut.wait(1ms);

    for (int i = 0; i < 3; ++i) EXPECT_THAT(sut.pass(back, frame), IsEmpty()) << i;
    EXPECT_EQ(sut.verdict, Verdict::duplicate);
    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2, back));  // its sender repeats itself
    EXPECT_THAT(sut.pass(back, frame), IsEmpty());
}

TEST(Engine, CopyFromAnotherLinkIsANewFrameAfterTwoSeconds) {
    Network sut;
    sut.links(3);
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    sut.hears(1, vehicle);
    sut.pass(1, frame);
    const auto back = sut.link();
    sut.wait(2s - 1ns);
    EXPECT_THAT(sut.pass(back, frame), IsEmpty());
    sut.wait(1ns);

    EXPECT_THAT(sut.pass(back, frame), ElementsAre(2, 3));
}

TEST(Engine, CopyFromAnotherLinkDoesNotGoToTheSpareLinkOfAGroup) {
    Network sut;
    sut.links(1);                                                           // 1
    sut.links(2, {.group = GroupId{1}, .group_mode = GroupMode::primary});  // 2, 3
    sut.link();                                                             // 4
    sut.hears(2, gcs);
    sut.hears(3, gcs);
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    ASSERT_THAT(sut.pass(1, frame), ElementsAre(2, 4));
    const auto back = sut.link();

    EXPECT_THAT(sut.pass(back, frame), IsEmpty());
    EXPECT_THAT(sut.explain(back, frame),
                testing::IsSupersetOf({Pair(2, Reason::already_sent), Pair(3, Reason::other_member)}));
}

TEST(Engine, EchoEndsAfterTwoSeconds) {
    Network sut;
    sut.links(2);
    const Bytes frame = make_frame("ATTITUDE", vehicle);
    sut.hears(1, vehicle);
    sut.pass(1, frame);
    sut.wait(2s - 1ns);
    EXPECT_THAT(sut.pass(2, frame), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::echo);
    sut.wait(1ns);

    sut.pass(2, frame);

    EXPECT_EQ(sut.verdict, Verdict::nowhere);  // its source is on 1
}

TEST(Engine, EchoOfOurOwnFrameIsKnown) {
    Network sut;
    sut.links(2);
    const Bytes heartbeat = make_frame("HEARTBEAT", {1, 191});
    sut.engine.note_sent(wire::FrameView::unchecked(heartbeat), LinkId{2}, sut.now);

    EXPECT_THAT(sut.pass(2, heartbeat), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::echo);
}

TEST(Engine, SenderThatDoesNotCountIsNotTakenForItsOwnCopy) {
    Network sut;
    const LinkPolicy air{.group = GroupId{1}};
    sut.link(air);
    sut.link(air);
    sut.link();
    const Bytes heartbeat = make_frame("HEARTBEAT", vehicle);

    for (int second = 0; second < 5; ++second) {
        EXPECT_THAT(sut.pass(1, heartbeat), ElementsAre(3));
        EXPECT_THAT(sut.pass(2, heartbeat), IsEmpty());
        sut.wait(1s);
    }
}

TEST(Engine, PrivateLinkGetsOnlyWhatIsForItsPairsAndGivesNothing) {
    Network sut;
    sut.links(2);
    const auto gimbal = sut.link({.is_private = true});

    EXPECT_THAT(sut.hears(gimbal, {1, 154}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::private_link);
    sut.hears(2, vehicle);
    EXPECT_THAT(sut.command(gimbal, {1, 154}, vehicle), IsEmpty());
    EXPECT_THAT(sut.send(1, "ATTITUDE", gcs), ElementsAre(2));
    EXPECT_THAT(sut.command(1, gcs, {1, 0}), ElementsAre(2));
    EXPECT_THAT(sut.command(1, gcs, {1, 155}), ElementsAre(2));
    EXPECT_THAT(sut.command(1, gcs, {1, 154}), ElementsAre(gimbal));
}

TEST(Engine, TapGetsEverythingAndContributesNothing) {
    Network sut({.dedup = 250ms, .own = Source{SystemId{1}, ComponentId{191}}});
    sut.link({.in = test::make_filter({}, {.messages = {"SYS_STATUS"}})});
    sut.link();
    const auto tap = sut.link({.tap = true});
    const Bytes frame = make_frame("ATTITUDE", vehicle);

    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2, tap));
    EXPECT_THAT(sut.pass(1, frame), ElementsAre(tap));
    EXPECT_EQ(sut.verdict, Verdict::duplicate);
    EXPECT_THAT(sut.pass(2, frame), ElementsAre(tap));
    EXPECT_EQ(sut.verdict, Verdict::echo);
    EXPECT_THAT(sut.send(1, "SYS_STATUS", vehicle), ElementsAre(tap));
    EXPECT_EQ(sut.verdict, Verdict::filtered);
    EXPECT_THAT(sut.command(1, gcs, {99, 1}), ElementsAre(tap));
    EXPECT_EQ(sut.verdict, Verdict::unknown_target);
    EXPECT_THAT(sut.command(1, gcs, {1, 191}), ElementsAre(tap));
    EXPECT_THAT(sut.hears(tap, {50, 1}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::tap);
    EXPECT_THAT(sut.command(1, gcs, {50, 1}), ElementsAre(tap));
    EXPECT_EQ(sut.verdict, Verdict::unknown_target);
}

TEST(Engine, GroupOfModeAllSendsOnEveryMember) {
    Network sut;
    sut.links(2, {.group = GroupId{1}});
    sut.link();

    EXPECT_THAT(sut.send(3, "ATTITUDE", gcs), ElementsAre(1, 2));
    EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), ElementsAre(3));
}

TEST(Engine, PrimaryFallsOverWhenSilentAndComesBack) {
    Network sut;
    sut.link({.group = GroupId{1}, .group_mode = GroupMode::primary, .group_order = 2});
    sut.link({.group = GroupId{1}, .group_mode = GroupMode::primary, .group_order = 1});
    sut.link();
    const auto where = [&] { return sut.send(3, "ATTITUDE", gcs, {{"time_boot_ms", ++sut.count}}); };

    EXPECT_THAT(where(), ElementsAre(1, 2));  // nobody was heard yet: all are tried
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);
    EXPECT_THAT(where(), ElementsAre(2));
    sut.wait(2s);
    sut.hears(1, vehicle);
    sut.wait(1s);
    EXPECT_THAT(where(), ElementsAre(1));
    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(1));
    sut.hears(2, vehicle);
    EXPECT_THAT(where(), ElementsAre(2));
    EXPECT_THAT(sut.hears(3, gcs), ElementsAre(1, 2));  // HEARTBEAT goes everywhere
}

TEST(Engine, PrimaryTakesAnotherOrderLater) {
    Network sut;
    sut.links(2, {.group = GroupId{1}, .group_mode = GroupMode::primary});
    sut.link();
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);
    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(1));
    const GroupOrder other[] = {{LinkId{1}, 1}, {LinkId{2}, 0}, {LinkId{9}, 0}};
    sut.engine.set_group_orders(other);

    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(2));
}

TEST(Engine, BestStaysWhileItsLinkIsNoWorse) {
    Network sut;
    sut.links(2, {.group = GroupId{1}, .group_mode = GroupMode::best});
    sut.link();
    const auto where = [&] { return sut.send(3, "ATTITUDE", gcs, {{"time_boot_ms", ++sut.count}}); };
    sut.hears(1, vehicle);
    sut.wait(1ms);
    sut.hears(2, vehicle);

    EXPECT_THAT(where(), ElementsAre(2));  // the freshest
    sut.wait(1ms);
    sut.hears(1, vehicle);
    EXPECT_THAT(where(), ElementsAre(2));  // stays
    for (int more = 1; more < 4; ++more) sut.hears(1, vehicle);
    EXPECT_THAT(where(), ElementsAre(2));  // 1 heard 4 more
    sut.hears(1, vehicle);
    EXPECT_THAT(where(), ElementsAre(1));
    sut.wait(2s);
    sut.hears(2, vehicle);
    sut.wait(1s);
    EXPECT_THAT(where(), ElementsAre(2));  // 1 is silent
}

// A network whose links 1 and 2 lead to a vehicle, and 3 to a ground station.
struct BestNetwork : Network {
    BestNetwork() {
        links(2, {.group = GroupId{1}, .group_mode = GroupMode::best});
        link();
        both_hear();
    }
    void both_hear() { heard_on({1, 2}); }
    void heard_on(std::initializer_list<std::uint32_t> on) {
        const auto frame = make_frame("HEARTBEAT", vehicle, {{"custom_mode", ++count}});
        for (const auto number : on) pass(number, frame);
        wait(1s);
    }
    void telemetry(std::uint32_t on) { send(on, "ATTITUDE", vehicle, {{"time_boot_ms", ++count}}); }
    test::Ids where() { return send(3, "ATTITUDE", gcs, {{"time_boot_ms", ++count}}); }
};

TEST(Engine, BestCountsHeartbeatsOnlyForTheSpareLinkGetsNothingElse) {
    BestNetwork sut;
    ASSERT_THAT(sut.where(), ElementsAre(1));
    for (int i = 0; i < 5; ++i) {
        EXPECT_THAT(sut.where(), ElementsAre(1));
        for (int n = 0; n < 50; ++n) sut.telemetry(1);
        sut.heard_on({2});
    }
    EXPECT_THAT(sut.where(), ElementsAre(2));
}

TEST(Engine, BestForgetsOldLoss) {
    BestNetwork sut;
    for (int i = 0; i < 100; ++i) sut.both_hear();
    ASSERT_THAT(sut.where(), ElementsAre(1));
    for (int i = 0; i < 5; ++i) {
        sut.heard_on({2});
        sut.telemetry(1);
    }
    ASSERT_THAT(sut.where(), ElementsAre(2));
    for (int i = 0; i < 1000; ++i) sut.both_hear();
    for (int i = 0; i < 5; ++i) {
        EXPECT_THAT(sut.where(), ElementsAre(2));
        sut.heard_on({1});
        sut.telemetry(2);
    }
    EXPECT_THAT(sut.where(), ElementsAre(1));
}

TEST(Engine, BestComparesALinkFromWhenItIsHeardAgain) {
    BestNetwork sut;
    for (int i = 0; i < 50; ++i) sut.heard_on({1});
    sut.both_hear();
    for (int i = 0; i < 5; ++i) {
        EXPECT_THAT(sut.where(), ElementsAre(1));
        sut.heard_on({2});
        sut.telemetry(1);
    }
    EXPECT_THAT(sut.where(), ElementsAre(2));
}

TEST(Engine, BestTakesADoubledHeartbeatOnce) {
    BestNetwork sut;
    ASSERT_THAT(sut.where(), ElementsAre(1));
    for (int i = 0; i < 10; ++i) sut.heard_on({1, 2, 2});

    EXPECT_THAT(sut.where(), ElementsAre(1));
}

// A bridge to the vehicle beats by itself, on its own link.
TEST(Engine, BestCountsNoHeartbeatsThatOneLinkAloneBrings) {
    BestNetwork sut;
    ASSERT_THAT(sut.where(), ElementsAre(1));
    for (int i = 0; i < 20; ++i) {
        sut.both_hear();
        sut.hears(2, {51, 68});
    }
    EXPECT_THAT(sut.where(), ElementsAre(1));
}

TEST(Engine, BestComparesTheOthersWhileOneComesAndGoes) {
    BestNetwork sut;
    sut.link({.group = GroupId{1}, .group_mode = GroupMode::best});
    ASSERT_THAT(sut.where(), ElementsAre(1));
    for (int i = 0; i < 2; ++i) {
        sut.heard_on({1, 2, 4});
        for (int n = 0; n < 3; ++n) {
            sut.heard_on({2});
            sut.telemetry(1);
        }
    }
    EXPECT_THAT(sut.where(), ElementsAre(2));
}

TEST(Engine, BestTakesAHeartbeatOnceThatBothLinksDouble) {
    BestNetwork sut;
    ASSERT_THAT(sut.where(), ElementsAre(1));
    for (int i = 0; i < 10; ++i) sut.heard_on({2, 1, 1, 2});

    EXPECT_THAT(sut.where(), ElementsAre(1));
}

TEST(Engine, GroupTakesAnotherMemberWhereOneFilters) {
    Network sut;
    sut.link({.out = test::make_filter({}, {.messages = {"ATTITUDE"}}),
              .group = GroupId{1},
              .group_mode = GroupMode::primary});
    sut.link({.group = GroupId{1}, .group_mode = GroupMode::primary, .group_order = 1});
    sut.link();
    sut.hears(1, vehicle);
    sut.hears(2, vehicle);

    EXPECT_THAT(sut.send(3, "ATTITUDE", gcs), ElementsAre(2));
    EXPECT_THAT(sut.send(3, "SYS_STATUS", gcs), ElementsAre(1));
}

LinkPolicy limited(const std::vector<dialect::RateTerm>& terms) { return {.max_rate = test::make_rates(terms)}; }

TEST(Engine, MaxRateHoldsForEachSourceAndMessage) {
    Network sut;
    sut.link();
    sut.link(limited({{"ATTITUDE", 10}}));
    int of_first = 0, of_second = 0, of_others = 0;
    for (std::uint32_t ms = 0; ms < 1000; ms += 20) {
        of_first += static_cast<int>(sut.send(1, "ATTITUDE", {1, 1}, {{"time_boot_ms", ms}}).size());
        of_second += static_cast<int>(sut.send(1, "ATTITUDE", {2, 1}, {{"time_boot_ms", ms}}).size());
        of_others += static_cast<int>(sut.send(1, "ALTITUDE", {1, 1}, {{"time_usec", ms}}).size());
        sut.wait(20ms);
    }

    EXPECT_EQ(of_first, 11);  // the second one may be early by less than half an interval
    EXPECT_EQ(of_second, 11);
    EXPECT_EQ(of_others, 50);
    EXPECT_EQ(sut.counters(1).rate_limited.value(), 78u);
    EXPECT_EQ(sut.counters(2).out_rate_limited.value(), 78u);
}

TEST(Engine, MaxRateOfAllOthersSparesWhatSomebodyWaitsFor) {
    Network sut;
    sut.link();
    sut.link(limited({{"*", 1}}));

    sut.hears(2, {9, 9});
    const auto for_it = test::Fields{{"target_system", 9}, {"target_component", 9}};
    for (std::uint32_t i = 0; i < 5; ++i) {
        EXPECT_THAT(sut.hears(1, vehicle), ElementsAre(2));
        EXPECT_THAT(sut.send(1, "PARAM_VALUE", vehicle, {{"param_index", i}}), ElementsAre(2));     // class 0
        EXPECT_THAT(sut.send(1, "FILE_TRANSFER_PROTOCOL", vehicle, for_it), ElementsAre(2));        // class 1
        EXPECT_THAT(sut.send(1, "ENCAPSULATED_DATA", vehicle, {{"seqnr", i}}), ElementsAre(2));     // a piece
        EXPECT_THAT(sut.send(1, "EVENT", vehicle, {{"sequence", i}}), ElementsAre(2));              // an event
        EXPECT_THAT(sut.send(1, "AVAILABLE_MODES", vehicle, {{"mode_index", i}}), ElementsAre(2));  // an answer
    }
    for (const auto* thinned : {"ATTITUDE", "ADSB_VEHICLE", "CAMERA_SETTINGS"}) {
        EXPECT_THAT(sut.send(1, thinned, vehicle), ElementsAre(2)) << thinned;
        EXPECT_THAT(sut.send(1, thinned, vehicle), IsEmpty()) << thinned;
    }
}

TEST(Engine, MaxRateThatNamesAMessageHoldsForIt) {
    Network sut;
    sut.link();
    sut.link(limited({{"HEARTBEAT", 0.1}, {"*", 1000}}));

    EXPECT_THAT(sut.hears(1, vehicle), ElementsAre(2));
    sut.wait(9s);
    EXPECT_THAT(sut.hears(1, vehicle), IsEmpty());
    sut.wait(1s);
    EXPECT_THAT(sut.hears(1, vehicle), ElementsAre(2));
}

TEST(Engine, MaxBytesHoldsTelemetryAndLetsCommandsThrough) {
    Network sut;
    sut.link();
    sut.link({.max_bytes_per_s = 1000});
    sut.hears(2, {9, 9});
    std::size_t bytes = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const Bytes frame = make_frame("ATTITUDE", vehicle, {{"yawspeed", 0x3f800000}, {"time_boot_ms", i}});
        if (!sut.pass(1, frame).empty()) bytes += frame.size();
        sut.wait(10ms);
    }

    EXPECT_GT(bytes, 9900u);
    EXPECT_LE(bytes, 10000u + 560u);  // ten seconds, and what may leave at once
    EXPECT_GT(sut.counters(2).out_bytes_limited.value(), 0u);
    for (int i = 0; i < 100; ++i) EXPECT_THAT(sut.command(1, gcs, {9, 9}), ElementsAre(2));
    sut.wait(1s);
    EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), IsEmpty());  // the debt of the commands
}

// Link 1 is verified, link 2 is not, link 3 is limited.
Network& with_forger(Network& network, const LinkPolicy& limits) {
    network.link({.rank = Rank::verified});
    network.link({.rank = Rank::stranger});
    network.link(limits);
    return network;
}

// How many frames reached link 3.
std::size_t at_limit(const test::Ids& links) { return static_cast<std::size_t>(std::ranges::count(links, 3u)); }

TEST(Engine, ForgedFramesTakeNothingFromTheRateOfVerifiedOnes) {
    Network sut;
    with_forger(sut, limited({{"ATTITUDE", 10}}));
    std::size_t verified = 0, forged = 0;
    for (std::uint32_t ms = 0; ms < 10'000; ++ms) {
        forged += at_limit(sut.send(2, "ATTITUDE", vehicle, {{"time_boot_ms", 2 * ms}}));
        if (ms % 100 == 50) verified += at_limit(sut.send(1, "ATTITUDE", vehicle, {{"time_boot_ms", 2 * ms + 1}}));
        sut.wait(1ms);
    }

    EXPECT_EQ(verified, 100u);
    EXPECT_EQ(forged, 101u);  // the second one was early
}

TEST(Engine, ForgedFramesGetTheBytesThatVerifiedOnesLeave) {
    Network sut;
    with_forger(sut, {.max_bytes_per_s = 1000});
    const std::size_t size = make_frame("ATTITUDE", vehicle, {{"yawspeed", 0x3f800000}}).size();
    std::size_t verified = 0, forged = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const auto next = [&](std::uint32_t n) {
            return test::Fields{{"yawspeed", 0x3f800000}, {"time_boot_ms", 1000 * n + i}};
        };
        for (const std::uint32_t n : {1u, 2u}) forged += size * at_limit(sut.send(2, "ATTITUDE", vehicle, next(n)));
        sut.send(2, "HEARTBEAT", vehicle, {{"custom_mode", i}});  // essential: not limited
        if (i % 10 == 0) verified += size * at_limit(sut.send(1, "ATTITUDE", vehicle, next(3)));
        sut.wait(10ms);
    }

    EXPECT_EQ(verified, 100 * size) << "all: they need less than the limit";
    EXPECT_LE(forged, 10'000 + 560 - verified);
}

TEST(Engine, LimitedLinkDoesNotHoldTheOthers) {
    Network sut;
    sut.link();
    sut.link(limited({{"*", 1}}));
    sut.link();
    sut.send(1, "ATTITUDE", vehicle);

    EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), ElementsAre(3));
}

TEST(Engine, HostileSenderLosesItsOwnRoutesOnly) {
    Network sut;
    sut.links(3);
    sut.hears(2, vehicle);
    for (std::uint32_t pair = 512; pair < 512 + 3000; ++pair)
        sut.pass(1, make_frame("HEARTBEAT", Id{static_cast<std::uint8_t>(pair >> 8), static_cast<std::uint8_t>(pair)}));

    EXPECT_EQ(sut.engine.routes(sut.now).size(), Engine::max_routes_per_link + 1);
    EXPECT_EQ(sut.engine.counters().routes_evicted.value(), 3000 - Engine::max_routes_per_link);
    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(2));
}

TEST(Engine, SourcesOnAThousandLinksStayWithinTheBound) {
    Network sut;
    sut.links(1000);
    for (std::uint32_t link = 1; link <= 1000; ++link)
        for (std::uint8_t i = 2; i < 102; ++i) {  // no autopilots, which are learned on one link first
            const Bytes frame = make_frame("HEARTBEAT", Id{static_cast<std::uint8_t>(1 + link % 250), i},
                                           {{"custom_mode", link}});
            (void)sut.engine.route(wire::FrameView::unchecked(frame), LinkId{link}, sut.now);
        }

    EXPECT_EQ(sut.engine.routes(sut.now).size(), Engine::max_routes);
    EXPECT_EQ(sut.engine.counters().routes_evicted.value(), 100000 - Engine::max_routes);
}

TEST(Engine, RouteListReportsLinkSourceAgeAndFrames) {
    Network sut;
    sut.links(2);
    sut.hears(2, vehicle);
    sut.hears(2, vehicle);
    sut.wait(3s);
    sut.hears(1, gcs);

    const auto routes = sut.engine.routes(sut.now);

    ASSERT_EQ(routes.size(), 2u);
    EXPECT_EQ(routes[0].link, LinkId{2});
    EXPECT_EQ(routes[0].source, Source(vehicle));
    EXPECT_EQ(routes[0].age, 3s);
    EXPECT_EQ(routes[0].frames, 2u);
    EXPECT_EQ(routes[1].source, Source(gcs));
}

TEST(Engine, RedundantLinksOfOneGroupAreNoDuplicateIds) {
    Network sut;
    sut.links(2, {.group = GroupId{1}});
    sut.link();
    for (int i = 0; i < 10; ++i) {
        sut.hears(1, vehicle);
        sut.hears(2, vehicle);
    }

    EXPECT_TRUE(sut.engine.duplicate_ids().empty());
}

TEST(Engine, ExplainsEveryLinkOfABroadcast) {
    constexpr Id camera{1, 100};
    Network sut;
    sut.link();                                                             // 1
    sut.links(2, {.group = GroupId{1}, .group_mode = GroupMode::primary});  // 2, 3
    sut.link({.out = test::make_filter({}, {.messages = {"ATTITUDE"}})});   // 4
    sut.link({.is_private = true});                                         // 5
    sut.link({.tap = true});                                                // 6
    sut.link();                                                             // 7: the same sender
    sut.link(limited({{"ATTITUDE", 0.001}}));                               // 8
    sut.link({.max_bytes_per_s = 0});                                       // 9
    sut.hears(2, {9, 9});
    sut.hears(3, {9, 9});
    sut.hears(7, camera);
    sut.send(1, "ATTITUDE", camera);
    for (int i = 0; i < 20; ++i) sut.send(1, "ALTITUDE", camera, {{"bottom_clearance", 1}});

    const auto why = sut.explain(1, make_frame("ATTITUDE", camera, {{"yawspeed", 0x3f800000}}));

    EXPECT_EQ(sut.verdict, Verdict::forwarded);
    EXPECT_THAT(why, UnorderedElementsAre(
                         Pair(1, Reason::ingress), Pair(2, Reason::sent), Pair(3, Reason::other_member),
                         Pair(4, Reason::filtered), Pair(5, Reason::private_link), Pair(6, Reason::tap),
                         Pair(7, Reason::source_here), Pair(8, Reason::rate_limited), Pair(9, Reason::bytes_limited)));
}

TEST(Engine, ExplainsATargetedFrameAndADroppedOne) {
    constexpr Id camera{1, 100};
    Network sut;
    sut.links(2, {.group = GroupId{1}});
    sut.links(2);
    sut.hears(2, camera);
    sut.hears(3, camera);
    const Bytes command = make_frame("COMMAND_LONG", gcs, {{"target_system", 1}, {"target_component", 100}});

    EXPECT_THAT(sut.explain(1, command), UnorderedElementsAre(Pair(1, Reason::ingress), Pair(2, Reason::same_group),
                                                              Pair(3, Reason::sent), Pair(4, Reason::other_target)));
    EXPECT_THAT(sut.explain(3, command), UnorderedElementsAre(Pair(1, Reason::dropped), Pair(2, Reason::dropped),
                                                              Pair(3, Reason::dropped), Pair(4, Reason::dropped)));
    EXPECT_EQ(sut.verdict, Verdict::echo);
}

TEST(Engine, EveryVerdictAndReasonHasAText) {
    for (int v = 0; v <= static_cast<int>(Verdict::unknown_link); ++v)
        EXPECT_FALSE(verdict_name(static_cast<Verdict>(v)).empty()) << v;
    for (int r = 0; r <= static_cast<int>(Reason::bytes_limited); ++r)
        EXPECT_FALSE(reason_text(static_cast<Reason>(r)).empty()) << r;
}

}  // namespace
}  // namespace mavloom::route
