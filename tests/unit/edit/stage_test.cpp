// SPDX-License-Identifier: MIT
// Frames that go in are pymavlink's (tests/support/golden_frames.hpp); frames that must come out are pymavlink's too,
// made with the same values: its MAVLink_*_message.pack() of the stock wheel 2.4.50, or its x25crc over bytes that were
// put together by hand.
#include "mavloom/edit/stage.hpp"

#include <gmock/gmock.h>

#include <chrono>

#include "support/bytes.hpp"
#include "support/filter.hpp"
#include "support/golden_frames.hpp"

namespace mavloom::edit {
namespace {

using namespace std::chrono_literals;
using test::Bytes;
using test::hex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

constexpr WallTime t0{1'700'000'000s};

std::unique_ptr<Stage> stage(const Options& options) {
    auto made = Stage::create(dialect::default_dialect(), options);
    if (!made) throw std::runtime_error(made.error().text);
    return std::move(*made);
}

wire::FrameView view(const Bytes& bytes) { return wire::FrameView::unchecked(bytes); }
Bytes out_of(const Outcome& outcome) { return outcome.frame.empty() ? Bytes{} : test::copy(outcome.frame.bytes()); }
Bytes forwarded(Stage& sut, const Bytes& frame) { return out_of(sut.forward(view(frame), t0, t0)); }

// Id 50000, which no dialect has; its checksum by pymavlink's x25crc with CRC_EXTRA 77.
const Bytes unknown = hex("fd03000009010150c300010203e4d4");

TEST(Stage, WithoutOptionsDecodesAndReencodesByteForByte) {
    const auto sut = stage({});
    const std::vector<Bytes> frames{test::heartbeat_v2, test::heartbeat_v1,   test::attitude_v2, test::attitude_v1,
                                    test::ping_zero_v2, test::command_ack_v2, test::tunnel_v2};
    for (const auto& frame : frames) EXPECT_EQ(forwarded(*sut, frame), frame);

    EXPECT_EQ(sut->counters().frames.value(), 7u);
    EXPECT_EQ(sut->counters().reencoded.value(), 7u);
    EXPECT_EQ(sut->counters().passed_untouched.value(), 0u);
}

TEST(Stage, WithoutOptionsPassesWhatItCannotRewriteUntouched) {
    const auto sut = stage({});
    const std::vector<Bytes> frames{
        unknown,
        test::heartbeat_signed_1,
        hex("fd0e0000000101040000000000000000000000000000000027c3"),  // PING, all zeros, not truncated
        hex("fd0b000007010100000000000402020c510403010258b3"),        // HEARTBEAT with two bytes beyond its definition
        hex("fd000000000101040000efdd"),                              // PING with no payload byte at all
    };
    for (const auto& frame : frames) EXPECT_EQ(forwarded(*sut, frame), frame);

    EXPECT_EQ(sut->counters().passed_untouched.value(), frames.size());
    EXPECT_EQ(sut->counters().reencoded.value(), 0u);
}

TEST(Stage, SetsFields) {
    const auto sut = stage({.set = {"HEARTBEAT.custom_mode=7", "HEARTBEAT.system_status=MAV_STATE_ACTIVE"}});

    // HEARTBEAT as in golden_frames, but custom_mode=7, system_status=4.
    EXPECT_EQ(forwarded(*sut, test::heartbeat_v2), hex("fd090000070101000000"
                                                       "07000000"
                                                       "020c510403"
                                                       "ad02"));
    EXPECT_EQ(forwarded(*sut, test::attitude_v2), test::attitude_v2);
}

TEST(Stage, ASetFieldReachesIntoTheTruncatedPart) {
    const auto sut = stage({.set = {"PING.target_component=9"}});

    EXPECT_EQ(forwarded(*sut, test::ping_zero_v2), hex("fd0e000000010104000000000000000000000000000000093f14"));
}

TEST(Stage, RemapsSourceAndTargetAndBackwardTheOtherWayRound) {
    const auto sut = stage({.remap_system = {"1=42"}});

    const auto there = forwarded(*sut, test::heartbeat_v2);
    EXPECT_EQ(view(there).system().value, 42);
    EXPECT_EQ(view(there).component().value, 1);
    EXPECT_EQ(view(there).sequence(), 7);
    EXPECT_EQ(out_of(sut->backward(view(there))), test::heartbeat_v2);

    const auto tunnel = forwarded(*sut, test::tunnel_v2);  // from 1/1 to target 1/2
    EXPECT_EQ(view(tunnel).system().value, 42);
    EXPECT_EQ(view(tunnel).payload()[2], 42);
    EXPECT_EQ(out_of(sut->backward(view(tunnel))), test::tunnel_v2);

    const auto unknown_there = forwarded(*sut, unknown);
    EXPECT_EQ(view(unknown_there).system().value, 42);
    EXPECT_EQ(out_of(sut->backward(view(unknown_there))), unknown);
    EXPECT_EQ(sut->counters().reencoded.value(), 2u);
    EXPECT_EQ(sut->counters().rewrapped.value(), 1u);
    EXPECT_EQ(sut->counters().backward.value(), 3u);
}

TEST(Stage, SwapsTwoSystems) {
    const auto sut = stage({.remap_system = {"1=2,2=1"}});

    const auto swapped = forwarded(*sut, test::heartbeat_v2);
    EXPECT_EQ(view(swapped).system().value, 2);
    EXPECT_EQ(forwarded(*sut, swapped), test::heartbeat_v2);
}

TEST(Stage, LetsOnlyNamedMessagesThrough) {
    const auto sut = stage({.filter = test::make_filter({.messages = {"HEARTBEAT", "50000"}})});

    EXPECT_EQ(forwarded(*sut, test::heartbeat_v2), test::heartbeat_v2);
    EXPECT_EQ(forwarded(*sut, unknown), unknown);
    EXPECT_EQ(sut->forward(view(test::attitude_v2), t0, t0).verdict, Verdict::filtered);
    EXPECT_EQ(sut->counters().filtered.value(), 1u);
    EXPECT_EQ(out_of(sut->backward(view(test::attitude_v2))), test::attitude_v2);
}

TEST(Stage, LimitsRatesByTheFramesOwnTime) {
    const auto sut = stage({.max_rate = {"ATTITUDE:10,*:50"}});
    int attitudes = 0, others = 0, heartbeats = 0;
    for (int ms = 0; ms < 10'000; ms += 10) {
        attitudes += sut->forward(view(test::attitude_v2), t0 + ms * 1ms, t0).verdict == Verdict::forward;
        others += sut->forward(view(unknown), t0 + ms * 1ms, t0).verdict == Verdict::forward;
        heartbeats += sut->forward(view(test::heartbeat_v2), t0 + ms * 1ms, t0).verdict == Verdict::forward;
    }

    EXPECT_NEAR(attitudes, 100, 1);  // early frames pass once: less than half an interval, or 50 ms
    EXPECT_NEAR(others, 500, 3);
    EXPECT_EQ(heartbeats, 1000);  // no telemetry: `*` spares it
    EXPECT_EQ(sut->counters().rate_limited.value(), static_cast<std::uint64_t>(2000 - attitudes - others));
    EXPECT_THAT(sut->warnings(), IsEmpty());
}

TEST(Stage, WarnsOfARateThatBreaksAProtocol) {
    const auto sut = stage({.max_rate = {"COMMAND_ACK:1", "ATTITUDE:10"}});

    EXPECT_THAT(sut->warnings(), ElementsAre(StartsWith("--max-rate COMMAND_ACK:1 drops")));
}

TEST(Stage, ConvertsToVersion1AndCutsExtensions) {
    const auto sut = stage({.as_version = wire::Version::v1});

    EXPECT_EQ(forwarded(*sut, test::heartbeat_v2), test::heartbeat_v1);
    EXPECT_EQ(forwarded(*sut, test::attitude_v2), test::attitude_v1);
    // COMMAND_ACK 400 accepted without its extension fields.
    EXPECT_EQ(forwarded(*sut, test::command_ack_v2), hex("fe03ff01014d900100"
                                                         "7284"));
    EXPECT_EQ(forwarded(*sut, test::heartbeat_signed_1), test::heartbeat_v1);
    EXPECT_EQ(sut->counters().signature_removed.value(), 1u);
    EXPECT_EQ(sut->forward(view(test::tunnel_v2), t0, t0).verdict, Verdict::not_v1);  // id 385
    EXPECT_EQ(sut->forward(view(unknown), t0, t0).verdict, Verdict::not_v1);
    EXPECT_EQ(sut->counters().not_v1.value(), 2u);
}

TEST(Stage, ConvertsToVersion2AndTruncates) {
    const auto sut = stage({.as_version = wire::Version::v2});

    EXPECT_EQ(forwarded(*sut, test::heartbeat_v1), test::heartbeat_v2);
    EXPECT_EQ(forwarded(*sut, test::attitude_v1), test::attitude_v2);
    EXPECT_EQ(forwarded(*sut, unknown), unknown);
}

wire::SigningKey key_0_to_31() {
    std::array<std::uint8_t, 32> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
    return wire::SigningKey(bytes);
}

TEST(Stage, SignsWithTheTimeOfNow) {
    const auto sut = stage({.sign_key = key_0_to_31(), .sign_link_id = 5});
    const WallTime tick_1 = WallTime{1420070400s} + 10us;  // time 1 of golden_frames

    EXPECT_EQ(out_of(sut->forward(view(test::heartbeat_v2), t0, tick_1)), test::heartbeat_signed_1);
    const auto again = out_of(sut->forward(view(test::heartbeat_signed_late), t0, tick_1));
    EXPECT_EQ(view(again).signature()[1], 2);  // a signature of our own, and no time twice
    EXPECT_EQ(sut->counters().signature_removed.value(), 0u);
    EXPECT_EQ(forwarded(*sut, test::heartbeat_v1), test::heartbeat_v1);
    EXPECT_EQ(sut->counters().not_signed.value(), 1u);
}

TEST(Stage, AnEditedFrameLosesItsSignature) {
    const auto sut = stage({.set = {"HEARTBEAT.mavlink_version=3"}});

    EXPECT_EQ(forwarded(*sut, test::heartbeat_signed_1), test::heartbeat_v2);
    EXPECT_EQ(sut->counters().signature_removed.value(), 1u);
}

TEST(Stage, GivesEachSourceItsOwnSequence) {
    const auto sut = stage({.filter = test::make_filter({.messages = {"HEARTBEAT", "50000"}}), .resequence = true});
    const auto sequence_of = [&](const Bytes& frame) {
        const auto out = forwarded(*sut, frame);
        return out.empty() ? -1 : view(out).sequence();
    };
    auto other = test::heartbeat_v2;
    other[6] = 2;  // component 2: the stage does not check what the parser has checked

    EXPECT_EQ(sequence_of(test::heartbeat_v2), 0);
    EXPECT_EQ(sequence_of(test::attitude_v2), -1);
    EXPECT_EQ(sequence_of(unknown), 1);
    EXPECT_EQ(sequence_of(other), 0);
    EXPECT_EQ(sequence_of(test::heartbeat_v1), 2);
    for (int i = 3; i < 256; ++i) EXPECT_EQ(sequence_of(test::heartbeat_v2), i);
    EXPECT_EQ(sequence_of(test::heartbeat_v2), 0);
}

// Receivers see the ids that are sent.
TEST(Stage, CountsTheSequenceOfASourceAfterItsRemap) {
    const auto sut = stage({.remap_system = {"1=42"}, .resequence = true});
    auto other = test::heartbeat_v2;
    other[5] = 42;  // it has that id already

    EXPECT_EQ(view(forwarded(*sut, test::heartbeat_v2)).sequence(), 0);
    EXPECT_EQ(view(forwarded(*sut, other)).sequence(), 1);
    EXPECT_EQ(view(forwarded(*sut, test::heartbeat_v2)).sequence(), 2);
}

TEST(Stage, AnEditedFrameKeepsBytesBeyondItsDefinition) {
    const auto sut = stage({.set = {"HEARTBEAT.custom_mode=7"}});

    const auto out = forwarded(*sut, hex("fd0b000007010100000000000402020c510403010258b3"));

    EXPECT_EQ(test::copy(view(out).payload()), hex("07000000020c5104030102"));
    EXPECT_EQ(sut->counters().rewrapped.value(), 1u);
}

struct BadOption {
    Options options;
    std::string_view expected;
};

TEST(Stage, RefusesWordsItDoesNotKnow) {
    const std::vector<BadOption> cases{
        {{.set = {"ATTITUDE.rol=1"}}, "did you mean 'roll'?"},
        {{.set = {"ATITUDE.roll=1"}}, "did you mean 'ATTITUDE'?"},
        {{.set = {"ATTITUDE.roll"}}, "has no value; for example, type ATTITUDE.roll=0.1"},
        {{.set = {"HEARTBEAT.type=256"}}, "HEARTBEAT.type"},
        {{.set = {"DEBUG_FLOAT_ARRAY.data[58]=1"}}, "DEBUG_FLOAT_ARRAY.data[58]: elements are [0] to [57]"},
        {{.set = {"DEBUG_FLOAT_ARRAY.data[-1]=1"}}, "elements are [0] to [57]"},
        {{.set = {"DEBUG_FLOAT_ARRAY.data[]=1"}}, "elements are [0] to [57]"},
        {{.set = {"DEBUG_FLOAT_ARRAY.data[1=1"}}, "has no field 'data[1'"},
        {{.set = {"DEBUG_FLOAT_ARRAY.data[1]=x"}}, "'x' is not a number"},
        {{.set = {"DEBUG_FLOAT_ARRAY.name[1]=x"}}, "not an array of numbers"},
        {{.set = {"ATTITUDE.roll[0]=1"}}, "not an array of numbers"},
        {{.remap_system = {"1"}}, "has no '='"},
        {{.remap_system = {"0=1"}}, "'0' is not a system id (1 to 255)"},
        {{.remap_system = {"1=256"}}, "'256' is not a system id"},
        {{.remap_system = {"1=2", "1=3"}}, "system 1 cannot become both 2 and 3"},
        {{.remap_system = {"1=3", "2=3"}}, "systems 1 and 2 cannot both become 3"},
        {{.max_rate = {"ATTITUDE"}}, "has no rate"},
        {{.max_rate = {"ATTITUDE:0"}}, "a number above 0"},
        {{.max_rate = {"ATTITUDE:nan"}}, "a number above 0"},
        {{.max_rate = {"ATTITUDE:1", "30:2"}}, "has two rates"},
        {{.max_rate = {"*:1,*:2"}}, "'*' has two rates"},
    };
    for (const auto& [options, expected] : cases) {
        const auto made = Stage::create(dialect::default_dialect(), options);

        ASSERT_FALSE(made.has_value()) << expected;
        EXPECT_EQ(made.error().code, SetupCode::usage);
        EXPECT_THAT(made.error().text, HasSubstr(std::string(expected)));
        EXPECT_THAT(made.error().text, testing::StartsWith("--"));
    }
}

}  // namespace
}  // namespace mavloom::edit
