// SPDX-License-Identifier: MIT
// Routing cases from the tests of other routers (MR: mavlink-router, P: mavp2p, G: gomavlib), and cases that none of
// them tests (N). The numbers in the test names only tell the cases apart. Links A, B, C are 1, 2, 3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <deque>

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

// Senders 1/1 and 2/1 on links 1 and 2, receivers 100/1 and 101/1 on 3 and 4 that answer every PING that reaches them.
class PingNetwork : public Network {
public:
    static constexpr Id senders[] = {{1, 1}, {2, 1}}, receivers[] = {{100, 1}, {101, 1}};

    PingNetwork() { links(4); }

    void ping(std::uint32_t link, Id source, Id target) {
        std::deque<std::pair<std::uint32_t, Bytes>> under_way{{link, bytes_of(source, target)}};
        while (!under_way.empty()) {
            const auto [from, bytes] = under_way.front();
            under_way.pop_front();
            for (const auto to : pass(from, bytes)) {
                const auto frame = wire::FrameView::unchecked(bytes);
                const bool is_for_somebody = frame.payload().size() > 12 && frame.payload()[12] != 0;
                ++(is_for_somebody || to > 2 ? got : overheard)[to];
                if (to > 2)
                    under_way.emplace_back(
                        to, bytes_of(receivers[to - 3], Id{frame.system().value, frame.component().value}));
            }
        }
    }

    std::map<std::uint32_t, int> got, overheard;

private:
    Bytes bytes_of(Id source, Id target) {
        return make_frame("PING", source,
                          {{"seq", ++count}, {"target_system", target.system}, {"target_component", target.component}});
    }
};

TEST(RoutingCases, MR1PingsReachExactlyTheirTargets) {
    PingNetwork sut;

    for (int i = 0; i < 10; ++i) {
        sut.ping(2, {2, 1}, {100, 1});
        sut.wait(200ms);
        sut.ping(1, {1, 1}, {0, 0});
        sut.wait(300ms);
    }

    EXPECT_EQ(sut.got[1], 20);
    EXPECT_EQ(sut.got[2], 9);
    EXPECT_EQ(sut.got[3], 19);
    EXPECT_EQ(sut.got[4], 10);
    EXPECT_EQ(sut.overheard[2], 10);
}

TEST(RoutingCases, MR2BroadcastReachesALinkThatHeardNothing) {
    Network sut;
    sut.links(2);

    EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), ElementsAre(2));
}

TEST(RoutingCases, MR3MR4UnseenTargetIsNotSent) {
    Network sut;
    sut.links(2);

    EXPECT_THAT(sut.command(1, vehicle, {254, 190}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::unknown_target);
    EXPECT_THAT(sut.command(1, vehicle, {254, 0}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::unknown_target);
    EXPECT_EQ(sut.counters(1).unknown_target.value(), 2u);
}

TEST(RoutingCases, MR5UnseenSystemWithoutComponentFieldIsNotSent) {
    Network sut;
    sut.links(2);

    EXPECT_THAT(sut.send(1, "SET_MODE", vehicle, {{"target_system", 254}, {"custom_mode", 1}}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::unknown_target);
}

TEST(RoutingCases, MR6NothingGoesWhereItsSourceWasHeard) {
    Network sut;
    sut.links(3);
    sut.hears(2, {12, 1});

    EXPECT_THAT(sut.send(1, "ATTITUDE", {12, 1}), ElementsAre(3));
}

TEST(RoutingCases, MR7MR8BroadcastReachesALinkWithSystems) {
    Network sut;
    sut.links(2);
    sut.hears(2, {12, 1});

    EXPECT_THAT(sut.send(1, "ATTITUDE", vehicle), ElementsAre(2));
    EXPECT_THAT(sut.command(1, vehicle, {0, 0}), ElementsAre(2));
}

TEST(RoutingCases, MR9SystemWithoutComponentIsReached) {
    Network sut;
    sut.links(3);
    sut.hears(2, {12, 1});

    EXPECT_THAT(sut.command(1, vehicle, {12, 0}), ElementsAre(2));
}

TEST(RoutingCases, MR10UnseenComponentOfAKnownSystemIsNotSentWithDrop) {
    Network sut({.unknown_component = UnknownComponent::drop});
    sut.links(2);
    sut.hears(2, {12, 1});

    EXPECT_THAT(sut.command(1, vehicle, {12, 190}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::unknown_target);
}

TEST(RoutingCases, MR10UnseenComponentOfAKnownSystemReachesTheSystemByDefault) {
    Network sut;
    sut.links(3);
    sut.hears(2, {12, 1});

    EXPECT_THAT(sut.command(1, vehicle, {12, 190}), ElementsAre(2));
}

TEST(RoutingCases, MR11OtherSystemIsNotSent) {
    Network sut;
    sut.links(2);
    sut.hears(2, {12, 1});

    EXPECT_THAT(sut.command(1, vehicle, {13, 0}), IsEmpty());
}

TEST(RoutingCases, MR12HeardSystemsAreReachableAndNoOthers) {
    Network sut;
    sut.links(2);
    sut.hears(2, {12, 1});
    sut.hears(2, {254, 1});

    for (const std::uint8_t known : {std::uint8_t{12}, std::uint8_t{254}})
        EXPECT_THAT(sut.command(1, vehicle, {known, 0}), ElementsAre(2));
    for (const std::uint8_t unseen : std::initializer_list<std::uint8_t>{11, 13, 253, 255})
        EXPECT_THAT(sut.command(1, vehicle, {unseen, 0}), IsEmpty()) << int{unseen};
}

TEST(RoutingCases, MR13OnlyHeardPairsAreKnownPairs) {
    Network sut({.unknown_component = UnknownComponent::drop});
    sut.links(2);
    sut.hears(2, {12, 1});
    sut.hears(2, {254, 190});

    EXPECT_THAT(sut.command(1, vehicle, {12, 1}), ElementsAre(2));
    EXPECT_THAT(sut.command(1, vehicle, {254, 190}), ElementsAre(2));
    for (const Id unseen : {Id{13, 1}, Id{254, 1}, Id{255, 190}})
        EXPECT_THAT(sut.command(1, vehicle, unseen), IsEmpty()) << int{unseen.system} << "/" << int{unseen.component};
}

// Which of these frames come out of a network of two links with these filters.
std::vector<bool> passing(const LinkPolicy& in, const LinkPolicy& out, const std::vector<Bytes>& frames) {
    std::vector<bool> passes;
    for (const Bytes& frame : frames) {
        Network sut;
        sut.link(in);
        sut.link(out);
        passes.push_back(!sut.pass(1, frame).empty());
        EXPECT_EQ(sut.verdict, passes.back() ? Verdict::forwarded : Verdict::filtered);
    }
    return passes;
}

const std::vector<Bytes>& by_id() {
    static const std::vector<Bytes> frames{make_frame("SYS_STATUS", vehicle), make_frame("SYSTEM_TIME", vehicle),
                                           make_frame("NAMED_VALUE_FLOAT", vehicle),
                                           make_frame("PROTOCOL_VERSION", vehicle)};
    return frames;
}

TEST(RoutingCases, MR14AllowMessageOut) {
    EXPECT_THAT(passing({}, {.out = test::make_filter({.messages = {"1"}}, {})}, by_id()),
                ElementsAre(true, false, false, false));
}
TEST(RoutingCases, MR15BlockMessageOut) {
    EXPECT_THAT(passing({}, {.out = test::make_filter({}, {.messages = {"NAMED_VALUE_FLOAT"}})}, by_id()),
                ElementsAre(true, true, false, true));
}
TEST(RoutingCases, MR16AllowSourceComponentOut) {
    EXPECT_THAT(passing({}, {.out = test::make_filter({.components = {1}}, {})},
                        {make_frame("ATTITUDE", {1, 1}), make_frame("ATTITUDE", {1, 2})}),
                ElementsAre(true, false));
}
TEST(RoutingCases, MR17BlockSourceComponentOut) {
    EXPECT_THAT(passing({}, {.out = test::make_filter({}, {.components = {100}})},
                        {make_frame("ATTITUDE", {1, 1}), make_frame("ATTITUDE", {1, 100})}),
                ElementsAre(true, false));
}
TEST(RoutingCases, MR18AllowSourceSystemOut) {
    EXPECT_THAT(passing({}, {.out = test::make_filter({.systems = {42}}, {})},
                        {make_frame("ATTITUDE", {42, 1}), make_frame("ATTITUDE", {41, 1})}),
                ElementsAre(true, false));
}
TEST(RoutingCases, MR19BlockSourceSystemOut) {
    EXPECT_THAT(passing({}, {.out = test::make_filter({}, {.systems = {42}})},
                        {make_frame("ATTITUDE", {42, 1}), make_frame("ATTITUDE", {41, 1})}),
                ElementsAre(false, true));
}
TEST(RoutingCases, MR20AllowMessageIn) {
    EXPECT_THAT(passing({.in = test::make_filter({.messages = {"SYS_STATUS"}}, {})}, {}, by_id()),
                ElementsAre(true, false, false, false));
}
TEST(RoutingCases, MR21BlockMessageIn) {
    EXPECT_THAT(passing({.in = test::make_filter({}, {.messages = {"78"}})}, {},
                        {make_unknown(vehicle), make_frame("SYS_STATUS", vehicle)}),
                ElementsAre(true, true));
    EXPECT_THAT(passing({.in = test::make_filter({}, {.messages = {"703710"}})}, {}, {make_unknown(vehicle)}),
                ElementsAre(false));
}
TEST(RoutingCases, MR22AllowSourceComponentIn) {
    EXPECT_THAT(passing({.in = test::make_filter({.components = {1}}, {})}, {},
                        {make_frame("ATTITUDE", {1, 1}), make_frame("ATTITUDE", {1, 96})}),
                ElementsAre(true, false));
}
TEST(RoutingCases, MR23BlockSourceComponentIn) {
    EXPECT_THAT(passing({.in = test::make_filter({}, {.components = {96}})}, {},
                        {make_frame("ATTITUDE", {1, 1}), make_frame("ATTITUDE", {1, 96})}),
                ElementsAre(true, false));
}
TEST(RoutingCases, MR24AllowSourceSystemIn) {
    EXPECT_THAT(passing({.in = test::make_filter({.systems = {23}}, {})}, {},
                        {make_frame("ATTITUDE", {23, 1}), make_frame("ATTITUDE", {1, 1})}),
                ElementsAre(true, false));
}
TEST(RoutingCases, MR25BlockSourceSystemIn) {
    EXPECT_THAT(passing({.in = test::make_filter({}, {.systems = {23}})}, {},
                        {make_frame("ATTITUDE", {23, 1}), make_frame("ATTITUDE", {1, 1})}),
                ElementsAre(false, true));
}

TEST(RoutingCases, P1NobodyNeedsToHaveSpokenFirst) {
    Network sut;
    sut.links(2);

    EXPECT_THAT(sut.hears(1, {6, 7}), ElementsAre(2));
    EXPECT_THAT(sut.send(2, "ODOMETRY", {4, 5}), ElementsAre(1));
}

TEST(RoutingCases, P2CommandOfANewcomerReachesItsTargetOnly) {
    Network sut;
    sut.links(3);
    sut.hears(1, {6, 7});
    sut.hears(2, {8, 9});

    EXPECT_THAT(sut.command(3, {4, 5}, {6, 7}), ElementsAre(1));
}

TEST(RoutingCases, P3CommandToAnUnseenTargetIsNotSprayed) {
    Network sut;
    sut.links(2);
    sut.hears(1, {8, 9});

    EXPECT_THAT(sut.command(2, {4, 5}, {6, 7}), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::unknown_target);
    ASSERT_EQ(sut.engine.unknown_targets().size(), 1u);
    EXPECT_EQ(sut.engine.unknown_targets()[0].target, (Source{SystemId{6}, ComponentId{7}}));
}

TEST(RoutingCases, P4KnownTargetOnOneLinkOnly) {
    Network sut;
    sut.links(4);
    sut.hears(1, {99, 34});
    sut.hears(2, {99, 35});
    sut.hears(3, {98, 34});

    EXPECT_THAT(sut.command(4, gcs, {99, 34}), ElementsAre(1));
}

TEST(RoutingCases, P5FloodSendsAnUnseenTargetToAll) {
    Network sut({.unknown_target = UnknownTarget::flood});
    sut.links(3);

    EXPECT_THAT(sut.command(2, gcs, {99, 34}), ElementsAre(1, 3));
    EXPECT_EQ(sut.verdict, Verdict::forwarded);
}

TEST(RoutingCases, G5EverybodyButTheIngress) {
    Network sut;
    sut.links(5);

    EXPECT_THAT(sut.send(3, "ATTITUDE", vehicle), ElementsAre(1, 2, 4, 5));
}

TEST(RoutingCases, N12EchoingLinkStillGetsCommandsAfterAMinute) {
    Network sut;
    sut.links(2);  // the ground station on 1; 2 sends every byte back, and the vehicle's own
    for (std::uint32_t second = 0; second < 70; ++second) {
        const Bytes heartbeat = make_frame("HEARTBEAT", gcs, {{"custom_mode", second}});
        ASSERT_THAT(sut.pass(1, heartbeat), ElementsAre(2)) << second;
        sut.wait(100ms);
        EXPECT_THAT(sut.pass(2, heartbeat), IsEmpty());
        EXPECT_EQ(sut.verdict, Verdict::echo);
        sut.hears(2, vehicle);
        const Bytes command = make_frame("COMMAND_LONG", gcs,
                                         {{"target_system", 1}, {"target_component", 1}, {"param1", second}});
        ASSERT_THAT(sut.pass(1, command), ElementsAre(2)) << second;
        EXPECT_THAT(sut.pass(2, command), IsEmpty());
        sut.wait(900ms);
    }
    EXPECT_EQ(sut.counters(2).echo.value(), 140u);
}

TEST(RoutingCases, N13RedundantLinksDeliverOnceAndEitherMayDie) {
    Network sut;
    const LinkPolicy air{.group = GroupId{1}};
    sut.link(air);
    sut.link(air);
    sut.link();
    int delivered = 0;
    for (std::uint32_t i = 0; i < 300; ++i) {
        const Bytes frame = make_frame("ATTITUDE", vehicle, {{"time_boot_ms", i}});
        const bool first_lives = i < 100 || i >= 200;
        const bool second_lives = i < 200;
        if (first_lives) delivered += static_cast<int>(sut.pass(1, frame).size());
        sut.wait(5ms);
        if (second_lives) delivered += static_cast<int>(sut.pass(2, frame).size());
        sut.wait(15ms);
        ASSERT_EQ(delivered, static_cast<int>(i) + 1);
    }
    EXPECT_THAT(sut.command(3, gcs, vehicle), ElementsAre(1, 2));
}

TEST(RoutingCases, N14CopyFilteredOnOneLinkDoesNotSuppressTheOther) {
    Network sut({.dedup = 500ms});
    sut.link({.in = test::make_filter({}, {.messages = {"ATTITUDE"}})});
    sut.links(2);
    const Bytes frame = make_frame("ATTITUDE", vehicle);

    EXPECT_THAT(sut.pass(1, frame), IsEmpty());
    EXPECT_EQ(sut.verdict, Verdict::filtered);
    EXPECT_THAT(sut.pass(2, frame), ElementsAre(1, 3));
}

TEST(RoutingCases, N17SignedAndVersion1FramesAreRoutedLikeAnyOther) {
    Network sut;
    sut.links(3);
    sut.hears(2, vehicle);
    const auto& info = (*dialect::default_dialect().message("COMMAND_LONG"))->wire;
    Bytes payload(info.max_length);
    payload[info.target_system_offset] = 1;
    payload[info.target_component_offset] = 1;
    wire::Signer signer(wire::SigningKey({}), 0);
    wire::FrameBuffer buffer{};
    const auto signed_frame = wire::write_frame(buffer, {.source = gcs}, info, payload, {&signer, {}});
    ASSERT_TRUE(signed_frame.is_signed());

    EXPECT_THAT(sut.pass(1, mavloom::test::copy(signed_frame.bytes())), ElementsAre(2));
    EXPECT_THAT(sut.pass(1, make_frame("COMMAND_LONG", gcs, {{"target_system", 1}, {"target_component", 1}}, 0,
                                       wire::Version::v1)),
                ElementsAre(2));
}

TEST(RoutingCases, N18TargetCutOffByZeroTruncationIsBroadcast) {
    Network sut;
    sut.links(3);
    const Bytes frame = make_frame("COMMAND_ACK", vehicle, {{"command", 400}});
    ASSERT_LT(wire::FrameView::unchecked(frame).payload_length(), 9);  // target_system is at 8

    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2, 3));
}

TEST(RoutingCases, N18Version1AcknowledgementHasNoTargetAndIsBroadcast) {
    Network sut;
    sut.links(3);
    const Bytes frame = make_frame("COMMAND_ACK", vehicle, {{"command", 400}, {"target_system", 255}}, 0,
                                   wire::Version::v1);

    EXPECT_THAT(sut.pass(1, frame), ElementsAre(2, 3));
}

TEST(RoutingCases, N20CommandsFollowAGroundStationThatMoves) {
    Network sut;
    sut.links(3);  // the ground station on 1, then on 2; the vehicle on 3
    sut.hears(3, vehicle);
    sut.hears(1, gcs);
    const auto to_gcs = [&] { return sut.send(3, "PARAM_EXT_ACK", vehicle, {{"param_type", ++sut.count}}); };
    ASSERT_THAT(to_gcs(), ElementsAre(1, 2));
    const auto answer = [&] {
        return sut.send(3, "MISSION_ACK", vehicle,
                        {{"target_system", 255}, {"target_component", 190}, {"opaque_id", ++sut.count}});
    };
    ASSERT_THAT(answer(), ElementsAre(1));

    sut.wait(1s);
    sut.hears(2, gcs);

    EXPECT_THAT(answer(), ElementsAre(1, 2));
    for (int i = 0; i < 60; ++i) {
        sut.wait(1s);
        sut.hears(2, gcs);
    }
    EXPECT_THAT(answer(), ElementsAre(2));
}

TEST(RoutingCases, N21TwoGroundStationsOfOneIdBothHearAllAndGetAnswers) {
    Network sut;
    sut.links(3);
    std::vector<std::uint32_t> between;
    for (int i = 0; i < 3; ++i) {
        sut.wait(1s);
        sut.hears(1, gcs);
        sut.hears(2, gcs);
        EXPECT_THAT(sut.hears(3, vehicle), ElementsAre(1, 2));
        EXPECT_THAT(sut.send(3, "MISSION_ACK", vehicle,
                             {{"target_system", 255}, {"target_component", 190}, {"opaque_id", ++sut.count}}),
                    ElementsAre(1, 2));
    }

    EXPECT_THAT(sut.hears(1, gcs), ElementsAre(3));
    ASSERT_EQ(sut.engine.duplicate_ids().size(), 1u);
    EXPECT_EQ(sut.engine.duplicate_ids()[0].source, Source(gcs));
    EXPECT_EQ(sut.engine.counters().duplicate_ids.value(), 1u);
}

TEST(RoutingCases, N22SystemZeroIsForwardedAndNeverLearnt) {
    Network sut;
    sut.links(2);

    EXPECT_THAT(sut.hears(1, {0, 1}), ElementsAre(2));
    EXPECT_TRUE(sut.engine.routes(sut.now).empty());
    EXPECT_THAT(sut.hears(2, {0, 1}), ElementsAre(1));
}

TEST(RoutingCases, N23WholeSystemIsReachedOnAllItsLinks) {
    Network sut;
    sut.links(3);
    sut.hears(2, {1, 154});
    sut.hears(1, {1, 1});

    EXPECT_THAT(sut.command(3, gcs, {1, 0}), ElementsAre(1, 2));
    EXPECT_THAT(sut.command(3, gcs, {1, 154}), ElementsAre(2));
}

}  // namespace
}  // namespace mavloom::route
