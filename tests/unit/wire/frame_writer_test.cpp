// SPDX-License-Identifier: MIT
#include "mavloom/wire/frame_writer.hpp"

#include <gtest/gtest.h>

#include "support/golden_frames.hpp"

namespace mavloom::wire {

using test::copy;
using test::hex;

namespace {

const MessageInfo heartbeat = test::golden_messages[0];
const MessageInfo ping = test::golden_messages[1];
const MessageInfo attitude = test::golden_messages[2];
const MessageInfo command_ack = test::golden_messages[3];

FrameHeader header(Version version, std::uint8_t sequence) {
    return {version, sequence, {SystemId{1}, ComponentId{1}}, 0};
}

SigningKey counting_key() {
    std::array<std::uint8_t, SigningKey::length> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(i);
    return SigningKey(bytes);
}

}  // namespace

TEST(FrameWriter, WritesPymavlinksHeartbeatInBothVersions) {
    FrameBuffer out;
    const auto payload = hex("00000402020c510403");

    EXPECT_EQ(copy(write_frame(out, header(Version::v2, 7), heartbeat, payload).bytes()), test::heartbeat_v2);
    EXPECT_EQ(copy(write_frame(out, header(Version::v1, 7), heartbeat, payload).bytes()), test::heartbeat_v1);
}

TEST(FrameWriter, DropsTrailingZerosInVersion2Only) {
    FrameBuffer out;
    const auto payload = hex("40e20100cdcccc3dcdcc4cbe00004040000000000000000000000000");

    EXPECT_EQ(copy(write_frame(out, header(Version::v2, 200), attitude, payload).bytes()), test::attitude_v2);
    EXPECT_EQ(copy(write_frame(out, header(Version::v1, 200), attitude, payload).bytes()), test::attitude_v1);
}

TEST(FrameWriter, KeepsOneByteOfAnAllZeroPayload) {
    FrameBuffer out;
    const test::Bytes payload(14, 0);

    EXPECT_EQ(copy(write_frame(out, header(Version::v2, 0), ping, payload).bytes()), test::ping_zero_v2);
}

TEST(FrameWriter, TakesAShortPayloadAsZeroExtended) {
    FrameBuffer out;

    EXPECT_EQ(copy(write_frame(out, header(Version::v2, 0), ping, {}).bytes()), test::ping_zero_v2);
    EXPECT_EQ(write_frame(out, header(Version::v1, 0), ping, {}).payload_length(), 14);
}

TEST(FrameWriter, CutsExtensionFieldsInVersion1) {
    FrameBuffer out;
    const auto payload = hex("9001003200000000ffbe");

    EXPECT_EQ(copy(write_frame(out, header(Version::v2, 255), command_ack, payload).bytes()), test::command_ack_v2);
    const auto v1 = write_frame(out, header(Version::v1, 255), command_ack, payload);
    EXPECT_EQ(v1.payload_length(), 3);
    EXPECT_EQ(copy(v1.payload()), hex("900100"));
}

TEST(FrameWriter, SignsLikePymavlink) {
    FrameBuffer out;
    const auto payload = hex("00000402020c510403");
    Signer signer(counting_key(), 5);

    EXPECT_EQ(copy(write_frame(out, header(Version::v2, 7), heartbeat, payload, {&signer, SigningTime{0}}).bytes()),
              test::heartbeat_signed_1);
    EXPECT_EQ(
        copy(write_frame(out, header(Version::v2, 7), heartbeat, payload, {&signer, SigningTime{0x123456789abc}}).bytes()),
        test::heartbeat_signed_late);
}

TEST(FrameView, ReadsEveryHeaderField) {
    const auto v1 = FrameView::unchecked(test::attitude_v1);
    EXPECT_EQ(v1.version(), Version::v1);
    EXPECT_EQ(v1.id(), MessageId{30});
    EXPECT_EQ(v1.sequence(), 200);
    EXPECT_EQ(v1.payload_length(), 28);
    EXPECT_EQ(v1.checksum(), 0xc596);
    EXPECT_TRUE(v1.signature().empty());

    const auto v2 = FrameView::unchecked(test::tunnel_v2);
    EXPECT_EQ(v2.version(), Version::v2);
    EXPECT_EQ(v2.id(), MessageId{385});
    EXPECT_EQ(v2.source(), (Source{SystemId{1}, ComponentId{1}}));
    EXPECT_EQ(v2.payload()[0], 0x03);
    EXPECT_FALSE(v2.is_signed());

    const auto with_signature = FrameView::unchecked(test::heartbeat_signed_1);
    EXPECT_TRUE(with_signature.is_signed());
    EXPECT_EQ(copy(with_signature.signature()), hex("05010000000000a6b835e13d07"));
    EXPECT_EQ(with_signature.checksum(), 0x1fda);
}

}  // namespace mavloom::wire
