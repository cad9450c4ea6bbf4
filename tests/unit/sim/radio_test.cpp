// SPDX-License-Identifier: MIT
// Numbering, signing and silence of a vehicle's frames. Source: MAVLink guide, "Packet Serialization" and "Message
// Signing".
#include "sim/radio/radio.hpp"

#include <gmock/gmock.h>

#include <set>

#include "mavloom/msg/heartbeat.hpp"
#include "unit/sim/rig.hpp"

namespace mavloom::sim {
namespace {

constexpr LinkId first{1}, second{7};
constexpr ComponentId gimbal{154}, camera{100};

struct RadioTest : testing::Test {
    RadioTest() {
        radio.open(first);
        radio.open(second);
    }
    wire::FrameView send(LinkId link, ComponentId from = autopilot_component) {
        radio.send(link, msg::Heartbeat{.type = 2}, from);
        return sink.frames.back().frame();
    }

    test::ListSink sink;
    Radio radio{SystemId{42}, sink};
};

TEST_F(RadioTest, EachComponentAndLinkHasASequenceOfItsOwn) {
    for (unsigned n = 0; n < 600; ++n) {
        EXPECT_EQ(send(first).sequence(), n % 256);
        if (n % 2 == 0) {
            EXPECT_EQ(send(first, gimbal).sequence(), n / 2 % 256);
        }
        if (n % 3 == 0) {
            EXPECT_EQ(send(second).sequence(), n / 3 % 256);
        }
        if (n % 5 == 0) {
            EXPECT_EQ(send(first, camera).sequence(), n / 5 % 256);
        }
    }
    EXPECT_EQ(sink.frames.back().frame().source(), (Source{SystemId{42}, autopilot_component}));
}

TEST_F(RadioTest, ASilentRadioSendsNothingAndLosesNoNumber) {
    EXPECT_EQ(send(first).sequence(), 0);
    radio.set_silent(true);
    radio.send(first, msg::Heartbeat{});
    radio.broadcast(msg::Heartbeat{});
    EXPECT_EQ(sink.frames.size(), 1u);
    radio.set_silent(false);
    EXPECT_EQ(send(first).sequence(), 1);
    EXPECT_EQ(radio.totals(first).frames, 2u);
}

TEST_F(RadioTest, NothingGoesToALinkThatIsNotOpen) {
    radio.send(LinkId{99}, msg::Heartbeat{});
    radio.close(first);
    radio.send(first, msg::Heartbeat{});
    radio.note_received(first, 12);
    EXPECT_TRUE(sink.frames.empty());
    radio.open(first);
    EXPECT_EQ(send(first).sequence(), 0);
    EXPECT_EQ(radio.totals(first).received_frames, 0u);
}

// A verifier demands that timestamps of a link id rise. Two links with one id would break each other.
TEST_F(RadioTest, SignedLinksHaveLinkIdsOfTheirOwnAlsoAfterOneCloses) {
    radio.sign_with(wire::SigningKey(std::array<std::uint8_t, 32>{1, 2, 3}), {});
    radio.set_utc(WallTime{std::chrono::seconds{1'700'000'000}});
    radio.close(first);
    radio.open(LinkId{3});
    radio.open(LinkId{4});

    std::set<std::uint8_t> ids;
    for (const LinkId link : radio.links()) {
        const auto frame = send(link);
        ASSERT_TRUE(frame.is_signed());
        ids.insert(frame.bytes()[frame.size() - wire::signature_length]);
    }
    EXPECT_EQ(ids.size(), 3u);
    radio.sign_with(std::nullopt, {});
    EXPECT_FALSE(send(second).is_signed());
}

}  // namespace
}  // namespace mavloom::sim
